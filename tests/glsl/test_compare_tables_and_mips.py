"""`rsibr compare` of reflection tables and mip chains: right where the answer is known, refused in words."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from rsibr.rsibr_addon.command_line.main import run
from rsibr.rsibr_addon.core.progress import drain
from rsibr.rsibr_addon.files.map_set import read_map_set, write_map_set
from rsibr.rsibr_addon.files.radiance_pictures import write_radiance
from rsibr.rsibr_addon.settings.mip_chain import MipComparison
from rsibr.rsibr_addon.settings.reflection_tables import TablesComparison
from rsibr.rsibr_addon.tasks.compare.compare import compare
from rsibr.rsibr_addon.tasks.compare.reflection_tables import TablesWay

LIGHT = 0.1 + np.random.default_rng(61).random((32, 64, 3), dtype=np.float32) ** 4
QUICK = TablesComparison(views=2, size=32, rings=32)


@pytest.fixture(autouse=True)
def _in_a_folder_with_light(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    write_radiance(tmp_path / "light.exr", LIGHT)


def baked(kind: str, *words: str) -> Path:
    path = Path("baked.rsibr.exr")
    bake = ["bake", kind, "--environment", "light.exr", *words, "-o", str(path), "--progress", "none"]
    assert run(bake) == 0
    return path


@pytest.mark.parametrize(
    ("parts", "most"),
    [
        # A table of 72 x 36 is off by .0015 at most, rings turned into the camera's axes by some .5 %
        (["--diffuse", "lambert:kd=0.5"], 0.01),
        (["--specular", "phong:n=20,ks=0.5", "--diffuse", "lambert:kd=0.3"], 0.02),
        # In light that is noise from texel to texel, at an outline where directions turn within a sample
        (["--material", "glass"], 0.05),
        (["--diffuse", "luminous:kd=0.5", "--emission", "0.2/0.1/0"], 1e-4),
    ],
    ids=["lambert", "phong", "glass", "even"],
)
def test_tables_are_what_they_stand_for(parts: list[str], most: float) -> None:
    found = drain(compare(baked("reflection-tables", *parts), QUICK, Path("out")))
    faded, plain = found.errors
    assert (faded.way, plain.way) == (TablesWay(True), TablesWay(False))
    assert faded.worst < most
    assert faded.pooled <= plain.pooled
    assert "integrated exactly" in Path("out/index.html").read_text()


def test_light_from_beneath_the_horizon_is_an_error_that_a_fade_takes() -> None:
    path = baked("reflection-tables", "--specular", "phong:n=3,ks=1")
    faded, plain = drain(compare(path, QUICK, Path("out"))).errors
    assert faded.pooled < 0.6 * plain.pooled


def test_a_known_error_is_found() -> None:
    path = baked("reflection-tables", "--diffuse", "lambert:kd=0.5")
    bright = read_map_set(path)
    maps = {**bright.maps, "diffuse": 1.25 * bright.maps["diffuse"]}
    write_map_set(Path("bright.rsibr.exr"), replace(bright, maps=maps))
    found = drain(compare(Path("bright.rsibr.exr"), QUICK, Path("out")))
    assert found.errors[0].median == pytest.approx(0.25, abs=0.01)


@pytest.mark.parametrize("filter", ["ggx", "box"])
def test_mips_are_near_the_lobe_that_they_are_asked_for(filter: str) -> None:
    path = baked("mip-chain", "--size", "32", "--filter", filter)
    views = {"views": 2, "size": 32, "rings": 32}
    near = drain(compare(path, MipComparison(exponent=20.0, f0=(0.5,) * 3, **views), Path("near")))
    far = drain(compare(path, MipComparison(roughness=0.9, f0=(1.0,) * 3, **views), Path("far")))
    # The lobes are of one spread, not of one shape; microfacets shadow each other, which no mip knows
    assert near.errors[0].pooled < 0.12 < far.errors[0].pooled


def test_box_mips_state_their_bound() -> None:
    header = read_map_set(baked("mip-chain", "--size", "32", "--filter", "box")).header
    assert header["error_bound"] == {"relative_to_peak": 2.0**-24}


def test_what_cannot_be_compared_is_refused(capfd: pytest.CaptureFixture[str]) -> None:
    assert run(["compare", str(baked("mip-chain", "--size", "32")), "-o", "out"]) == 1
    assert "give a roughness or an exponent" in capfd.readouterr().err
    Path("baked.rsibr.exr").unlink()
    assert run(["compare", str(baked("kernel-bank", "--size", "64")), "-o", "out"]) == 1
    told = capfd.readouterr().err
    assert all(kind in told for kind in ("reflection tables", "mip chain", "lobe stack", "radiance views"))
