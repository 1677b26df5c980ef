"""Reflection tables as images: painted, undone, saved and saved back."""

from pathlib import Path

import bpy
import numpy as np
import pytest
from rsibr.rsibr_addon.core.errors import MapSetError, ShapeError
from rsibr.rsibr_addon.files.map_set import read_map_set, read_map_set_header, write_map_set
from rsibr.rsibr_addon.files.map_set_facts import told_making
from rsibr.rsibr_addon.files.map_set_header import content_hash
from rsibr.rsibr_addon.host.map_sets import written_path
from rsibr.tests.faults.small_map_sets import map_sets

pytestmark = pytest.mark.usefixtures("registered")


@pytest.fixture
def source(tmp_path: Path) -> Path:
    """Tables, among whose values are some that 16 bits do not hold, and which shade the active object."""
    (tables,) = (each for each in map_sets() if each.kind == "reflection_tables")
    tables.maps["specular"][0, 0] = (1e-7, 1.0 + 2.0**-23, 123456.7)
    path = tmp_path / "tables.rsibr.exr"
    write_map_set(path, tables)
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "scene.blend"))
    assert bpy.ops.rsibr.assign(filepath=str(path)) == {"FINISHED"}
    return path


def settings() -> bpy.types.PropertyGroup:
    return bpy.data.objects["Cube"].rsibr


def image(name: str) -> bpy.types.Image:
    return settings().painted[name].image


def painted(name: str, radiance: float) -> None:
    """Fill an image's lowest row."""
    pixels = np.empty(len(image(name).pixels), np.float32)
    image(name).pixels.foreach_get(pixels)
    pixels[: 4 * image(name).size[0]] = radiance
    image(name).pixels.foreach_set(pixels)


def saved_back() -> Path:
    assert bpy.ops.rsibr.save_back() == {"FINISHED"}
    assert not settings().painted
    return written_path(settings())


def test_what_is_not_painted_comes_back_to_the_last_bit(source: Path) -> None:
    before = read_map_set(source)
    bpy.ops.rsibr.edit_as_images()
    assert {each.name for each in settings().painted} == before.maps.keys() - {"environment", "weights"}
    path = saved_back()
    after = read_map_set(path)
    for name, pixels in before.maps.items():
        np.testing.assert_array_equal(after.maps[name], pixels)
    assert after.header["painted"] == {"of": content_hash(read_map_set_header(source)), "parts": []}
    assert source.is_file()
    assert path != source


def test_the_object_shows_paint_at_once_and_the_file_tells_of_it(source: Path) -> None:
    bpy.ops.rsibr.edit_as_images()
    painted("specular", 7.0)
    np.testing.assert_array_equal(read_map_set(written_path(settings())).maps["specular"][0], 7.0)
    painted("specular", 5.0)
    shown = read_map_set(written_path(settings()))
    np.testing.assert_array_equal(shown.maps["specular"][0], 5.0)
    path = saved_back()
    after = read_map_set(path)
    np.testing.assert_array_equal(after.maps["specular"], shown.maps["specular"])
    assert after.header["painted"]["parts"] == ["specular"]
    assert "recipe" not in after.header
    assert told_making(read_map_set_header(path))["Painted"] == "specular"
    # A second time, of the painted file
    bpy.ops.rsibr.edit_as_images()
    painted("diffuse", 0.5)
    again = saved_back()
    assert read_map_set_header(again)["painted"]["parts"] == ["diffuse", "specular"]
    assert again.name.count("painted") == 1


def test_paint_is_kept_in_the_blend_and_discarded_on_demand(source: Path) -> None:
    bpy.ops.rsibr.edit_as_images()
    painted("specular", 123456.7)
    before = read_map_set(written_path(settings())).maps
    bpy.ops.wm.save_mainfile()
    bpy.ops.wm.open_mainfile(filepath=bpy.data.filepath)
    after = read_map_set(written_path(settings())).maps
    for name, pixels in before.items():
        np.testing.assert_array_equal(after[name], pixels)
    assert bpy.ops.rsibr.discard_paint() == {"FINISHED"}
    assert written_path(settings()) == source
    assert not bpy.data.images.get("tables specular")


def test_undo_takes_the_images_back(source: Path) -> None:
    bpy.ops.ed.undo_push(message="assigned")
    bpy.ops.rsibr.edit_as_images()
    bpy.ops.ed.undo_push(message="painting")
    bpy.ops.rsibr.save_back()
    bpy.ops.ed.undo_push(message="saved")
    bpy.ops.ed.undo()
    assert image("specular").size[:] == read_map_set(source).maps["specular"].shape[1::-1]
    bpy.ops.rsibr.save_back()
    bpy.ops.ed.undo_push(message="saved again")
    bpy.ops.ed.undo()
    assert settings().painted
    bpy.ops.ed.undo()
    assert not settings().painted
    assert written_path(settings()) == source


def test_a_picture_in_a_file_is_taken_and_images_that_do_not_fit_are_refused(source: Path) -> None:
    bpy.ops.rsibr.edit_as_images()
    painted("specular", 3.0)
    file = image("specular")
    file.filepath_raw, file.file_format = str(source.with_name("painted.exr")), "OPEN_EXR"
    file.save()
    settings().painted["specular"].image = bpy.data.images.load(file.filepath_raw)
    shown = read_map_set(written_path(settings())).maps["specular"]
    np.testing.assert_array_equal(shown[0], 3.0)
    bytes_only = bpy.data.images.new("bytes", *file.size)
    settings().painted["specular"].image = bytes_only
    with pytest.raises(MapSetError, match="bytes has 8 bits a channel"):
        written_path(settings())
    settings().painted["specular"].image = file
    file.scale(4, 2)
    with pytest.raises(ShapeError, match="texels, not 4x2: resize it back"):
        written_path(settings())
    with pytest.raises(RuntimeError, match="resize it back"):
        bpy.ops.rsibr.save_back()
    assert settings().painted


def test_another_map_set_ends_painting_and_keeps_the_images(source: Path) -> None:
    bpy.ops.rsibr.edit_as_images()
    name = image("specular").name
    bpy.ops.rsibr.assign(filepath=str(source))
    assert not settings().painted
    assert name in bpy.data.images


def test_a_kind_without_tables_says_so(tmp_path: Path) -> None:
    (chain,) = (each for each in map_sets() if each.kind == "mip_chain")
    write_map_set(tmp_path / "chain.rsibr.exr", chain)
    bpy.ops.rsibr.assign(filepath=str(tmp_path / "chain.rsibr.exr"))
    with pytest.raises(RuntimeError, match="no tables to paint: bake reflection tables"):
        bpy.ops.rsibr.edit_as_images()
