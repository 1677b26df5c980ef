"""Radiance views from photographs of a painted ball, beside those of the paint itself."""

import json
from pathlib import Path

import numpy as np
import pytest
from rsibr.rsibr_addon.command_line.main import run
from rsibr.rsibr_addon.core.brdf.spec import brdf_from_spec
from rsibr.rsibr_addon.core.conventions import texel_centres
from rsibr.rsibr_addon.core.errors import InputFileError
from rsibr.rsibr_addon.core.geometry.geodesic import geodesic_sphere
from rsibr.rsibr_addon.core.geometry.lit_sphere import lit_spheres
from rsibr.rsibr_addon.core.kinds.radiance_views.views import RadianceViews
from rsibr.rsibr_addon.core.maps import sphere_map
from rsibr.rsibr_addon.core.maps.representation import representation
from rsibr.rsibr_addon.core.progress import drain
from rsibr.rsibr_addon.files.ball_list import read_ball_list
from rsibr.rsibr_addon.files.kinds.radiance_views import from_map_set
from rsibr.rsibr_addon.files.map_set import read_map_set
from rsibr.rsibr_addon.files.radiance_pictures import write_radiance
from rsibr.tests.synthetic_views import environment_radiance

PAINT = "layered:coat=(ggx:alpha=0.3,f0=0.04),base=(lambert:kd=0.5)"
SIZE, WIDTH, HEIGHT = 16, 200, 150
CIRCLES = [(83.5, 70.25, 60.0), (110.0, 80.0, 55.5), (90.0, 72.0, 64.0), (101.0, 66.0, 62.0)]
VIEW_DIRS = geodesic_sphere(12).vertices[[0, 4, 7, 9]]


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with the light, the photographs, their list, and the same directions as a file."""
    folder = tmp_path_factory.mktemp("ball")
    radiance = environment_radiance(representation("equirect").texel_directions(64)[0]).astype(np.float32)
    write_radiance(folder / "light.exr", radiance)
    paint = brdf_from_spec(PAINT, lambda name, path: pytest.fail(path))
    spheres = drain(lit_spheres(paint, radiance, list(VIEW_DIRS), 32))
    pixels = texel_centres(WIDTH, HEIGHT) * (WIDTH, HEIGHT)
    photographs = []
    for number, (sphere, (x, y, radius)) in enumerate(zip(spheres, CIRCLES, strict=True)):
        on_ball = (pixels - (x, HEIGHT - y)) / radius
        seen = sphere.at(sphere_map.normal_from_uv(0.5 * on_ball + 0.5) @ sphere.frame.T)
        # The wall behind the ball is dark
        seen = np.where(np.linalg.norm(on_ball, axis=-1, keepdims=True) < 1.0, seen, 0.01)
        write_radiance(folder / f"{number}.exr", seen.astype(np.float32))
        told = {"file": f"{number}.exr", "view_dir": (3.0 * VIEW_DIRS[number]).tolist()}
        photographs.append(told if number == 3 else told | {"circle": [x, y, radius]})
    (folder / "photographs.json").write_text(json.dumps({"photographs": photographs}))
    (folder / "views.json").write_text(json.dumps(VIEW_DIRS.tolist()))
    return folder


def captured(folder: Path, name: str, *more: str) -> RadianceViews:
    arguments = ["bake", "radiance-views", "--environment", str(folder / "light.exr"), "--size", str(SIZE)]
    path = folder / f"{name}.rsibr.exr"
    assert run([*arguments, *more, "-o", str(path)]) == 0
    return from_map_set(path, read_map_set(path, "radiance_views"))


@pytest.mark.slow
def test_photographs_of_a_ball_are_the_views_of_its_paint(folder: Path) -> None:
    photographed = captured(
        folder, "photographed", "--material", "paint", "--photographs", str(folder / "photographs.json")
    )
    of_model = captured(folder, "model", "--material", PAINT, "--view-file", str(folder / "views.json"))
    np.testing.assert_allclose(photographed.sphere.vertices, VIEW_DIRS, atol=1e-6)
    assert not photographed.diffuse.any()
    centres = texel_centres(SIZE, SIZE)
    inner = np.linalg.norm(2.0 * centres - 1.0, axis=-1) < 0.85
    error = np.abs(photographed.glossy - of_model.combined) / of_model.combined
    # Radiance changes by its own half over a radius of some 60 pixels, and is interpolated between them
    assert error[:3, inner].max() < 2e-3
    # Where the circle was found and not given, it is so to a tenth of a pixel
    assert error[3, inner].max() < 2e-2
    # The outermost pixels mix with the wall: one of 4 across a texel there
    assert np.median(error[:3, ~inner & (np.linalg.norm(2.0 * centres - 1.0, axis=-1) < 1.0)]) < 2e-2


def test_lists_that_are_none_are_refused(folder: Path) -> None:
    path = folder / "bad.json"
    for told, message in (
        ({"photographs": []}, "photographs"),
        ({"photographs": [{"file": "0.exr"}]}, "view_dir"),
        ({"photographs": [{"file": "0.exr", "view_dir": [0, 0, 0]}]}, "is 0 or not finite"),
        ([1], r"is no list of photographs, as it is not an object: write \{"),
    ):
        path.write_text(json.dumps(told))
        with pytest.raises(InputFileError, match=message):
            read_ball_list(path)


def test_a_list_and_a_file_of_directions_are_not_given_together(
    folder: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    lists = ["--photographs", str(folder / "photographs.json"), "--view-file", str(folder / "views.json")]
    arguments = ["bake", "radiance-views", "--environment", str(folder / "light.exr"), "--material", "paint"]
    assert run([*arguments, *lists, "-o", str(folder / "both.rsibr.exr")]) == 1
    assert "leave the view file out" in capfd.readouterr().err


def test_a_missing_photograph_is_told(folder: Path, capfd: pytest.CaptureFixture[str]) -> None:
    path = folder / "gone.json"
    path.write_text(json.dumps({"photographs": [{"file": "gone.exr", "view_dir": [0, 0, 1]}]}))
    arguments = ["bake", "radiance-views", "--environment", str(folder / "light.exr"), "--material", "paint"]
    assert run([*arguments, "--photographs", str(path), "-o", str(folder / "gone.rsibr.exr")]) != 0
    assert "gone.exr" in capfd.readouterr().err
    assert not (folder / "gone.rsibr.exr").exists()
