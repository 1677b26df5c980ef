"""Pictures of 8 and 16 bits, and their way through `rsibr convert`."""

import struct
import zlib
from pathlib import Path

import numpy as np
import pytest
from rsibr.rsibr_addon.command_line.main import run
from rsibr.rsibr_addon.core.errors import InputFileError, RsibrWarning
from rsibr.rsibr_addon.core.light.transfer_curve import linear_from_srgb
from rsibr.rsibr_addon.files.orientation import ORIENTATIONS
from rsibr.rsibr_addon.files.photographs import read_photograph
from rsibr.rsibr_addon.files.radiance_pictures import read_radiance
from rsibr.tests.written_pictures import COLOUR_SPACE, ORIENTATION, add_exif, write_picture, write_png

RNG = np.random.default_rng(0)
GREY = np.full((8, 8, 3), 118, np.uint8)


@pytest.mark.parametrize("channels", [1, 2, 3, 4])
@pytest.mark.parametrize("kind", [np.uint8, np.uint16])
def test_the_curve_is_undone(tmp_path: Path, kind: type, channels: int) -> None:
    most = np.iinfo(kind).max
    pixels = RNG.integers(0, most, (4, 6, channels), dtype=kind, endpoint=True)
    if channels in (2, 4):
        pixels[..., -1] = most
    write_png(tmp_path / "a.png", pixels)
    colour = pixels[..., :1] if channels < 3 else pixels[..., :3]
    expected = np.broadcast_to(linear_from_srgb(colour / most), (4, 6, 3))
    photograph = read_photograph(tmp_path / "a.png")
    assert photograph.stored.dtype == kind
    np.testing.assert_allclose(photograph.radiance(), expected, rtol=1e-6)  # float32
    np.testing.assert_allclose(photograph.encoded(), np.broadcast_to(colour / most, (4, 6, 3)), rtol=1e-6)


@pytest.mark.parametrize("ending", ["png", "tif", "webp", "bmp", "tga", "gif", "jpg"])
def test_every_kind_of_file_lies_the_right_way_up(tmp_path: Path, ending: str) -> None:
    pixels = np.zeros((8, 16, 3), np.uint8)
    pixels[4:, :8], pixels[4:, 8:], pixels[:4, :8] = 60, 120, 255
    write_picture(tmp_path / f"a.{ending}", pixels)
    read = read_photograph(tmp_path / f"a.{ending}").stored
    # JPEG and GIF's palettes round
    np.testing.assert_allclose(read, pixels, atol=4)


@pytest.mark.parametrize("kind", [np.float32, np.float16])
def test_floats_are_linear_already(tmp_path: Path, kind: type) -> None:
    pixels = RNG.uniform(0.0, 7.0, (4, 6, 3)).astype(kind)
    write_picture(tmp_path / "a.tif", pixels)
    np.testing.assert_array_equal(read_photograph(tmp_path / "a.tif").radiance(), pixels.astype(np.float32))


@pytest.mark.parametrize("ending", ["png", "jpg", "webp", "tif"])
def test_photographs_stand_upright(tmp_path: Path, ending: str) -> None:
    # What Exif says of each: where the first row and the first column of what is stored are seen
    seen = {
        1: ("top", "left"),
        2: ("top", "right"),
        3: ("bottom", "right"),
        4: ("bottom", "left"),
        5: ("left", "top"),
        6: ("right", "top"),
        7: ("right", "bottom"),
        8: ("left", "bottom"),
    }
    stored = np.zeros((8, 16, 3), np.uint8)
    stored[-1], stored[:-1, 0] = 250, 120
    inner = np.s_[1:-1]
    where = {"top": (-1, inner), "bottom": (0, inner), "left": (inner, 0), "right": (inner, -1)}
    for number, (row, column) in seen.items():
        path = tmp_path / f"a.{ending}"
        if ending == "tif":
            write_picture(path, stored, Orientation=number)
        else:
            write_picture(path, stored)
            add_exif(path, {ORIENTATION: number})
        upright = read_photograph(path).stored
        assert upright.shape == ((16, 8, 3) if number > 4 else (8, 16, 3))
        assert np.median(upright[where[row]]) > 200, number
        assert 80 < np.median(upright[where[column]]) < 200, number


def test_points_turn_with_their_photograph() -> None:
    stored = np.arange(15).reshape(3, 5)
    for orientation in ORIENTATIONS.values():
        upright = orientation.upright(stored)
        height, width = upright.shape
        for row in range(3):
            for column in range(5):
                x, y = orientation.upright_point(column + 0.5, row + 0.5, width, height)
                assert upright[int(y), int(x)] == stored[row, column]
                assert orientation.stored_point(x, y, width, height) == (column + 0.5, row + 0.5)


@pytest.mark.parametrize("number", [0, 9, 65535])
def test_an_orientation_that_means_nothing_is_none(tmp_path: Path, number: int) -> None:
    write_picture(tmp_path / "a.jpg", GREY)
    add_exif(tmp_path / "a.jpg", {ORIENTATION: number})
    assert read_photograph(tmp_path / "a.jpg").stored.shape == (8, 8, 3)


@pytest.mark.parametrize("content", [b"", b"just text", b"\x89PNG\r\n\x1a\n", b"\xff\xd8\xff\xe0"])
def test_what_is_no_picture_is_refused(
    tmp_path: Path, content: bytes, capfd: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "a.jpg").write_bytes(content)
    with pytest.raises(InputFileError, match=r"a\.jpg cannot be read as a picture \(.*\): check the file"):
        read_photograph(tmp_path / "a.jpg")
    assert capfd.readouterr() == ("", "")


