"""Files of baked inputs, written and read, and what is none."""

import json
from pathlib import Path

import numpy as np
import pytest
from rsibr.rsibr_addon.core.errors import InputFileError, OutputFileError
from rsibr.rsibr_addon.core.materials.principled import Texture
from rsibr.rsibr_addon.files.baked_inputs import (
    ATTRIBUTE,
    CORNERS,
    BakedInputs,
    is_whole,
    read_baked_inputs,
    textures_of,
    unwrapping_name,
    write_baked_inputs,
)
from rsibr.rsibr_addon.files.exr import write_parts
from rsibr.rsibr_addon.files.exr_part import Part
from rsibr.rsibr_addon.files.radiance_pictures import write_radiance

RNG = np.random.default_rng(5)
PICTURES = {
    (0, ("base_color",)): RNG.uniform(-1.0, 9.0, (8, 8, 3)).astype(np.float32),
    (2, ("metallic", "roughness")): RNG.uniform(0.0, 1.0, (8, 8, 3)).astype(np.float32),
}
CHANNELS = {name: np.zeros((2, 2), np.float32) for name in "RGB"}
DESCRIPTION = json.dumps({"uv_map": "UVMap", "corners": 0, "remarks": []})


@pytest.mark.parametrize("corners", [None, RNG.uniform(0.0, 1.0, (5000, 2)).astype(np.float32)])
def test_what_is_written_is_read(corners: np.ndarray | None, tmp_path: Path) -> None:
    path = tmp_path / "a.exr"
    baked = BakedInputs(PICTURES, "" if corners is not None else "UVMap", corners, ("It overlaps.",))
    write_baked_inputs(path, baked)
    assert is_whole(path)
    found = read_baked_inputs(path)
    assert found.pictures.keys() == PICTURES.keys()
    for key, texels in PICTURES.items():
        np.testing.assert_array_equal(found.pictures[key], texels)
    assert (found.corners is None) == (corners is None)
    if corners is not None:
        np.testing.assert_array_equal(found.corners, corners)
    assert (found.uv_map, found.remarks) == (baked.uv_map, baked.remarks)
    with pytest.raises(OutputFileError, match="exists"):
        write_baked_inputs(path, baked)


def test_textures_name_their_pictures_and_unwrapping(tmp_path: Path) -> None:
    path = tmp_path / "a.exr"
    on_uv_map = textures_of(path, BakedInputs(PICTURES, "UVMap"))
    texture = Texture("2 metallic roughness", bake=str(path), uv_map="UVMap", extension="EXTEND")
    assert on_uv_map[2] == [(("metallic", "roughness"), texture)]
    ((_, texture),) = textures_of(path, BakedInputs(PICTURES, "", np.zeros((4, 2), np.float32)))[0]
    assert texture.uv_map == unwrapping_name(path)


def test_what_holds_none_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "a.exr"
    assert not is_whole(path)
    write_radiance(path, np.ones((4, 8, 3), np.float32))
    assert not is_whole(path)
    with pytest.raises(InputFileError, match="holds no baked inputs"):
        read_baked_inputs(path)


@pytest.mark.parametrize(
    "name", ["", "0", "base_color", "x base_color", "0 colour", "0 metallic roughness ior alpha"]
)
def test_parts_of_other_names_are_refused(name: str, tmp_path: Path) -> None:
    path = tmp_path / "a.exr"
    write_parts(path, [Part(name, CHANNELS, {ATTRIBUTE: DESCRIPTION})])
    with pytest.raises(InputFileError, match="holds no baked inputs"):
        read_baked_inputs(path)


@pytest.mark.parametrize("count", [-1, 9])
def test_corners_that_are_not_there_are_refused(count: int, tmp_path: Path) -> None:
    path = tmp_path / "a.exr"
    description = json.dumps({"uv_map": "", "corners": count, "remarks": []})
    first = Part("0 base_color", CHANNELS, {ATTRIBUTE: description})
    write_parts(path, [first, Part(CORNERS, {axis: np.zeros((2, 4), np.float32) for axis in "UV"})])
    with pytest.raises(InputFileError, match="holds no baked inputs"):
        read_baked_inputs(path)


def test_what_is_cut_short_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "a.exr"
    write_baked_inputs(path, BakedInputs(PICTURES, "UVMap"))
    whole = path.read_bytes()
    for length in (0, 3, 100, len(whole) // 2, len(whole) - 9):
        path.write_bytes(whole[:length])
        with pytest.raises(InputFileError):
            read_baked_inputs(path)
