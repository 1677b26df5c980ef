"""`rsibr illuminate scene` and `world`, as a user gives them."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import bpy
import numpy as np
import pytest
from rsibr.rsibr_addon.command_line.main import run
from rsibr.rsibr_addon.files.radiance_pictures import read_radiance
from rsibr.tests.json_command import json_result

Command = Callable[..., dict[str, Any]]

SMALL = ("--size", "32", "--samples", "2")


@pytest.fixture
def illuminate(capfd: pytest.CaptureFixture[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Command:
    """Run `rsibr illuminate` in the folder of `studio.blend`, and return its JSON result."""
    bpy.context.scene.cursor.location = (-3.0, -3.0, 0.0)
    bpy.data.scenes.new("Bare")
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "studio.blend"))
    monkeypatch.chdir(tmp_path)

    def command(*argv: str) -> dict[str, Any]:
        bpy.ops.wm.read_factory_settings(use_empty=True)
        capfd.readouterr()
        return json_result(capfd, "illuminate", *argv, "--progress", "none")

    return command


def test_a_scene_from_an_object_a_point_or_the_cursor(illuminate: Command) -> None:
    assert illuminate("scene", "studio.blend", *SMALL, "-o", "cursor.exr")["environment"] == "cursor.exr"
    illuminate("scene", "studio.blend", "--point", "-3,-3,0", *SMALL, "-o", "point.exr")
    np.testing.assert_array_equal(read_radiance("cursor.exr"), read_radiance("point.exr"))
    illuminate("scene", "studio.blend", "--object", "Cube", *SMALL, "--faces", "-o", "cube.hdr")
    # Without the cube there is the grey world and the lamp, which fills one texel, or a few
    around = read_radiance("cube.hdr")
    assert around.shape == (16, 32, 3)
    assert np.count_nonzero(np.abs(around - 0.0509) > 0.002) in range(3, 13)
    assert around.max() > 50.0


def test_a_world(illuminate: Command) -> None:
    illuminate("world", "studio.blend", "--size", "16", "-o", "world.exr")
    np.testing.assert_allclose(read_radiance("world.exr"), 0.05087609, rtol=1e-5)
    scale = illuminate("world", "studio.blend", "--size", "16", "--exposure", "-1", "-o", "dark.exr")["scale"]
    assert scale == "Scaled by 0.5 0.5 0.5: 1 stop darker."
    np.testing.assert_array_equal(read_radiance("dark.exr"), 0.5 * read_radiance("world.exr"))
    illuminate("world", "studio.blend", "--size", "16", "--card", "8,4,2", "-o", "card.exr")
    np.testing.assert_allclose(read_radiance("card.exr"), 0.18, rtol=1e-5)


def test_a_scene_is_scaled_too(illuminate: Command) -> None:
    given = ("scene", "studio.blend", "--object", "Cube", *SMALL)
    illuminate(*given, "-o", "plain.exr")
    illuminate(*given, "--exposure", "2", "-o", "bright.exr")
    np.testing.assert_array_equal(read_radiance("bright.exr"), 4.0 * read_radiance("plain.exr"))


@pytest.mark.parametrize(
    ("argv", "words"),
    [
        (["scene", "absent.blend", "-o", "out.exr"], "There is no file absent.blend: check the path."),
        (["world", "note.txt", "-o", "out.exr"], "note.txt is no file that Blender "),
        (
            ["scene", "studio.blend", "--point", "0,inf,0", "-o", "out.exr"],
            "Point cannot be inf",
        ),
        (
            ["scene", "studio.blend", "--object", "Car", "-o", "out.exr"],
            "holds no object Car (did you mean Camera?): choose one of",
        ),
        (
            ["scene", "studio.blend", "--scene", "Set", "-o", "out.exr"],
            "no scene Set: choose one of Bare, Scene",
        ),
        (
            ["scene", "studio.blend", "--scene", "Bare", "-o", "out.exr"],
            "nothing to see in scene Bare: add a",
        ),
        (["scene", "studio.blend", "-o", "out.png"], "out.png does not end in .exr or .hdr"),
        (["scene", "studio.blend", "-o", "no/out.exr"], "does not exist, so out.exr cannot be written"),
        (["scene", "studio.blend", "--size", "9", "-o", "out.exr"], "cannot be 9 texels wide"),
        (["world", "studio.blend", "--scene", "Bare", "-o", "out.exr"], "Scene Bare has no world: add one"),
        (["world", "studio.blend", "--size", "9", "-o", "out.exr"], "cannot be 9 texels wide"),
    ],
)
def test_bad_input_is_said(argv: list[str], words: str, illuminate: Command, tmp_path: Path) -> None:
    Path("note.txt").write_text("no Blender file")
    refused = illuminate(*argv)
    assert words in refused["error"]
    assert {path.name for path in tmp_path.iterdir()} == {"studio.blend", "note.txt"}


@pytest.mark.parametrize(
    ("argv", "words"),
    [
        (["--point", "1,2"], "'1,2' is neither a number nor 3 numbers"),
        (["--frame", "now"], "now"),
    ],
)
def test_wrong_usage_is_said(argv: list[str], words: str, capfd: pytest.CaptureFixture[str]) -> None:
    assert run(["illuminate", "scene", "studio.blend", "-o", "out.exr", *argv]) == 2
    assert words in capfd.readouterr().err
