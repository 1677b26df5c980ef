"""The materials that come with us, as assets with pictures."""

from pathlib import Path

import bpy
import numpy as np
import pytest
from rsibr.rsibr_addon.core.brdf.cycles_presets import PRESETS, preset_title
from rsibr.rsibr_addon.core.geometry.directions import reflect
from rsibr.rsibr_addon.core.maps.representation import representation
from rsibr.rsibr_addon.core.pictures.sphere import sphere_pixels
from rsibr.rsibr_addon.core.progress import drain
from rsibr.rsibr_addon.core.resample import lookup
from rsibr.rsibr_addon.host.assets import Asset, write_library
from rsibr.rsibr_addon.host.scenes import temporary_scene
from rsibr.rsibr_addon.tasks import assets
from rsibr.rsibr_addon.tasks.light.environments import load_environment
from rsibr.rsibr_addon.tasks.reflectance.material_picture import (
    ENVIRONMENT,
    STRENGTH,
    VIEW_DIR,
    lit_pyramid,
    material_picture,
    principled_sphere,
)

SIZE = 32


@pytest.fixture(scope="module")
def library(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("assets") / "materials.blend"
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(assets, "SIZE", SIZE)
        patch.setattr(assets, "SAMPLES", 1)
        patch.setattr(assets, "MAPS", 128)
        before = {each.session_uid for each in bpy.data.all_ids}
        assert drain(assets.write_assets(path)) == list(map(preset_title, PRESETS))
        assert {each.session_uid for each in bpy.data.all_ids} == before
    return path


def pictures(path: Path) -> dict[str, np.ndarray]:
    """Name -> what is told of an asset, and its picture."""
    with temporary_scene():
        with bpy.data.libraries.load(str(path), assets_only=True) as (there, wanted):
            wanted.materials = list(there.materials)
        found = {}
        for material in wanted.materials:
            width, height = material.preview.image_size
            stored = np.array(material.preview.image_pixels_float[:]).reshape(height, width, 4)
            found[material.name] = material.asset_data.description, stored
    return found


def test_all_are_there_with_pictures(library: Path) -> None:
    found = pictures(library)
    assert set(found) == set(map(preset_title, PRESETS))
    for name, preset in PRESETS.items():
        told, picture = found[preset_title(name)]
        assert told == preset.summary
        assert picture.shape == (SIZE, SIZE, 4)
        assert picture[0, 0, 3] == 0.0
        assert picture[SIZE // 2, SIZE // 2, 3] == 1.0


def test_pictures_have_the_materials_colours(library: Path) -> None:
    found = {
        name: picture[8:24, 8:24, :3].mean(axis=(0, 1)) for name, (_, picture) in pictures(library).items()
    }
    for name in ("Gold", "Copper", "Plastic", "Varnished Wood"):
        red, green, blue = found[name]
        assert red > green > blue, name
    assert found["Car Paint"].argmax() == 2
    assert found["Black Plastic"].mean() < 0.5 * found["Ceramic"].mean()


def test_a_mirror_shows_the_light() -> None:
    """In the directions that it reflects, as bright as the pictures' light is."""
    light = load_environment(ENVIRONMENT).radiance
    seen = sphere_pixels(SIZE, VIEW_DIR)
    view_dir = np.array(VIEW_DIR) / np.linalg.norm(VIEW_DIR)
    towards = np.broadcast_to(view_dir, seen.normal.shape)
    mirrored = lookup(light[None], reflect(towards, seen.normal), representation("equirect"))
    with temporary_scene():
        mirror = assets._surface(assets.build_preset("mirror"))
    picture = principled_sphere(drain(lit_pyramid(512)), mirror, SIZE)
    inside = seen.normal @ view_dir > 0.5
    error = np.abs(picture[..., :3][seen.inside] / STRENGTH - mirrored)[inside] / mirrored[inside].mean()
    # An octahedral map of 512 texels resamples 1024 by 512: edges blur, the median does not
    assert np.median(error) < 0.02


@pytest.mark.parametrize(
    ("spec", "same", "most"),
    [
        ("principled:metallic=1,base_color=0.3,roughness=0.5", "ggx:alpha=0.25,f0=0.3", 0.04),
        ("principled:base_color=0.5,specular_level=0", "lambert:kd=0.5", 0.01),
    ],
)
def test_both_ways_to_a_picture_agree(spec: str, same: str, most: float) -> None:
    """The shading of previews, and the sum over the light; all but a rim of 2 pixels."""
    shaded, summed = material_picture(spec), material_picture(same)
    covered = shaded[..., 3] == 1.0
    inside = covered & np.roll(covered, 2, axis=0) & np.roll(covered, -2, axis=0)
    inside &= np.roll(covered, 2, axis=1) & np.roll(covered, -2, axis=1)
    # A metal's lobes beside small lamps are up to a tenth of radiance off, which sRGB halves
    assert np.quantile(np.abs(shaded - summed)[inside], 0.99) < most


def test_a_library_holds_what_it_was_given(tmp_path: Path) -> None:
    with temporary_scene():
        material = bpy.data.materials.new("theirs")
        write_library(tmp_path / "one.blend", [Asset(material, "Gold", "gold", np.ones((4, 4, 4)))])
    ((name, (told, picture)),) = pictures(tmp_path / "one.blend").items()
    assert (name, told) == ("Gold", "gold")
    np.testing.assert_array_equal(picture, 1.0)
