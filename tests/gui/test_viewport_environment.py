"""A picture of an environment shades an object in Blender's window, as a map set does."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from rsibr.rsibr_addon.files.radiance_pictures import write_radiance

Told = Callable[[str], dict]


@pytest.fixture(autouse=True)
def _pictures(job: Path) -> None:
    write_radiance(job / "even.exr", np.full((8, 16, 3), (0.5, 0.0, 0.5)), force=True)
    write_radiance(job / "even.hdr", np.full((8, 16, 3), (0.5, 0.0, 0.5)), force=True)
    write_radiance(job / "square.exr", np.ones((8, 8, 3)), force=True)


SCENARIO = """

def purple():
    return int(like(pixels(), (188, 0, 188)).sum())

def scenario(told):
    bare(view())
    bpy.context.scene.view_settings.view_transform = "Standard"
    cube = bpy.data.objects["Cube"]
    settings = cube.rsibr
    for name in ("even.exr", "even.hdr"):
        settings.map_set = "/job/" + name
        yield from drawn()
        told[name], told["kind"] = purple(), session().previews.kind(cube)
    settings.environment.antialiased = False
    yield from drawn()
    told["interpolated"] = purple()
    settings.environment.f_lambda = (0.1, 0.1, 0.1)
    yield from drawn()
    told["dim"], told["fault"] = purple(), session().previews.faults.message(cube)
    settings.map_set = "/job/square.exr"
    yield from drawn()
    told["square"] = session().previews.faults.message(cube)
"""


def test_an_object_mirrors_a_picture(told: Told) -> None:
    answer = told(SCENARIO)
    assert answer["kind"] == "environment"
    # In even light a perfect mirror has one colour, which a reflectance dims, but at grazing angles.
    assert answer["even.exr"] == answer["even.hdr"] == answer["interpolated"] > 2000
    assert answer["dim"] < 0.01 * answer["even.exr"]
    assert answer["fault"] is None
    assert "twice as wide as high" in answer["square"]
