"""Radiance pictures, written here by the format's description and read back."""

import itertools
import os
from pathlib import Path

import numpy as np
import pytest
from rsibr.rsibr_addon.core.errors import InputFileError, MemoryShortageError, RsibrWarning
from rsibr.rsibr_addon.files.chromaticities import XYZ, rec709_from
from rsibr.rsibr_addon.files.radiance_hdr import read_hdr, read_hdr_header

HEADER = b"#?RADIANCE\n# a comment\nFORMAT=32-bit_rle_rgbe\n"


def flat(line: np.ndarray) -> bytes:
    return line.tobytes()


def older_runs(line: np.ndarray) -> bytes:
    """A pixel, then for each run the digits of its remaining length as (1, 1, 1, digit)."""
    coded = b""
    for pixel, run in itertools.groupby(line.tolist()):
        rest = len(list(run)) - 1
        coded += bytes(pixel)
        while rest:
            coded += bytes([1, 1, 1, rest % 256])
            rest //= 256
    return coded


def newer_runs(line: np.ndarray) -> bytes:
    """Components one after another, each in runs (128 + n, value) and literals (n, values)."""
    coded = bytes([2, 2, len(line) >> 8, len(line) & 255])
    for component in line.T.tolist():
        for value, run in itertools.groupby(component):
            length = len(list(run))
            while length:
                step = min(length, 127)
                coded += bytes([128 + step, value]) if step > 2 else bytes([step]) + bytes([value] * step)
                length -= step
    return coded


def values(rgbe: np.ndarray) -> np.ndarray:
    """What the bytes stand for, in double precision."""
    scale = np.where(rgbe[..., 3:] > 0, 2.0 ** (rgbe[..., 3:].astype(float) - 136.0), 0.0)
    return rgbe[..., :3] * scale


@pytest.fixture
def rgbe() -> np.ndarray:
    """A picture with long and short runs, noise, black, and the format's extremes."""
    rng = np.random.default_rng(0)
    picture = rng.integers(2, 256, (6, 700, 4), dtype=np.uint8)
    picture[1, 20:620] = picture[1, 20]  # 599 repeats: two digits to the base 256
    picture[2] = (200, 100, 50, 130)
    picture[3, ::3] = 0
    picture[4, :, 1] = 7
    picture[5, 0], picture[5, 1] = (255, 255, 255, 255), (128, 3, 3, 1)
    return picture


@pytest.mark.parametrize("code", [flat, older_runs, newer_runs])
def test_every_coding_reads_back(tmp_path: Path, rgbe: np.ndarray, code) -> None:
    path = tmp_path / "a.hdr"
    path.write_bytes(HEADER + b"\n-Y 6 +X 700\n" + b"".join(map(code, rgbe)))
    # Powers of two times whole numbers: exact in float32; the first line of the file is the top row
    np.testing.assert_array_equal(read_hdr(path), values(rgbe)[::-1])


def test_codings_may_change_from_line_to_line(tmp_path: Path, rgbe: np.ndarray) -> None:
    codes = itertools.cycle([newer_runs, flat, older_runs])
    path = tmp_path / "a.hdr"
    path.write_bytes(
        HEADER + b"\n-Y 6 +X 700\n" + b"".join(code(line) for code, line in zip(codes, rgbe, strict=False))
    )
    np.testing.assert_array_equal(read_hdr(path), values(rgbe)[::-1])


@pytest.mark.parametrize("width", [1, 7, 8, 127, 128, 255, 256, 32767, 32768])
def test_widths_at_the_limits_of_the_codings(tmp_path: Path, width: int) -> None:
    line = np.random.default_rng(1).integers(2, 256, (1, width, 4), dtype=np.uint8)
    path = tmp_path / "a.hdr"
    code = newer_runs if 8 <= width < 32768 else older_runs
    path.write_bytes(HEADER + b"\n-Y 1 +X %d\n" % width + code(line[0]))
    np.testing.assert_array_equal(read_hdr(path), values(line))


@pytest.mark.parametrize("slow_sign", "+-")
@pytest.mark.parametrize("fast_sign", "+-")
@pytest.mark.parametrize("axes", ["YX", "XY"])
def test_every_order_of_the_axes(tmp_path: Path, axes: str, slow_sign: str, fast_sign: str) -> None:
    # Pixel (x, y), y from the bottom, is worth (x + 1, y + 1, 1), whatever order it is stored in
    width, height = 3, 5
    size = {"X": width, "Y": height}
    lines = b""
    slow_range, fast_range = range(size[axes[0]]), range(size[axes[1]])
    for slow in slow_range if slow_sign == "+" else reversed(slow_range):
        for fast in fast_range if fast_sign == "+" else reversed(fast_range):
            x, y = (fast, slow) if axes == "YX" else (slow, fast)
            lines += bytes([x + 1, y + 1, 1, 136]) if (x, y) != (0, 0) else bytes([2, 2, 2, 135])
    resolution = f"{slow_sign}{axes[0]} {size[axes[0]]} {fast_sign}{axes[1]} {size[axes[1]]}\n"
    path = tmp_path / "a.hdr"
    path.write_bytes(HEADER + b"\n" + resolution.encode() + lines)
    picture = read_hdr(path)
    x, y = np.meshgrid(np.arange(width), np.arange(height))
    np.testing.assert_array_equal(picture, np.stack([x + 1, y + 1, np.ones_like(x)], axis=-1))