def test_a_file_of_no_known_kind_is_told_in_one_sentence(tmp_path: Path) -> None:
    (tmp_path / "a.txt").write_text("just text")
    told = (
        r"a\.txt cannot be read as a picture \(it is of no known kind\): check the file, or save it as PNG\.$"
    )
    with pytest.raises(InputFileError, match=told):
        read_photograph(tmp_path / "a.txt")


@pytest.mark.parametrize("ending", ["jpg", "png", "webp", "tif", "gif", "bmp"])
@pytest.mark.parametrize("share", [0.2, 0.6, 0.95])
def test_what_is_cut_off_is_refused(
    tmp_path: Path, ending: str, share: float, capfd: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / f"a.{ending}"
    write_picture(path, RNG.integers(0, 255, (64, 64, 3), dtype=np.uint8))
    path.write_bytes(path.read_bytes()[: int(share * path.stat().st_size)])
    with pytest.raises(InputFileError, match=r"a\.\w+ (is truncated or damaged|cannot be read)"):
        read_photograph(path)
    assert capfd.readouterr() == ("", "")


def test_bytes_that_fill_a_jpeg_are_harmless(tmp_path: Path) -> None:
    write_picture(tmp_path / "a.jpg", GREY, Orientation=6)
    jpeg = (tmp_path / "a.jpg").read_bytes()
    expected = read_photograph(tmp_path / "a.jpg").stored
    for filled in (jpeg[:2] + b"\xff\xff\xff" + jpeg[2:], jpeg + b"\0" * 100):
        (tmp_path / "b.jpg").write_bytes(filled)
        np.testing.assert_array_equal(read_photograph(tmp_path / "b.jpg").stored, expected)


def test_a_few_bytes_that_claim_a_huge_picture_are_refused(tmp_path: Path) -> None:
    write_picture(tmp_path / "a.png", GREY)
    png = bytearray((tmp_path / "a.png").read_bytes())
    png[16:24] = struct.pack(">II", 40000, 20000)
    png[29:33] = struct.pack(">I", zlib.crc32(png[12:29]))
    (tmp_path / "a.png").write_bytes(png)
    with pytest.raises(InputFileError, match=r"a\.png cannot be read"):
        read_photograph(tmp_path / "a.png")


@pytest.mark.parametrize("name", ["a.nef", "b.DNG"])
def test_raw_files_are_refused(tmp_path: Path, name: str) -> None:
    (tmp_path / name).write_bytes(b"II*\0")
    with pytest.raises(InputFileError, match=r"is a camera's raw file: develop it"):
        read_photograph(tmp_path / name)


def test_names_may_be_odd(tmp_path: Path) -> None:
    for name in ("ü?x=1.png", "a b%04d#.png", "no ending"):
        write_picture(tmp_path / "a.png", GREY)
        (tmp_path / "a.png").rename(tmp_path / name)
        np.testing.assert_array_equal(read_photograph(tmp_path / name).stored, GREY)


def test_what_is_not_used_is_told(tmp_path: Path) -> None:
    seen_through = np.dstack([GREY, np.full((8, 8), 100, np.uint8)])
    write_picture(tmp_path / "a.png", seen_through)
    with pytest.warns(RsibrWarning, match=r"a\.png is transparent in places, which is left out"):
        read = read_photograph(tmp_path / "a.png")
    np.testing.assert_array_equal(read.stored, GREY)
    write_picture(tmp_path / "a.jpg", GREY)
    jpeg = (tmp_path / "a.jpg").read_bytes()
    for segment, told in ((b"MPF\0II*\0", "further pictures"), (b'hdrgm:Version="1.0"', "a gain map")):
        app = b"\xff\xe2" + struct.pack(">H", len(segment) + 2) + segment
        (tmp_path / "b.jpg").write_bytes(jpeg[:2] + app + jpeg[2:])
        with pytest.warns(RsibrWarning, match=f"holds {told}.* its plain picture alone is used"):
            read_photograph(tmp_path / "b.jpg")
    write_picture(tmp_path / "c.jpg", GREY)
    add_exif(tmp_path / "c.jpg", {COLOUR_SPACE: 65535})
    with pytest.warns(RsibrWarning, match="says that its colours are not those of sRGB, but not which"):
        read_photograph(tmp_path / "c.jpg")


def test_pictures_for_hdr_displays_are_refused(tmp_path: Path) -> None:
    write_png(tmp_path / "a.png", GREY, (b"cICP", bytes((9, 16, 0, 1))))
    with pytest.raises(InputFileError, match=r"a\.png is encoded for HDR displays .*: save it as OpenEXR"):
        read_photograph(tmp_path / "a.png")


def test_a_photograph_is_converted(tmp_path: Path) -> None:
    write_picture(tmp_path / "ball.png", GREY)
    arguments = ["--from", "mirror_ball", "--to", "equirect", "--size", "8", "--distance", "20"]
    assert run(["convert", str(tmp_path / "ball.png"), str(tmp_path / "room.hdr"), *arguments]) == 0
    # The file keeps 1/256
    expected = linear_from_srgb(118 / 255)
    np.testing.assert_allclose(read_radiance(tmp_path / "room.hdr"), expected, rtol=1 / 256)
