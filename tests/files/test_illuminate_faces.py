"""`rsibr illuminate faces` on pictures of radiance, without Blender."""

import json
from pathlib import Path

import numpy as np
import pytest
from rsibr.rsibr_addon.command_line.main import run
from rsibr.rsibr_addon.core.maps.representation import representation
from rsibr.rsibr_addon.core.resample import resample
from rsibr.rsibr_addon.files.map_pictures import layout, write_map
from rsibr.rsibr_addon.files.radiance_pictures import read_radiance, write_radiance

FACES = layout("cube_faces")


def illuminate(*arguments: object) -> int:
    return run(["illuminate", "faces", *map(str, arguments), "--exposure", "0"])


def write_faces(path: Path, size: int = 32) -> np.ndarray:
    """Faces of radiance 2 + direction."""
    cube = 2.0 + FACES.representation.texel_directions(size)
    write_map(path, FACES, cube)
    return cube


def test_six_photographs_make_an_environment(tmp_path: Path) -> None:
    write_faces(tmp_path / "a.exr")
    assert illuminate(tmp_path / "a.exr", "-o", tmp_path / "room.exr", "--size", 64) == 0
    expected = 2.0 + representation("equirect").texel_directions(64)[0]
    # The mean of texels that are 2/32 wide, of which the narrow ones at the poles see one
    np.testing.assert_allclose(read_radiance(tmp_path / "room.exr"), expected, atol=1 / 32)


def test_faces_are_clamped(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    brighter = np.count_nonzero(write_faces(tmp_path / "a.exr")[0] > 2.0)
    assert illuminate(tmp_path / "a.exr", "-o", tmp_path / "room.exr", "--size", 64, "--clamp", 2) == 0
    assert f"a-px.exr holds {brighter} values above 2; they are taken as 2." in capfd.readouterr().err
    assert read_radiance(tmp_path / "room.exr").max() <= 2.0


def test_balanced_photographs_agree(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    cube = write_faces(tmp_path / "a.exr")
    applied = np.array([1.0, 3.0, 0.5, 1.5, 1.0, 0.7])
    write_map(tmp_path / "a.exr", FACES, cube * applied[:, None, None, None], force=True)
    arguments = [tmp_path / "a.exr", "-o", tmp_path / "room.exr", "--size", 64, "--balance", "--json"]
    assert illuminate(*arguments) == 0
    gains = np.array(json.loads(capfd.readouterr().out)["gains"])
    # As in the core's test: half a texel's step, at 32 texels
    np.testing.assert_allclose(gains * applied[:, None] / (gains[0] * applied[0]), 1.0, rtol=0.04)
    mean_gain = np.prod(applied) ** (1 / 6)
    expected = mean_gain * resample(cube, FACES.representation, representation("equirect"), 64)[0]
    np.testing.assert_allclose(read_radiance(tmp_path / "room.exr"), expected, rtol=0.04)


def test_bad_input_is_told_and_nothing_written(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    write_faces(tmp_path / "a.exr", 8)
    out = tmp_path / "room.exr"

    def told(*arguments: object) -> str:
        assert illuminate(tmp_path / "a.exr", "-o", out, *arguments) == 1
        assert not out.exists()
        return capfd.readouterr().err

    assert "cannot be 33 texels wide: choose a multiple of 2" in told("--size", 33)
    write_radiance(tmp_path / "a-nz.exr", np.ones((4, 4, 3)), force=True)
    assert "a-nz.exr is 4x4, but a-px.exr is 8x8: the pictures of a map must be of one size" in told()
    (tmp_path / "a-nz.exr").unlink()
    assert "a.exr as cube_faces is 6 files, of which a-nz.exr is missing" in told()
    write_radiance(tmp_path / "a-nz.exr", np.zeros((8, 8, 3)))
    assert "a.exr as six photographs: The faces cannot be balanced" in told("--balance")


def test_a_kind_must_be_named() -> None:
    assert run(["illuminate"]) == 2
    assert run(["illuminate", "guesses"]) == 2
