"""`rsibr illuminate brackets` on linear photographs, without Blender."""

import json
from pathlib import Path

import numpy as np
import pytest
from rsibr.rsibr_addon.command_line.main import run
from rsibr.rsibr_addon.core.light.transfer_curve import srgb_from_linear
from rsibr.rsibr_addon.files.chromaticities import rec709_from
from rsibr.rsibr_addon.files.encoding import PRIMARIES
from rsibr.rsibr_addon.files.radiance_pictures import read_radiance, write_radiance
from rsibr.tests.written_pictures import P3, SRGB, profile, write_picture

RADIANCE = np.geomspace(0.02, 8.0, 600).reshape(20, 30)[..., None] * np.array([1.0, 0.5, 0.8])


def illuminate(*arguments: object) -> int:
    return run(["illuminate", "brackets", *map(str, arguments)])


def write_brackets(folder: Path, times: tuple[float, ...] = (2.0, 0.1, 0.5)) -> list[Path]:
    paths = [folder / f"{i}.exr" for i in range(len(times))]
    for path, time in zip(paths, times, strict=True):
        write_radiance(path, np.minimum(RADIANCE * time, 1.0), force=True)
    return paths


def test_linear_photographs_are_merged_in_any_order(
    tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    paths = write_brackets(tmp_path)
    out = tmp_path / "out.exr"
    assert illuminate(*paths, "--times", "2,1/10,0.5", "-o", out, "--json", "--no-align") == 0
    np.testing.assert_allclose(read_radiance(out), RADIANCE, rtol=1e-6)  # float32
    result = json.loads(capfd.readouterr().out)
    assert (result["saturated"], result["black"], result["moved"]) == (0.0, 0.0, 0.0)
    (tmp_path / "t.txt").write_text("2 1/10 0.5")
    assert illuminate(*paths, "--times-file", tmp_path / "t.txt", "-o", out, "--force", "--no-align") == 0
    np.testing.assert_allclose(read_radiance(out), RADIANCE, rtol=1e-6)


def test_what_is_white_everywhere_is_told(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    paths = write_brackets(tmp_path, (1.0, 0.5))
    assert illuminate(*paths, "--times", "1,0.5", "-o", tmp_path / "out.exr", "--no-align") == 0
    told = capfd.readouterr().err
    assert "% of the picture are white in every photograph: take a shorter exposure as well" in told


def test_bad_brackets_are_told_and_nothing_is_written(
    tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    paths = write_brackets(tmp_path)
    out = tmp_path / "out.exr"

    def told(*arguments: object) -> str:
        assert illuminate(*arguments, "-o", out) == 1
        assert not out.exists()
        return capfd.readouterr().err

    assert "0.exr does not tell its exposure time: give the times of all photographs" in told(*paths)
    assert "3 photographs have 2 exposure times" in told(*paths, "--times", "1,2")
    assert "One photograph is no bracket: give two or more" in told(paths[0], "--times", "1")
    assert "All photographs have the same exposure" in told(*paths, "--times", "1,1,1")
    assert "missing.exr does not exist" in told(paths[0], tmp_path / "missing.exr", "--times", "1,2")
    write_radiance(paths[1], np.ones((4, 6, 3)), force=True)
    different = told(*paths, "--times", "2,0.1,0.5")
    assert "2.exr is 30x20, but 1.exr is 6x4: the photographs of a bracket must be of one size" in different


@pytest.mark.parametrize("value", [0.0, 1.0])
def test_all_white_or_all_black_is_told(
    tmp_path: Path, capfd: pytest.CaptureFixture[str], value: float
) -> None:
    for name in "ab":
        write_radiance(tmp_path / f"{name}.exr", np.full((20, 30, 3), value))
    arguments = [tmp_path / "a.exr", tmp_path / "b.exr", "--times", "1,2", "-o", tmp_path / "out.exr"]
    assert illuminate(*arguments) == 1
    assert "All pixels of the photographs are black or white" in capfd.readouterr().err


def test_wrong_times_are_wrong_usage(tmp_path: Path) -> None:
    paths = write_brackets(tmp_path)
    for times, status in (("1,2,0", 1), ("1,2,1/0", 1), ("a", 2), ("1,,2", 2)):
        assert illuminate(*paths, "--times", times, "-o", tmp_path / "out.exr") == status


def write_photographs(folder: Path, times: tuple[float, ...], **notes: object) -> list[Path]:
    """Photographs as a camera with sRGB's curve takes them, of 16 bits."""
    paths = [folder / f"{i}.tif" for i in range(len(times))]
    for path, time in zip(paths, times, strict=True):
        encoded = srgb_from_linear(np.minimum(RADIANCE * time, 1.0))
        write_picture(path, np.round(65535 * encoded).astype(np.uint16), ExposureTime=time, **notes)
    return paths


def test_exposures_come_from_the_photographs(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    paths = write_photographs(tmp_path, (2.0, 0.1, 0.5), FNumber=8.0)
    out = tmp_path / "out.exr"
    arguments = ["--curve", "srgb", "--no-align", "-o", out, "--force"]
    assert illuminate(*paths, *arguments) == 0
    # The curve is linear between 256 levels, of which darkness has few
    np.testing.assert_allclose(read_radiance(out)[4:], RADIANCE[4:], rtol=0.01)
    assert capfd.readouterr().err == ""
    # Twice as much light through the lens, as if it were a second longer
    write_photographs(tmp_path, (2.0,), FNumber=8.0 / 2.0**0.5)
    assert illuminate(*paths, *arguments) == 0
    assert not np.allclose(read_radiance(out)[4:], RADIANCE[4:], rtol=0.1)
    write_photographs(tmp_path, (2.0,))
    assert illuminate(*paths, *arguments) == 0
    assert "0.tif tells no f-number: that of the other photographs, 8, is taken" in capfd.readouterr().err


def test_primaries_are_converted_after_merging(tmp_path: Path) -> None:
    out = tmp_path / "out.exr"
    paths = write_photographs(tmp_path, (2.0, 0.125, 0.5), ICCProfile=profile(P3, SRGB))
    assert illuminate(*paths, "--curve", "srgb", "--no-align", "-o", out) == 0
    expected = RADIANCE @ rec709_from(PRIMARIES["p3d65"]).T
    np.testing.assert_allclose(read_radiance(out)[4:], expected[4:], rtol=0.02)


def test_photographs_of_several_kinds_are_refused(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    paths = write_photographs(tmp_path, (2.0, 0.5))
    arguments = ["--times", "2,0.5", "-o", tmp_path / "out.exr"]
    write_picture(paths[1], RADIANCE.astype(np.float32))
    assert illuminate(*paths, *arguments) == 1
    assert "0.tif is encoded, but 1.tif is linear: give photographs of one kind" in capfd.readouterr().err
    write_picture(paths[1], np.full((20, 30, 3), 99, np.uint8), ICCProfile=profile(P3, SRGB))
    assert illuminate(*paths, *arguments) == 1
    assert "0.tif is of another colour space than 1.tif" in capfd.readouterr().err