PIXEL = np.array([[[128, 64, 32, 136]]], np.uint8)


@pytest.mark.parametrize(
    ("lines", "factors"),
    [
        (b"EXPOSURE=2\nEXPOSURE= 4.0\n", (8, 8, 8)),
        (b"COLORCORR=1 2 4\nEXPOSURE=0.5\n", (0.5, 1, 2)),
        (b"EXPOSURE=0\n", (1, 1, 1)),  # as FreeImage writes
        (b"COLORCORR=0 0 0\n", (1, 1, 1)),
        (b"\tEXPOSURE=3\n\tany=thing\n", (1, 1, 1)),  # an indented line is another program's history
        (b"EXPOSURE = 2\r\ncolorcorr=1, 2, 4\n", (2, 4, 8)),
        (b"EXPOSURE=1,5\nColorCorr= 0,5 1 2\n", (0.75, 1.5, 3)),
        (b"rpict -vta -av 1 1 1 room.oct\npfilt -e +2 x=3\nVIEW= -vta\nPIXASPECT=1\n#x=1\n", (1, 1, 1)),
        (b"PRIMARIES=0 0 0 0 0 0 0 0\nGAMMA=1\nSOFTWARE=x\n", (1, 1, 1)),  # as Photoshop writes
    ],
)
def test_what_was_multiplied_in_is_divided_out(tmp_path: Path, lines: bytes, factors: tuple) -> None:
    path = tmp_path / "a.hdr"
    path.write_bytes(HEADER + lines + b"\n-Y 1 +X 1\n" + PIXEL.tobytes())
    np.testing.assert_array_equal(read_hdr(path), np.float32(values(PIXEL) / factors))


@pytest.mark.parametrize(
    ("line", "factor"),
    [
        (b"EXPOSURE=much", 1),
        (b"EXPOSURE=", 1),
        (b"EXPOSURE=-2", 1),
        (b"EXPOSURE=nan", 1),
        (b"EXPOSURE=2 # stops", 2),
        (b"COLORCORR=1 1", 1),
        (b"COLORCORR=1 0 1", 1),
        (b"PRIMARIES=.64 .33 .3 .6 0 0 0 0", 1),
        (b"PRIMARIES=nan nan nan nan nan nan nan nan", 1),
        (b"PRIMARIES=.3 .3 .3 .3 .3 .3 .3 .3", 1),
        (b"GAMMA=2.2", 1),
        (b"PIXASPECT=2", 1),
        (b"ROTATE=90", 1),
        (b"EXPOSURE=\x1b[31m", 1),
    ],
)
def test_a_line_that_is_not_used_is_told_of(tmp_path: Path, line: bytes, factor: float) -> None:
    path = tmp_path / "a.hdr"
    path.write_bytes(HEADER + line + b"\n\n-Y 1 +X 1\n" + PIXEL.tobytes())
    with pytest.warns(RsibrWarning, match=r"a\.hdr has the header line") as caught:
        picture = read_hdr(path)
    np.testing.assert_array_equal(picture, np.float32(values(PIXEL) / factor))
    (warning,) = caught
    assert repr(line.decode()) in str(warning.message)
    assert str(warning.message).isprintable()


@pytest.mark.parametrize(
    "start", [b"#?RGBE\n", b"#?AUTOPANO\r\n\r\n", b"#?RADIANCE\n", b"#?\nNo statement\n\n"]
)
def test_beginnings_differ(tmp_path: Path, start: bytes) -> None:
    path = tmp_path / "a.hdr"
    path.write_bytes(start + b"-Y 1 +X 1\n" + PIXEL.tobytes())
    np.testing.assert_array_equal(read_hdr(path), values(PIXEL))


def test_flat_pixels_may_look_like_the_start_of_runs(tmp_path: Path) -> None:
    picture = np.random.default_rng(2).integers(2, 256, (3, 20, 4), dtype=np.uint8)
    picture[:, 0] = 2, 2, 3, 130
    whole = HEADER + b"\n-Y 3 +X 20\n" + picture.tobytes()
    path = tmp_path / "a.hdr"
    path.write_bytes(whole)
    np.testing.assert_array_equal(read_hdr(path), values(picture)[::-1])
    path.write_bytes(whole + b"\0")
    with pytest.raises(InputFileError, match="in a scanline that states another length"):
        read_hdr(path)


