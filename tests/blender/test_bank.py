"""`rsibr bank` and its operator; and pictures drawn from what they make."""

import json
from pathlib import Path

import bpy
import numpy as np
import pytest
import rsibr
from rsibr.rsibr_addon.command_line.main import run
from rsibr.rsibr_addon.core.lobes.bake import bake_bank
from rsibr.rsibr_addon.core.progress import drain
from rsibr.rsibr_addon.files.kinds.kernel_bank import from_map_set
from rsibr.rsibr_addon.files.map_set import read_map_set
from rsibr.rsibr_addon.files.pictures import read_exr
from rsibr.rsibr_addon.files.radiance_pictures import write_radiance


@pytest.fixture(autouse=True)
def light(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> np.ndarray:
    """An environment, light.exr, in the folder to work in."""
    monkeypatch.chdir(tmp_path)
    radiance = np.random.default_rng(52).random((64, 128, 3), dtype=np.float32) ** 4
    write_radiance(tmp_path / "light.exr", radiance)
    return radiance


def told(*arguments: str, capfd: pytest.CaptureFixture[str]) -> dict:
    run([*arguments, "--json", "--progress", "none"])
    return json.loads(capfd.readouterr().out.splitlines()[-1])


def test_the_command_writes_what_the_library_makes(light, capfd: pytest.CaptureFixture[str]) -> None:
    answer = told("bank", "--environment", "light.exr", "--size", "16", "-o", "a.rsibr.exr", capfd=capfd)
    expected = drain(bake_bank(light, "dual_paraboloid", 16)).filtered
    assert (answer["kernels"], answer["sharpest"]) == (len(expected.bank), expected.sharpest)
    held = from_map_set(Path("a.rsibr.exr"), read_map_set(Path("a.rsibr.exr"), "kernel_bank"))
    assert held.bank == expected.bank
    np.testing.assert_array_equal(held.maps, expected.maps.astype(np.float32))


def test_the_operator_does_the_same(light) -> None:
    rsibr.register()
    try:
        assert bpy.ops.rsibr.bake_kernel_bank(filepath="b.rsibr.exr", environment="light.exr", size=16) == {
            "FINISHED"
        }
        with pytest.raises(RuntimeError, match="exists"):
            bpy.ops.rsibr.bake_kernel_bank(filepath="b.rsibr.exr", environment="light.exr", size=16)
    finally:
        rsibr.unregister()
    expected = drain(bake_bank(light, "dual_paraboloid", 16)).filtered
    held = from_map_set(Path("b.rsibr.exr"), read_map_set(Path("b.rsibr.exr")))
    np.testing.assert_array_equal(held.bound, expected.bound)


@pytest.mark.slow
@pytest.mark.needs("gl")
def test_one_bank_is_any_material(capfd: pytest.CaptureFixture[str]) -> None:
    told("bank", "--environment", "light.exr", "--size", "16", "-o", "a.rsibr.exr", capfd=capfd)
    looks = {
        "grey": ("--brdf", "lambert:kd=0.5"),
        "half": ("--brdf", "lambert:kd=0.25"),
        "rough": ("--brdf", "ggx:alpha=0.3,f0=0.5", "--roughness", "0.8", "--lobe-count", "2"),
    }
    pictures = {}
    for name, options in looks.items():
        answer = told("preview", "a.rsibr.exr", "--size", "48", *options, "-o", f"{name}.exr", capfd=capfd)
        assert answer["ok"], answer
        pictures[name] = read_exr(Path(f"{name}.exr"))[..., :3]
    # Half floats on the GPU, and in each of a pixel's samples
    np.testing.assert_allclose(pictures["half"], 0.5 * pictures["grey"], atol=2e-3)
    assert np.abs(pictures["rough"] - pictures["grey"]).max() > 0.02
    refused = told("preview", "a.rsibr.exr", "--brdf", "gold", "-o", "gold.exr", capfd=capfd)
    assert 'There is no BRDF model "gold"' in refused["error"]
    refused = told("preview", "a.rsibr.exr", "--lobes", "1", "-o", "gold.exr", capfd=capfd)
    assert "not for kernel_bank" in refused["error"]
