"""`rsibr illuminate brackets` on linear photographs, without Blender."""

import json
from pathlib import Path

import numpy as np
import pytest
from rsibr.rsibr_addon.command_line.main import run
from rsibr.rsibr_addon.files.radiance_pictures import read_radiance, write_radiance

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
    assert "There are 3 photographs, but 2 exposure times" in told(*paths, "--times", "1,2")
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
    assert "The photographs are nothing but black and white" in capfd.readouterr().err


def test_wrong_times_are_wrong_usage(tmp_path: Path) -> None:
    paths = write_brackets(tmp_path)
    for times in ("1,2,0", "a", "1,,2"):
        assert illuminate(*paths, "--times", times, "-o", tmp_path / "out.exr") == 2
