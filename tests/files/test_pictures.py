"""Pictures through OpenEXR files, in every layout that a reader meets."""

import os
import struct
from pathlib import Path
from typing import Any

import numpy as np
import OpenEXR
import pytest
from rsibr.rsibr_addon.core.errors import InputFileError, OutputFileError, ShapeError
from rsibr.rsibr_addon.files.pictures import read_exr, write_exr

SCANLINES = {"type": OpenEXR.scanlineimage, "compression": OpenEXR.ZIP_COMPRESSION}


@pytest.fixture
def rgb() -> np.ndarray:
    """A picture as files hold it, top row first; exact in half floats."""
    return np.random.default_rng(0).integers(0, 2048, (30, 41, 3)).astype(np.float32) / 64


def write(path: Path, *parts: tuple[dict, dict[str, np.ndarray]]) -> Path:
    """Write a file with the package alone."""
    described = []
    for i, (header, channels) in enumerate(parts):
        planes = {name: np.ascontiguousarray(pixels) for name, pixels in channels.items()}
        described.append(OpenEXR.Part(dict(header), planes, str(i)))  # it writes into the header it is given
    OpenEXR.File(described).write(str(path))
    return path


def channels(rgb: np.ndarray, prefix: str = "") -> dict[str, np.ndarray]:
    return {prefix + name: rgb[..., i] for i, name in enumerate("RGB")}


def test_a_written_picture_reads_back_bit_by_bit(tmp_path: Path) -> None:
    rgba = np.random.default_rng(0).standard_normal((7, 5, 4)).astype(np.float32)
    rgba[0, 0] = (1e-40, 3e38, -0.0, np.inf)
    write_exr(tmp_path / "a.exr", rgba)
    np.testing.assert_array_equal(read_exr(tmp_path / "a.exr").view(np.uint32), rgba.view(np.uint32))


def test_others_read_a_written_picture_top_row_first(tmp_path: Path) -> None:
    rgba = np.random.default_rng(0).random((7, 5, 4), dtype=np.float32)
    write_exr(tmp_path / "a.exr", rgba[::-1, ::-1])  # a view with strides of its own
    with OpenEXR.File(str(tmp_path / "a.exr")) as file:
        (part,) = file.parts
        assert part.compression() == OpenEXR.ZIP_COMPRESSION
        np.testing.assert_array_equal(part.channels["RGBA"].pixels, rgba[:, ::-1])


def test_only_rgba_is_written(tmp_path: Path) -> None:
    with pytest.raises(ShapeError, match=r"a\.exr takes a picture of shape"):
        write_exr(tmp_path / "a.exr", np.zeros((7, 5, 3), np.float32))


def test_an_existing_picture_is_kept_unless_forced(tmp_path: Path) -> None:
    ones = np.ones((2, 2, 4), np.float32)
    write_exr(tmp_path / "a.exr", ones)
    with pytest.raises(OutputFileError, match="--force"):
        write_exr(tmp_path / "a.exr", 2 * ones)
    write_exr(tmp_path / "a.exr", 3 * ones, force=True)
    np.testing.assert_array_equal(read_exr(tmp_path / "a.exr"), 3 * ones)


@pytest.mark.skipif(not Path("/dev/full").is_char_device(), reason="this system has no /dev/full")
@pytest.mark.parametrize("size", [1, 8, 300])
def test_a_full_disk_is_noticed_also_by_small_files(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, size: int
) -> None:
    # A small file fits the system's buffers, so that only closing it fails
    real_open = Path.open
    monkeypatch.setattr(
        Path, "open", lambda path, mode: real_open(path if mode == "a" else Path("/dev/full"), mode)
    )
    with pytest.raises(OutputFileError, match=r"a\.exr was not written because the disk is full"):
        write_exr(tmp_path / "a.exr", np.random.default_rng(0).random((size, size, 4)))
    assert os.listdir(tmp_path) == []


def storage(compression: str, tiled: bool) -> dict[str, Any]:
    header = {"compression": getattr(OpenEXR, f"{compression}_COMPRESSION"), "type": OpenEXR.scanlineimage}
    if tiled:
        tiles = OpenEXR.TileDescription()
        tiles.xSize, tiles.ySize = 16, 16
        header |= {"type": OpenEXR.tiledimage, "tiles": tiles}
    return header


@pytest.mark.parametrize("dtype", [np.float16, np.float32])
@pytest.mark.parametrize(
    "compression", ["NO", "RLE", "ZIPS", "ZIP", "PIZ"]
)  # the lossless ones; the others are the package's own affair
@pytest.mark.parametrize("tiled", [False, True])
def test_every_storage_reads_back(
    tmp_path: Path, rgb: np.ndarray, dtype: type, compression: str, tiled: bool
) -> None:
    header = storage(compression, tiled)
    path = write(tmp_path / "a.exr", (header, channels(rgb.astype(dtype))))
    picture = read_exr(path)
    assert picture.dtype == np.float32
    np.testing.assert_array_equal(picture, rgb[::-1])


@pytest.mark.parametrize("size", [(2**25 + 8, 16), (16, 2**25 + 8), (2**31, 2**31), (2**32 - 1, 1)])
def test_tiles_that_no_program_writes_are_refused(
    tmp_path: Path, rgb: np.ndarray, size: tuple[int, int]
) -> None:
    tiles = OpenEXR.TileDescription()
    tiles.xSize, tiles.ySize = 2048, 1024  # larger than the picture, as some programs have it
    path = write(tmp_path / "a.exr", ({"type": OpenEXR.tiledimage, "tiles": tiles}, channels(rgb)))
    np.testing.assert_array_equal(read_exr(path), rgb[::-1])
    stated = struct.pack("<2I", 2048, 1024)
    assert path.read_bytes().count(stated) == 1
    path.write_bytes(path.read_bytes().replace(stated, struct.pack("<2I", *size)))
    with pytest.raises(InputFileError, match=r"a\.exr is (truncated or )?damaged"):
        read_exr(path)


