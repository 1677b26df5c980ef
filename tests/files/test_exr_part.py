"""Channels of a part side by side: without a copy where a file holds red, green and blue alone."""

from pathlib import Path

import numpy as np
import OpenEXR
import pytest
from rsibr.rsibr_addon.files.exr import read_parts, write_parts
from rsibr.rsibr_addon.files.exr_part import Part


@pytest.fixture
def rgba() -> np.ndarray:
    return np.random.default_rng(0).random((5, 8, 4), np.float32)


@pytest.mark.parametrize("names", ["RGB", "RGBA"])
def test_colours_alone_are_read_side_by_side(tmp_path: Path, rgba: np.ndarray, names: str) -> None:
    path = tmp_path / "a.exr"
    pixels = rgba[..., : len(names)]
    write_parts(path, [Part("", {names: pixels})])
    (part,) = read_parts(path)
    together = part.side_by_side(names)
    np.testing.assert_array_equal(together, pixels)
    assert all(np.shares_memory(together, channel) for channel in part.channels.values())
    # In another order, or some of them, they do not lie so
    np.testing.assert_array_equal(part.side_by_side("BGR"), pixels[..., 2::-1])
    np.testing.assert_array_equal(part.side_by_side("RG"), pixels[..., :2])


def test_colours_of_different_types_are_read_one_by_one(tmp_path: Path, rgba: np.ndarray) -> None:
    path = tmp_path / "a.exr"
    planes = {name: np.ascontiguousarray(rgba[::-1, :, i]) for i, name in enumerate("RGB")}
    planes["G"] = planes["G"].astype(np.float16)
    OpenEXR.File({"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage}, planes).write(
        str(path)
    )
    (part,) = read_parts(path)
    np.testing.assert_array_equal(part.channels["G"], rgba[..., 1].astype(np.float16))
    np.testing.assert_array_equal(part.side_by_side("RB"), rgba[..., [0, 2]])


def test_a_part_with_more_is_read_one_by_one(tmp_path: Path, rgba: np.ndarray) -> None:
    path = tmp_path / "a.exr"
    planes = {name: rgba[..., i] for i, name in enumerate(["R", "G", "B", "Z"])}
    write_parts(path, [Part("", planes)])
    (part,) = read_parts(path)
    assert part.channels.keys() == planes.keys()
    np.testing.assert_array_equal(part.side_by_side("RGB"), rgba[..., :3])
