"""Final is never worse than Good: no error that a file states is larger, and no map coarser."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from rsibr.rsibr_addon.command_line.main import run
from rsibr.rsibr_addon.core.maps.representation import representation
from rsibr.rsibr_addon.core.options import quality_values
from rsibr.rsibr_addon.core.progress import drain
from rsibr.rsibr_addon.files.kinds.registry import STORED
from rsibr.rsibr_addon.files.map_set import read_map_set_header
from rsibr.rsibr_addon.files.radiance_pictures import write_radiance
from rsibr.rsibr_addon.job import BakeJob
from rsibr.rsibr_addon.settings.light import Light
from rsibr.rsibr_addon.tasks.methods.bake import bake
from rsibr.tests.synthetic_ball import surroundings

TABLES = ("plastic", "chrome", "varnished")
LIGHTS = {"evening": (64, 0.0), "sun": (256, 3e3)}
"""Name -> rows of a map, and radiance of a sun of one texel in it."""

BOTH = [
    *(("reflection_tables", {"material": name}) for name in TABLES),
    ("kernel_bank", {}),
    ("kernel_pyramid", {}),
]
CASES = [(light, *case) for case in BOTH for light in LIGHTS]
CASES += [
    ("sun", "lobe_stack", {"fit": "fit.json"}),
    # Of the same lobes, as a longer chain has narrower ones
    ("evening", "mip_chain", {"roughness": (0.0, 0.25, 0.5, 1.0)}),
]


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Lights, and a fit."""
    folder = tmp_path_factory.mktemp("qualities")
    for name, (rows, sun) in LIGHTS.items():
        light = surroundings(representation("equirect").texel_directions(2 * rows)[0])
        light[rows // 3, rows // 2] += sun
        write_radiance(folder / f"{name}.exr", light)
    fit = ["--brdf", "phong:n=10,ks=0.5", "--lobes", "1", "--slices", "4", "--method", "single"]
    assert run(["fit", *fit, "-o", str(folder / "fit.json")]) == 0
    return folder


def stated(kind: str, given: dict[str, Any], quality: str, light: Path) -> dict[str, Any]:
    """The header of what a quality bakes."""
    values = quality_values(STORED[kind].settings, quality)
    if "fit" in given:
        values = {name: value for name, value in values.items() if name in ("half", "size")}
        given = {"fit": str(light.with_name(given["fit"]))}
    output = light.with_name("out.rsibr.exr")
    settings = STORED[kind].settings(**values, **given)
    drain(bake(BakeJob(settings, str(output), Light(environment=str(light)), force=True)))
    return read_map_set_header(output)


def errors(header: dict[str, Any]) -> dict[str, Any]:
    """Each error that is stated: of kernels one by one, as a larger map has narrower ones."""
    kernels = [part for part in header["parts"] if "concentration" in part]
    if not kernels:
        return dict(header["error_bound"] or {})
    return {
        f"{name} {part['concentration']}": part[name]
        for part in kernels
        for name in ("bound", "interpolation")
    }


@pytest.mark.filterwarnings("ignore:.*for 16-bit floats")
@pytest.mark.slow
@pytest.mark.parametrize(("light", "kind", "given"), CASES, ids=str)
def test_final_is_never_worse_than_good(folder: Path, light: str, kind: str, given: dict[str, Any]) -> None:
    good, final = (stated(kind, given, quality, folder / f"{light}.exr") for quality in ("good", "final"))
    assert errors(final).keys() >= errors(good).keys()
    for name, error in errors(good).items():
        # A finer map finds a larger or smaller value of the same light
        assert np.all(np.array(errors(final)[name]) <= 1.01 * np.array(error)), name
    sizes = [{part["role"]: part["size"] for part in header["parts"]} for header in (good, final)]
    assert sizes[0].keys() == sizes[1].keys()
    assert all(np.all(np.array(sizes[1][role]) >= size) for role, size in sizes[0].items())
    if kind == "reflection_tables":
        # What the lobes do not need, no file has
        others = [{role: size for role, size in found.items() if role != "diffuse"} for found in sizes]
        assert others[0] == others[1]
