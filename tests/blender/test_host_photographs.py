"""Pictures of 8 and 16 bits, and their way through `rsibr convert`."""

import struct
import zlib
from pathlib import Path

import bpy
import numpy as np
import pytest
from rsibr.rsibr_addon.command_line.main import run
from rsibr.rsibr_addon.core.errors import InputFileError
from rsibr.rsibr_addon.core.transfer_curve import linear_from_srgb
from rsibr.rsibr_addon.files.radiance_pictures import read_radiance
from rsibr.rsibr_addon.host.photographs import read_photograph

RNG = np.random.default_rng(0)
COLOUR_TYPE = {1: 0, 2: 4, 3: 2, 4: 6}
"""Channels -> how PNG calls them: grey, grey and alpha, RGB, RGBA."""


def write_png(path: Path, pixels: np.ndarray) -> None:
    """A PNG of the whole numbers given, row 0 at the bottom, written by the format's description."""
    height, width, channels = pixels.shape
    rows = pixels[::-1].astype(pixels.dtype.newbyteorder(">"))
    raw = b"".join(b"\0" + row.tobytes() for row in rows)

    def chunk(kind: bytes, data: bytes) -> bytes:
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    head = struct.pack(">IIBBBBB", width, height, 8 * pixels.itemsize, COLOUR_TYPE[channels], 0, 0, 0)
    path.write_bytes(
        b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", zlib.compress(raw)) + chunk(b"IEND", b"")
    )


@pytest.mark.parametrize("channels", [1, 3, 4])
@pytest.mark.parametrize("kind", [np.uint8, np.uint16])
def test_the_curve_is_undone(tmp_path: Path, kind: type, channels: int) -> None:
    most = np.iinfo(kind).max
    pixels = RNG.integers(0, most, (4, 6, channels), dtype=kind, endpoint=True)
    write_png(tmp_path / "a.png", pixels)
    colour = pixels[..., :1] if channels == 1 else pixels[..., :3]
    expected = np.broadcast_to(linear_from_srgb(colour / most), (4, 6, 3))
    # Blender holds the numbers as they are, in float32
    np.testing.assert_allclose(read_photograph(tmp_path / "a.png"), expected, atol=1e-6)


def test_nothing_is_left_in_the_file(tmp_path: Path) -> None:
    write_png(tmp_path / "a.png", np.zeros((2, 2, 3), np.uint8))
    before = [item.name_full for item in bpy.data.all_ids]
    read_photograph(tmp_path / "a.png")
    assert [item.name_full for item in bpy.data.all_ids] == before


@pytest.mark.parametrize("content", [b"", b"just text", b"\x89PNG\r\n\x1a\n", b"\xff\xd8\xff\xe0"])
def test_what_is_no_picture_is_refused(tmp_path: Path, content: bytes) -> None:
    (tmp_path / "a.jpg").write_bytes(content)
    with pytest.raises(InputFileError, match=r"a\.jpg cannot be read as a picture: check the file"):
        read_photograph(tmp_path / "a.jpg")


def test_a_photograph_is_converted(tmp_path: Path) -> None:
    pixels = np.full((8, 8, 3), 118, np.uint8)
    write_png(tmp_path / "ball.png", pixels)
    arguments = ["--from", "mirror_ball", "--to", "equirect", "--size", "8", "--distance", "20"]
    assert run(["convert", str(tmp_path / "ball.png"), str(tmp_path / "room.hdr"), *arguments]) == 0
    # The file keeps 1/256
    expected = linear_from_srgb(118 / 255)
    np.testing.assert_allclose(read_radiance(tmp_path / "room.hdr"), expected, rtol=1 / 256)
