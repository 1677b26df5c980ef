"""Environments: both formats, Blender's own, and everything that cannot light a scene."""

from pathlib import Path

import numpy as np
import OpenEXR
import pytest
from rsibr.rsibr_addon.core.environment import Environment
from rsibr.rsibr_addon.core.errors import InputFileError, RsibrWarning
from rsibr.rsibr_addon.files.environments import read_environment


def write_rgb(path: Path, rgb: np.ndarray) -> Path:
    header = {"type": OpenEXR.scanlineimage, "compression": OpenEXR.ZIP_COMPRESSION}
    OpenEXR.File(header, {"RGB": np.ascontiguousarray(rgb, np.float32)}).write(str(path))
    return path


def test_an_exr_is_read_bottom_row_first(tmp_path: Path) -> None:
    rgb = np.random.default_rng(0).random((4, 8, 3), dtype=np.float32)
    environment = read_environment(write_rgb(tmp_path / "sky é.exr", rgb))
    assert environment.name == "sky é.exr"
    np.testing.assert_array_equal(environment.radiance, rgb[::-1])
    assert environment.sha256 == Environment(rgb[::-1], "other").sha256


def test_alpha_is_left_out_and_grey_becomes_colour(tmp_path: Path) -> None:
    rgba = np.random.default_rng(0).random((4, 8, 4), dtype=np.float32)
    OpenEXR.File({}, {"RGBA": rgba}).write(str(tmp_path / "rgba.exr"))
    np.testing.assert_array_equal(read_environment(tmp_path / "rgba.exr").radiance, rgba[::-1, :, :3])
    OpenEXR.File({}, {"Y": rgba[..., 0].copy()}).write(str(tmp_path / "grey.exr"))
    grey = read_environment(tmp_path / "grey.exr").radiance
    np.testing.assert_array_equal(grey, np.repeat(rgba[::-1, :, :1], 3, axis=2))


@pytest.mark.parametrize("name", ["a.hdr", "a.pic", "misnamed.exr"])
def test_the_content_tells_the_format(tmp_path: Path, name: str) -> None:
    path = tmp_path / name
    path.write_bytes(b"#?RGBE\n\n-Y 1 +X 2\n" + bytes([128, 64, 32, 129, 255, 0, 0, 128]))
    # Mantissa m, exponent e: m * 2^(e - 136)
    np.testing.assert_array_equal(read_environment(path).radiance, [[[1, 0.5, 0.25], [255 / 256, 0, 0]]])


@pytest.mark.parametrize("content", [b"", b"#", b"just text", b"\x89PNG\r\n\x1a\n", b"\xff\xd8\xff\xe0"])
def test_what_is_no_picture_of_radiance_is_refused(tmp_path: Path, content: bytes) -> None:
    path = tmp_path / "a.exr"
    path.write_bytes(content)
    with pytest.raises(InputFileError, match=r"a\.exr is neither OpenEXR nor Radiance HDR: give one"):
        read_environment(path)


def test_missing_files_and_folders_are_refused(tmp_path: Path) -> None:
    with pytest.raises(InputFileError, match=r"a\.exr does not exist: check the name"):
        read_environment(tmp_path / "a.exr")
    with pytest.raises(InputFileError, match="is a folder: give the name of a file in it"):
        read_environment(tmp_path)


def test_an_unreadable_file_is_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    # Permissions do not bind a superuser, so the system's answer is put in its mouth
    def refuse(*_: object) -> None:
        raise PermissionError(13, "Permission denied")

    monkeypatch.setattr(Path, "open", refuse)
    with pytest.raises(InputFileError, match=r"a\.exr cannot be read \(Permission denied\)"):
        read_environment(tmp_path / "a.exr")


@pytest.mark.parametrize("shape", [(4, 4, 3), (4, 7, 3), (8, 4, 3)])
def test_other_shapes_than_two_to_one_are_refused(tmp_path: Path, shape: tuple[int, ...]) -> None:
    with pytest.raises(InputFileError, match=rf"a\.exr is {shape[1]}x{shape[0]}.*twice as wide as high"):
        read_environment(write_rgb(tmp_path / "a.exr", np.ones(shape)))


def test_negative_values_are_counted_and_taken_as_nothing(tmp_path: Path) -> None:
    rgb = np.ones((4, 8, 3))
    rgb[0, 2] = rgb[3, 4, 0] = -0.5
    with pytest.warns(RsibrWarning, match=r"a\.exr holds 4 negative values"):
        environment = read_environment(write_rgb(tmp_path / "a.exr", rgb))
    np.testing.assert_array_equal(environment.radiance, np.maximum(rgb, 0)[::-1])


@pytest.mark.needs("bpy")
def test_blenders_own_environments(blender_worlds: Path) -> None:
    paths = sorted(blender_worlds.glob("*.exr"))
    assert len(paths) == 8
    clamped = 0
    for path in paths:
        with OpenEXR.File(str(path)) as file:
            stored = file.channels()["RGB"].pixels
        negative = int(np.count_nonzero(stored < 0))
        environment = read_environment(path)  # a warning is an error
        np.testing.assert_array_equal(environment.radiance, np.maximum(stored, 0)[::-1])
        clamped += negative > 0
    assert clamped == 7