@pytest.mark.parametrize(
    "compression", ["NO", "RLE", "ZIPS", "ZIP", "PIZ", "PXR24", "B44", "B44A", "DWAA", "DWAB"]
)
def test_a_picture_that_the_file_cannot_hold_is_refused_before_it_takes_memory(
    tmp_path: Path, compression: str
) -> None:
    header = {"compression": getattr(OpenEXR, f"{compression}_COMPRESSION"), "type": OpenEXR.scanlineimage}
    black = np.zeros((512, 512, 3), np.float16)
    path = write(tmp_path / "a.exr", (header, channels(black)))
    # What packs best is read
    np.testing.assert_array_equal(read_exr(path), black)
    attribute = b"dataWindow\0box2i\0" + struct.pack("<i", 16)
    data = path.read_bytes()
    start = data.index(attribute) + len(attribute)
    stated = struct.pack("<4i", 0, 0, 2**24 - 1, 511)
    path.write_bytes(data[:start] + stated + data[start + 16 :])
    with pytest.raises(InputFileError, match="it states more than it holds"):
        read_exr(path)


def test_bottom_row_first_files_read_the_same(tmp_path: Path, rgb: np.ndarray) -> None:
    path = write(tmp_path / "a.exr", (SCANLINES | {"lineOrder": OpenEXR.DECREASING_Y}, channels(rgb)))
    np.testing.assert_array_equal(read_exr(path), rgb[::-1])


def test_channels_may_differ_in_type_and_come_with_others(tmp_path: Path, rgb: np.ndarray) -> None:
    mixed = channels(rgb) | {"G": rgb[..., 1].astype(np.float16), "Z": rgb[..., 0], "A": rgb[..., 2]}
    mixed |= {"id": rgb[..., 0].astype(np.uint32), "diffuse.R": 9 * rgb[..., 0]}
    picture = read_exr(write(tmp_path / "a.exr", (SCANLINES, mixed)))
    np.testing.assert_array_equal(picture, rgb[::-1][..., [0, 1, 2, 2]])


def test_grey_has_one_channel(tmp_path: Path, rgb: np.ndarray) -> None:
    path = write(tmp_path / "a.exr", (SCANLINES, {"Y": rgb[..., 0]}))
    np.testing.assert_array_equal(read_exr(path), rgb[::-1, :, :1])


@pytest.mark.parametrize("shift", [(0, 0), (-3, 5), (45, -25)])
def test_a_data_window_is_placed_in_the_picture(tmp_path: Path, rgb: np.ndarray, shift: tuple) -> None:
    # A picture of 50x40 whose pixels are stored for a window at `shift` only
    x, y = shift
    height, width = rgb.shape[:2]
    windows = {
        "displayWindow": (np.int32([0, 0]), np.int32([49, 39])),
        "dataWindow": (np.int32([x, y]), np.int32([x + width - 1, y + height - 1])),
    }
    expected = np.zeros((40, 50, 3), np.float32)
    for row in range(40):
        for column in range(50):
            if 0 <= row - y < height and 0 <= column - x < width:
                expected[row, column] = rgb[row - y, column - x]
    path = write(tmp_path / "a.exr", (SCANLINES | windows, channels(rgb)))
    np.testing.assert_array_equal(read_exr(path), expected[::-1])


@pytest.mark.parametrize("names", ["Z", "RG", "id"])
def test_a_file_without_colour_is_refused(tmp_path: Path, rgb: np.ndarray, names: str) -> None:
    planes = dict.fromkeys(names, rgb[..., 0]) if names != "id" else channels(rgb.astype(np.uint32))
    with pytest.raises(InputFileError, match=r"a\.exr holds no colour .*: save it"):
        read_exr(write(tmp_path / "a.exr", (SCANLINES, planes)))


def test_deep_pixels_are_refused(tmp_path: Path) -> None:
    deep = np.empty((2, 3), object)
    for pixel in np.ndindex(deep.shape):
        deep[pixel] = np.ones(2, np.float32)
    header = {"type": OpenEXR.deepscanline, "compression": OpenEXR.ZIPS_COMPRESSION}
    OpenEXR.File(header, dict.fromkeys("RGB", deep)).write(str(tmp_path / "a.exr"))
    with pytest.raises(InputFileError, match=r"a\.exr holds deep pixels"):
        read_exr(tmp_path / "a.exr")


@pytest.mark.parametrize("compression", ["NO", "ZIP", "PIZ", "DWAB"])
@pytest.mark.parametrize("tiled", [False, True])
def test_a_truncated_picture_is_refused_wherever_it_ends(
    tmp_path: Path, rgb: np.ndarray, capsys: pytest.CaptureFixture[str], compression: str, tiled: bool
) -> None:
    header = storage(compression, tiled)
    path = write(tmp_path / "a.exr", (header, channels(rgb)))
    whole = path.read_bytes()
    for length in {*range(4, len(whole), len(whole) // 40), len(whole) - 1}:
        path.write_bytes(whole[:length])
        with pytest.raises(InputFileError, match=r"a\.exr is truncated or damaged"):
            read_exr(path)
    assert capsys.readouterr().out == ""  # where a command's result belongs
