"""`rsibr bake` and its operator: right files, and one sentence for everything else."""

import json
import re
from pathlib import Path

import numpy as np
import pytest
from rsibr.rsibr_addon.command_line.main import run
from rsibr.rsibr_addon.core.brdf.albedo import directional_albedo
from rsibr.rsibr_addon.core.kinds.lobe_stack.shading import StackLook, stack_radiance
from rsibr.rsibr_addon.core.kinds.lobe_stack.stack import LobeStack
from rsibr.rsibr_addon.files.brdfs import brdf_from_spec
from rsibr.rsibr_addon.files.kinds.lobe_stack import from_map_set
from rsibr.rsibr_addon.files.map_set import read_map_set
from rsibr.rsibr_addon.files.pictures import read_exr
from rsibr.rsibr_addon.files.radiance_pictures import write_radiance

SPEC = "ggx:alpha=0.4,f0=0.9/0.6/0.3"
QUICK = ("--lobes", "2", "--slices", "4", "--size", "16")
NORMAL = np.array([0.0, 0.0, 1.0])


@pytest.fixture(autouse=True)
def light(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> np.ndarray:
    """A white environment, light.exr, in the folder to work in."""
    monkeypatch.chdir(tmp_path)
    radiance = np.ones((256, 512, 3), dtype=np.float32)
    write_radiance(tmp_path / "light.exr", radiance)
    return radiance


def bake(*options: str) -> LobeStack:
    whole = () if "--half" in options else ("--no-half",)
    assert run(["bake", "--environment", "light.exr", "-o", "out.rsibr.exr", *options, *whole]) == 0
    return from_map_set(Path("out.rsibr.exr"), read_map_set("out.rsibr.exr", "lobe_stack"))


def in_white_light(stack: LobeStack) -> np.ndarray:
    """What a surface shows at the stack's elevations."""
    view_dir = np.stack([np.sqrt(1.0 - stack.mu**2), 0.0 * stack.mu, stack.mu], axis=-1)
    return stack_radiance(stack, NORMAL, view_dir, StackLook())


@pytest.mark.slow
@pytest.mark.parametrize("method", ["joint", "greedy", "single", "single-2d"])
def test_a_coarse_environment_takes_broader_kernels(method: str, capfd: pytest.CaptureFixture[str]) -> None:
    write_radiance(Path("light.exr"), np.ones((32, 64, 3)), force=True)
    stack = bake("--brdf", "ggx:alpha=0.2,metal=copper", "--slices", "4", "--method", method)
    told = capfd.readouterr().err
    found = re.search(
        r"light\.exr is too coarse, at 64x32, .* E is (\S+), with them (\S+); one of 256x128", told
    )
    assert found, told
    without, with_sharper = map(float, found.groups())
    assert 0.98 * with_sharper < without < 2.0 * with_sharper
    # Where the whole sphere is white, no kernel is too broad
    np.testing.assert_allclose(in_white_light(stack), stack.albedo.sum(axis=0), rtol=1e-3)
    assert run(["bake", "--environment", "light.exr", "--fit", "fit.json", "-o", "b.rsibr.exr"]) == 1


@pytest.mark.slow
@pytest.mark.parametrize("layout", ["dual_paraboloid", "octahedral"])
def test_in_white_light_a_stack_shows_the_albedo(layout: str, capfd: pytest.CaptureFixture[str]) -> None:
    stack = bake("--brdf", SPEC, *QUICK, "--layout", layout, "--json")
    result = json.loads(capfd.readouterr().out.splitlines()[-1])
    assert (result["lobes"], result["elevations"], result["size"]) == (2, 4, 16)
    # The fit's albedo is within 2 % of the model's from 30 degrees above the horizon on.
    expected = directional_albedo(brdf_from_spec(SPEC), stack.mu)
    np.testing.assert_allclose(in_white_light(stack)[2:], expected[2:], rtol=0.02)
    # And the stack's is the fit's.
    np.testing.assert_allclose(in_white_light(stack), stack.albedo.sum(axis=0), rtol=1e-3)
    header = read_map_set("out.rsibr.exr").header
    assert header["material"].items() >= {"brdf": SPEC, "method": "joint"}.items()
    assert header["settings"] == {"layout": layout, "size": 16, "half": False}
    assert 0.0 < max(header["error_bound"]["filter"]) < 1e-3


@pytest.mark.slow
def test_a_fit_that_was_made_before_makes_the_same_stack() -> None:
    direct = bake("--brdf", SPEC, *QUICK)
    assert run(["fit", "--brdf", SPEC, "--lobes", "2", "--slices", "4", "-o", "fit.json"]) == 0
    of_fit = bake("--fit", "fit.json", "--size", "16", "--force")
    for name in ("mu", "maps", "scale", "offsets", "taps", "albedo"):
        np.testing.assert_array_equal(getattr(of_fit, name), getattr(direct, name))


def test_half_floats_take_half_the_space() -> None:
    bake("--brdf", SPEC, *QUICK, "--half")
    maps = read_map_set("out.rsibr.exr").maps
    stored = np.concatenate([pixels.ravel() for pixels in maps.values()])
    np.testing.assert_array_equal(stored, stored.astype(np.float16))


def test_a_preview_shows_it() -> None:
    stack = bake("--brdf", SPEC, *QUICK)
    command = ["preview", "out.rsibr.exr", "--size", "32", "--view", "0,-1,0", "-o", "sphere.exr"]
    assert run(command) == 0
    rgba = read_exr("sphere.exr")
    # The middle four pixels look along the normal, within 1/16 of a radian.
    expected = stack_radiance(stack, -NORMAL[[0, 2, 1]], -NORMAL[[0, 2, 1]], StackLook())
    np.testing.assert_allclose(rgba[15:17, 15:17, :3], np.broadcast_to(expected, (2, 2, 3)), rtol=5e-3)
    assert run(["preview", "out.rsibr.exr", "--lobes", "1", "--size", "32", "-o", "lobe.exr"]) == 0
    assert not np.allclose(read_exr("lobe.exr"), rgba, atol=1e-3)


@pytest.mark.slow
def test_small_maps_are_told(capfd: pytest.CaptureFixture[str]) -> None:
    spiky = np.random.default_rng(5).random((256, 512, 3), dtype=np.float32) ** 40
    write_radiance(Path("light.exr"), spiky, force=True)
    bake("--brdf", "ggx:alpha=0.1,f0=0.9", "--lobes", "1", "--slices", "2", "--size", "8")
    assert "Lookups in maps of 8 texels cost about" in capfd.readouterr().err


@pytest.mark.slow
@pytest.mark.parametrize(
    ("options", "complaint"),
    [
        (["--brdf", "velvet:a=1"], 'There is no BRDF model "velvet": choose one of'),
        (["--brdf", "merl:path=absent.binary"], "absent.binary"),
        (["--brdf", SPEC, "--lobes", "400"], "Lobes cannot be 400: choose 1 to 12"),
        (["--brdf", SPEC, "--slices", "1000"], "Elevations cannot be 1000: choose 1 to 256"),
        (["--brdf", SPEC, "--size", "1"], "Size cannot be 1 texels: choose 2 to 1024"),
        (["--brdf", SPEC, "--size", "4096"], "Size cannot be 4096 texels: choose 2 to 1024"),
        (["--fit", "absent.json"], "absent.json"),
        (["--fit", "light.exr"], "light.exr is no"),
        (
            ["--fit", "fit.json", "--lobes", "2"],
            "A fit has its own lobes: leave the options out, or give a BRDF",
        ),
    ],
)
def test_what_cannot_be_baked_is_told_in_one_sentence(
    options: list[str], complaint: str, capfd: pytest.CaptureFixture[str]
) -> None:
    assert run(["bake", "--environment", "light.exr", "-o", "out.rsibr.exr", *options]) == 1
    lines = capfd.readouterr().err.splitlines()
    (error,) = [line for line in lines if line.startswith("rsibr: error:")]
    assert complaint in error
    assert not Path("out.rsibr.exr").exists()


def test_light_too_bright_for_half_floats_is_kept(capfd: pytest.CaptureFixture[str]) -> None:
    write_radiance(Path("light.exr"), np.full((256, 512, 3), 1e5, dtype=np.float32), force=True)
    command = ["bake", "--environment", "light.exr", "--brdf", SPEC, *QUICK, "--half", "-o", "out.rsibr.exr"]
    assert run(command) == 0
    assert "maps of out.rsibr.exr are too bright or too dark for 16-bit floats" in capfd.readouterr().err
    maps = read_map_set("out.rsibr.exr").maps
    np.testing.assert_array_equal(maps["environment"], np.float32(1e5))


def test_existing_files_are_refused_before_anything_is_read(capfd: pytest.CaptureFixture[str]) -> None:
    Path("out.rsibr.exr").touch()
    assert run(["bake", "--environment", "absent", "--brdf", SPEC, "-o", "out.rsibr.exr"]) == 1
    assert "out.rsibr.exr exists" in capfd.readouterr().err


@pytest.mark.parametrize("options", [[], ["--brdf", SPEC, "--fit", "fit.json"]])
def test_a_brdf_or_a_fit_is_given(options: list[str]) -> None:
    assert run(["bake", "--environment", "light.exr", "-o", "out.rsibr.exr", *options]) == 1