@pytest.mark.parametrize(
    ("size", "data"),
    [
        (b"-Y 1 +X 134217728", b"\x80\1\1\x80" + b"\1\1\1\xff" * 3 + b"\1\1\1\7"),
        (b"-Y 99999999 +X 8", b"\x80\1\1\x80\1\1\1\7"),
        (b"-Y 60000 +X 60000", b"\2\2" * 99),
    ],
)
def test_a_size_beyond_the_files_length_is_refused_before_it_is_decoded(
    tmp_path: Path, size: bytes, data: bytes
) -> None:
    path = tmp_path / "a.hdr"
    path.write_bytes(HEADER + b"\n" + size + b"\n" + data)
    for read in (read_hdr, read_hdr_header):
        with pytest.raises(InputFileError, match=f"{len(data)} bytes cannot hold"):
            read(path)


@pytest.mark.parametrize(
    ("lines", "matrix"),
    [
        (b"FORMAT=32-bit_rle_xyze\n", rec709_from(XYZ)),
        (
            b"PRIMARIES= .708 .292 .170 .797 .131 .046 .3127 .3290\n",
            rec709_from((0.708, 0.292, 0.170, 0.797, 0.131, 0.046, 0.3127, 0.3290)),
        ),
    ],
)
def test_other_primaries_become_rec_709(tmp_path: Path, lines: bytes, matrix: np.ndarray) -> None:
    path = tmp_path / "a.hdr"
    path.write_bytes(b"#?RADIANCE\n" + lines + b"\n-Y 1 +X 1\n" + PIXEL.tobytes())
    # float32 arithmetic: three products of size up to 4 * 128
    np.testing.assert_allclose(read_hdr(path), values(PIXEL) @ matrix.T, rtol=0, atol=1e-4)


def test_the_header_tells_what_it_states(tmp_path: Path) -> None:
    path = tmp_path / "a.hdr"
    path.write_bytes(b"#?RADIANCE\nFORMAT=32-bit_rle_xyze\nEXPOSURE=2\n\n+X 3 -Y 5\n" + bytes(60))
    header = read_hdr_header(path)
    assert header.size == (3, 5)
    assert header.colours == "CIE XYZ, as FORMAT says"
    np.testing.assert_array_equal(header.scale, 2.0)


@pytest.mark.parametrize(
    ("content", "sentence"),
    [
        (b"no picture", "not a Radiance picture"),
        (b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n", "states no size"),
        (b"#?RADIANCE\nFORMAT=16-bit\n\n-Y 1 +X 1\n1234", "its format is '16-bit'"),
        (b"#?RADIANCE\n\n-Y 1 +Y 1\n1234", "states no size"),
        (b"#?RADIANCE\n\n-Y 0 +X 1\n1234", "states no size"),
        (b"#?RADIANCE\n\n-Y 1 +X 1", "states no size"),
        (b"#?RADIANCE\n\n-Y 2 +X 1\n1234", "4 bytes cannot hold the 1x2 pixels"),
        (b"#?RADIANCE\n\n-Y 2 +X 3\n" + bytes(20), "scanline 2 of 2"),
        (b"#?RADIANCE\n\n-Y 1 +X 9\n\2\2\0\7" + b"\x8f\1" * 9, "scanline 1 of 1"),  # says 7 pixels, not 9
        (b"#?RADIANCE\n\n-Y 1 +X 9\n\2\2\0\x09" + b"\xff\1" * 9, "scanline 1 of 1"),  # a run beyond the end
        (b"#?RADIANCE\n\n-Y 1 +X 4\n\1\1\1\4\1\1\1\4", "scanline 1 of 1"),  # a run of nothing
        (b"#?RADIANCE\n\n-Y 1 +X 4\n\x80\1\1\x80\1\1\1\7", "scanline 1 of 1"),  # a run beyond the end
        (b"#?RADIANCE\n\n-Y 1 +X 9\n\x80\1\1\x80" + b"\1\1\1\xff" * 5, "scanline 1 of 1"),
    ],
)
def test_damaged_files_are_refused_in_words(tmp_path: Path, content: bytes, sentence: str) -> None:
    path = tmp_path / "a.hdr"
    path.write_bytes(content)
    with pytest.raises(InputFileError, match=sentence) as caught:
        read_hdr(path)
    assert str(path) in str(caught.value)


@pytest.mark.parametrize("code", [flat, older_runs, newer_runs])
def test_a_truncated_file_is_refused_wherever_it_ends(tmp_path: Path, rgbe: np.ndarray, code) -> None:
    path = tmp_path / "a.hdr"
    whole = HEADER + b"\n-Y 6 +X 700\n" + b"".join(map(code, rgbe))
    for length in {*range(0, len(whole), 97), len(whole) - 1}:
        path.write_bytes(whole[:length])
        with pytest.raises(InputFileError):
            read_hdr(path)


def test_what_does_not_fit_into_memory_is_not_read(tmp_path: Path) -> None:
    path = tmp_path / "holes.hdr"
    path.write_bytes(b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n")
    os.truncate(path, 1 << 43)
    with pytest.raises(MemoryShortageError, match=r"holes\.hdr takes 8796\.1 GB of memory at any size"):
        read_hdr(path)
