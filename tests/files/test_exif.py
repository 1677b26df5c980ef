"""What cameras note in their photographs."""

import struct
from pathlib import Path

import pytest
from rsibr.rsibr_addon.core.errors import InputFileError
from rsibr.rsibr_addon.files.exif import Exposure, read_exposure, relative_exposures
from rsibr.rsibr_addon.files.exposure_times import exposure_time, read_times


def tiff(order: str, time: tuple[int, int], f_number: tuple[int, int], iso: int) -> bytes:
    """A TIFF structure with a folder of Exif, as the standard lays it out."""
    magic = b"II*\0" if order == "<" else b"MM\0*"
    first, exif, values = 8, 26, 68
    return b"".join(
        [
            magic + struct.pack(order + "I", first),
            struct.pack(order + "HHHIII", 1, 0x8769, 4, 1, exif, 0),
            struct.pack(order + "H", 3),
            struct.pack(order + "HHII", 0x829A, 5, 1, values),
            struct.pack(order + "HHII", 0x829D, 5, 1, values + 8),
            struct.pack(order + "HHIHH", 0x8827, 3, 1, iso, 0),
            struct.pack(order + "I", 0),
            struct.pack(order + "IIII", *time, *f_number),
        ]
    )


def jpeg(content: bytes) -> bytes:
    """A JPEG's head with an Exif segment after another one."""
    exif = b"Exif\0\0" + content
    return b"".join(
        [
            b"\xff\xd8\xff\xe0" + struct.pack(">H", 6) + b"JFIF",
            b"\xff\xe1" + struct.pack(">H", len(exif) + 2) + exif,
            b"\xff\xda\0\0",
        ]
    )


@pytest.mark.parametrize("order", ["<", ">"])
@pytest.mark.parametrize("wrap", [bytes, jpeg])
def test_an_exposure_is_read(tmp_path: Path, order: str, wrap: type) -> None:
    (tmp_path / "a.jpg").write_bytes(wrap(tiff(order, (1, 40), (18, 10), 100)))
    assert read_exposure(tmp_path / "a.jpg") == Exposure(1 / 40, 1.8, 100.0)


@pytest.mark.parametrize(
    "content",
    [
        b"",
        b"\xff\xd8",
        b"\x89PNG\r\n\x1a\n",
        jpeg(b"II*\0"),
        jpeg(tiff("<", (0, 1), (0, 0), 0)),
        jpeg(tiff(">", (1, 0), (1, 1), 1)),
        tiff("<", (1, 40), (18, 10), 100)[:70],
        b"II*\0\xff\xff\xff\xff",
    ],
)
def test_a_file_that_tells_no_time(tmp_path: Path, content: bytes) -> None:
    (tmp_path / "a.jpg").write_bytes(content)
    with pytest.raises(InputFileError, match=r"a\.jpg does not tell its exposure time: give the times"):
        read_exposure(tmp_path / "a.jpg")


def test_aperture_and_sensitivity_count() -> None:
    exposures = [Exposure(0.1, 4.0, 100.0), Exposure(0.1, 2.0, 100.0), Exposure(0.2, 4.0, 50.0)]
    assert relative_exposures(exposures) == pytest.approx([0.1, 0.4, 0.1])
    assert relative_exposures([Exposure(0.1, None, 100.0), Exposure(0.2, 8.0, None)]) == [0.1, 0.2]


def test_times_as_people_write_them(tmp_path: Path) -> None:
    assert [exposure_time(text) for text in ("1/4", "0.5", "8")] == [0.25, 0.5, 8.0]
    for text in ("", "a", "0", "1/0", "-1", "1/-2", "nan", "inf", "1/2/3"):
        with pytest.raises(ValueError, match=r"could not convert|is no exposure time"):
            exposure_time(text)
    (tmp_path / "t.txt").write_text("1/4\n 2 ")
    assert read_times(tmp_path / "t.txt") == (0.25, 2.0)
    (tmp_path / "t.txt").write_text("1/4 long")
    with pytest.raises(InputFileError, match=r"t\.txt is no list of exposure times .* write 1/125 or 0\.5"):
        read_times(tmp_path / "t.txt")
