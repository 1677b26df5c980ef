"""`--clamp` on every command that reads an environment: the light, what the file says of it, and jobs."""

from pathlib import Path

import bpy
import numpy as np
import pytest
from rsibr.rsibr_addon.command_line.main import run
from rsibr.rsibr_addon.files.map_set import read_map_set, read_map_set_header
from rsibr.rsibr_addon.files.pictures import read_exr
from rsibr.rsibr_addon.files.radiance_pictures import write_radiance
from rsibr.rsibr_addon.job import CommandJob

OUTPUT = "out.rsibr.exr"
COMMANDS = {
    "bake": (
        "--brdf",
        "ggx:alpha=0.9,metal=copper",
        "--lobes",
        "1",
        "--slices",
        "2",
        "--size",
        "16",
        "--no-half",
    ),
    "tables": ("--material", "chrome", "--rows", "8"),
    "mips": ("--filter", "box", "--size", "8"),
    "bank": ("--size", "16"),
    "capture": ("--material", "mirror", "--size", "8", "--samples", "2"),
}


@pytest.fixture
def light(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> np.ndarray:
    """An environment with a sun, light.exr, in the folder to work in."""
    monkeypatch.chdir(tmp_path)
    radiance = np.random.default_rng(11).random((32, 64, 3), dtype=np.float32)
    radiance[20, 7] = np.inf, 1e20, 300.0
    write_radiance(tmp_path / "light.exr", radiance)
    return radiance


@pytest.mark.parametrize("command", COMMANDS)
def test_the_light_is_clamped_and_the_file_says_so(
    light: np.ndarray, command: str, capfd: pytest.CaptureFixture[str]
) -> None:
    options = (command, "--environment", "light.exr", *COMMANDS[command], "--clamp", "2.5", "-o", OUTPUT)
    Path("job.json").write_text(CommandJob(options).to_json(), encoding="utf-8")
    assert run(["bake", "job.json", "--progress", "none"]) == 0
    told = capfd.readouterr().err
    assert "light.exr holds 3 values above 2.5; they are taken as 2.5." in told
    assert read_map_set_header(OUTPUT)["environment"]["clamp"] == 2.5
    kept = read_map_set(OUTPUT).maps["environment"]
    np.testing.assert_array_equal(kept, np.minimum(light, np.float32(2.5)))
    assert run(["info", OUTPUT]) == 0
    assert "light.exr, 64 x 32, clamped to 2.5" in capfd.readouterr().out


def test_without_it_the_file_says_nothing(light: np.ndarray) -> None:
    assert run(["mips", "--environment", "light.exr", *COMMANDS["mips"], "-o", OUTPUT]) == 0
    assert "clamp" not in read_map_set_header(OUTPUT)["environment"]


def test_a_picture_is_previewed_clamped_and_a_map_set_is_not(
    light: np.ndarray, capfd: pytest.CaptureFixture[str]
) -> None:
    view = ("--size", "16", "--clamp", "0.25")
    assert run(["preview", "light.exr", "-o", "sphere.exr", *view]) == 0
    assert read_exr("sphere.exr").max(axis=(0, 1))[:3].max() <= 0.25
    assert run(["mips", "--environment", "light.exr", *COMMANDS["mips"], "-o", OUTPUT]) == 0
    assert run(["preview", OUTPUT, "-o", "chain.exr", *view]) == 1
    assert "is a map set, whose light is filtered already: clamp where it is baked" in capfd.readouterr().err


@pytest.mark.parametrize(
    ("value", "code", "told"),
    [
        ("0", 1, "Clamp cannot be 0: choose 1e-30 to 1e+30"),
        ("-1", 1, "Clamp cannot be -1"),
        ("nan", 1, "Clamp cannot be nan"),
        ("inf", 1, "Clamp cannot be inf"),
        ("bright", 2, "'bright' is not a number"),
    ],
)
def test_what_is_no_radiance_is_refused(
    value: str, code: int, told: str, capfd: pytest.CaptureFixture[str]
) -> None:
    assert run(["mips", "--environment", "forest", f"--clamp={value}", "-o", OUTPUT]) == code
    assert told in capfd.readouterr().err


def test_the_world_is_clamped_too(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    bpy.context.scene.world.node_tree.nodes["Background"].inputs["Strength"].default_value = 40.0
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "room.blend"))
    world = ("illuminate", "world", str(tmp_path / "room.blend"), "--size", "16", "--clamp", "0.5")
    assert run([*world, "-o", str(tmp_path / "out.exr")]) == 0
    assert "World holds 384 values above 0.5; they are taken as 0.5." in capfd.readouterr().err
    np.testing.assert_array_equal(read_exr(tmp_path / "out.exr"), np.float32(0.5))
