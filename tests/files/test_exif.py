"""What cameras note in their photographs."""

from pathlib import Path

import numpy as np
import pytest
from rsibr.rsibr_addon.core.errors import InputFileError, RsibrWarning
from rsibr.rsibr_addon.files.exif import Exposure, read_exposure, relative_exposures
from rsibr.rsibr_addon.files.exposure_times import exposure_time, read_times
from rsibr.tests.written_pictures import (
    APERTURE,
    BIAS,
    BRIGHTNESS,
    EXPOSURE_TIME,
    F_NUMBER,
    ISO,
    ISO_SPEED,
    RECOMMENDED_INDEX,
    SHUTTER,
    STANDARD_OUTPUT,
    add_exif,
    write_picture,
)

GREY = np.full((8, 8, 3), 118, np.uint8)
PATHS = [Path("a.jpg"), Path("b.jpg"), Path("c.jpg")]


def exposure(path: Path, fields: dict[int, int | tuple[int, int]], order: str = "<") -> Exposure:
    write_picture(path, GREY)
    add_exif(path, fields, order)
    return read_exposure(path)


@pytest.mark.parametrize("order", ["<", ">"])
@pytest.mark.parametrize("ending", ["jpg", "png", "webp"])
def test_an_exposure_is_read(tmp_path: Path, ending: str, order: str) -> None:
    fields = {EXPOSURE_TIME: (1, 40), F_NUMBER: (18, 10), ISO: 100}
    found = exposure(tmp_path / f"a.{ending}", fields, order)
    assert (found.time, found.f_number) == pytest.approx((1 / 40, 1.8), rel=1e-6)
    assert found.sensitivity == 100.0
    # These are in the others already
    found = exposure(
        tmp_path / f"a.{ending}", {EXPOSURE_TIME: (1, 4), BIAS: (1, 3), BRIGHTNESS: (7, 1)}, order
    )
    assert found == Exposure(0.25, None, None)


def test_exposures_of_linear_pictures_are_read(tmp_path: Path) -> None:
    for name in ("a.tif", "a.exr"):
        write_picture(tmp_path / name, np.ones((4, 4, 3), np.float32), ExposureTime=0.25, FNumber=8.0)
        assert read_exposure(tmp_path / name) == Exposure(0.25, 8.0, None)


def test_apex_values_are_read(tmp_path: Path) -> None:
    apex = {SHUTTER: (5, 1), APERTURE: (4, 1)}
    assert exposure(tmp_path / "a.jpg", apex) == Exposure(1 / 32, 4.0, None)
    # A second is 0 in APEX, and times above it are negative
    assert exposure(tmp_path / "a.jpg", {SHUTTER: (0, 1)}).time == 1.0
    assert exposure(tmp_path / "a.jpg", {SHUTTER: (-3, 1)}).time == 8.0
    # The plain ones are exact
    assert exposure(tmp_path / "a.jpg", {EXPOSURE_TIME: (1, 30), **apex}).time == pytest.approx(
        1 / 30, rel=1e-6
    )


@pytest.mark.parametrize("tag", [RECOMMENDED_INDEX, STANDARD_OUTPUT, ISO_SPEED])
def test_a_sensitivity_beyond_16_bits_is_another_fields(tmp_path: Path, tag: int) -> None:
    fields = {EXPOSURE_TIME: (1, 4), ISO: 65535}
    assert exposure(tmp_path / "a.jpg", fields | {tag: 102400}).sensitivity == 102400.0
    assert exposure(tmp_path / "a.jpg", fields).sensitivity is None


@pytest.mark.parametrize("nothing", [(0, 1), (0, 0), (1, 0), (4294967295, 1)])
def test_numbers_that_say_nothing(tmp_path: Path, nothing: tuple[int, int]) -> None:
    fields = {EXPOSURE_TIME: nothing, F_NUMBER: nothing, ISO: 0}
    apex = {SHUTTER: (2, 1), APERTURE: (2, 1)}
    assert exposure(tmp_path / "a.jpg", fields | apex) == Exposure(0.25, 2.0, None)
    with pytest.raises(InputFileError, match=r"a\.jpg does not tell its exposure time: give the times"):
        exposure(tmp_path / "a.jpg", fields)


def test_aperture_and_sensitivity_count() -> None:
    exposures = [Exposure(0.1, 4.0, 100.0), Exposure(0.1, 2.0, 100.0), Exposure(0.2, 4.0, 50.0)]
    assert relative_exposures(PATHS, exposures) == pytest.approx([0.1, 0.4, 0.1])
    untold = [Exposure(0.1, None, None), Exposure(0.2, None, None), Exposure(0.4, None, None)]
    assert relative_exposures(PATHS, untold) == [0.1, 0.2, 0.4]


@pytest.mark.parametrize("lacking", [0, 1, 2])
def test_what_some_photographs_lack(lacking: int) -> None:
    exposures = [Exposure(0.1, 8.0, 100.0), Exposure(0.2, 8.0, 100.0), Exposure(0.4, 8.0, 100.0)]
    exposures[lacking] = Exposure(exposures[lacking].time, None, 100.0)
    with pytest.warns(RsibrWarning, match=f"{PATHS[lacking]} tells no f-number: .* 8, is taken"):
        assert relative_exposures(PATHS, exposures) == pytest.approx([0.1, 0.2, 0.4])
    exposures[lacking - 1] = Exposure(0.1, 4.0, 100.0)
    sentence = f"The f-number varies from 4 to 8, but {PATHS[lacking]} tells none: give the exposure times"
    with pytest.raises(InputFileError, match=sentence):
        relative_exposures(PATHS, exposures)


def test_times_as_people_write_them(tmp_path: Path) -> None:
    assert [exposure_time(text) for text in ("1/4", "0.5", "8")] == [0.25, 0.5, 8.0]
    for text in ("", "a", "0", "1/0", "-1", "1/-2", "nan", "inf", "1/2/3"):
        with pytest.raises(ValueError, match=r"could not convert|is no exposure time"):
            exposure_time(text)
    with pytest.raises(InputFileError, match=r"t\.txt is no list of exposure times .* write 1/125 or 0\.5"):
        table(tmp_path, b"1/4 long")


def table(folder: Path, content: bytes) -> tuple[float, ...]:
    (folder / "t.txt").write_bytes(content)
    return read_times(folder / "t.txt")


@pytest.mark.parametrize(
    "content",
    [
        b"1/4\n 2 ",
        b"1/4,2",
        b"1/4, 2,\r\n",
        b"1/4\t2",
        b"1/4;2",
        b'"1/4"\r\n"2"\r\n',
        b"# seconds\n1/4 # a window\n\n2",
        b"// seconds\n1/4\n2",
        b"1 / 4\n2",
        b"1/4 s\n2s",
        b"1/4\r2",
        "\ufeff1/4\n2".encode(),
        "1/4\r\n2".encode("utf-16"),
    ],
)
def test_tables_as_programs_write_them(tmp_path: Path, content: bytes) -> None:
    assert table(tmp_path, content) == (0.25, 2.0)
