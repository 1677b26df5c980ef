"""Pictures for people: the sRGB curve and nothing else, straight alpha, the right way up."""

from collections.abc import Callable
from pathlib import Path

import bpy
import numpy as np
import pytest
from rsibr.rsibr_addon.core.errors import OutputFileError
from rsibr.rsibr_addon.host.pictures import save_png


def srgb_from_linear(linear: np.ndarray) -> np.ndarray:
    """IEC 61966-2-1."""
    linear = np.clip(linear, 0.0, 1.0)
    return np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1.0 / 2.4) - 0.055)


def test_the_srgb_curve_and_nothing_else(tmp_path: Path, stored_bytes: Callable) -> None:
    # The artist's own view transform, exposure and dither must not matter.
    bpy.context.scene.view_settings.view_transform = "AgX"
    bpy.context.scene.view_settings.exposure = 3.0
    rgba = np.ones((16, 16, 4), dtype=np.float32)
    rgba[..., :3] = np.linspace(-0.1, 1.4, 16 * 16 * 3).reshape(16, 16, 3)
    save_png(tmp_path / "ramp.png", rgba)
    expected = np.floor(255.0 * srgb_from_linear(rgba[..., :3].astype(np.float64)) + 0.5)
    # OpenColorIO's float32 curve may fall on the other side of a rounding boundary.
    assert np.abs(stored_bytes(tmp_path / "ramp.png")[..., :3] - expected).max() <= 1.0
    assert np.count_nonzero(stored_bytes(tmp_path / "ramp.png")[..., :3] != expected) <= 4


@pytest.mark.parametrize(
    ("premultiplied", "stored"),
    [
        ((0.18, 0.18, 0.18, 1.0), (118, 118, 118, 255)),
        ((1.0, 0.0, 7.0, 1.0), (255, 0, 255, 255)),
        ((0.09, 0.09, 0.0, 0.5), (118, 118, 0, 128)),  # half covered 0.18; 127.5 rounds up
        ((0.0, 0.0, 0.0, 0.0), (0, 0, 0, 0)),
    ],
)
def test_known_values(
    tmp_path: Path, premultiplied: tuple[float, ...], stored: tuple[int, ...], stored_bytes: Callable
) -> None:
    save_png(tmp_path / "patch.png", np.full((4, 4, 4), premultiplied, dtype=np.float32))
    assert stored_bytes(tmp_path / "patch.png")[1, 2].tolist() == list(stored)


def test_the_files_working_space_does_not_matter(tmp_path: Path, stored_bytes: Callable) -> None:
    bpy.ops.wm.set_working_color_space(working_space="ACEScg")
    save_png(tmp_path / "patch.png", np.full((4, 4, 4), (0.8, 0.1, 0.02, 1.0), dtype=np.float32))
    expected = np.rint(255.0 * srgb_from_linear(np.array([0.8, 0.1, 0.02])))
    # There and back through float32 matrices, then rounded.
    assert np.abs(stored_bytes(tmp_path / "patch.png")[1, 2, :3] - expected).max() <= 1.0


def test_a_picture_is_the_right_way_up_and_left_to_right(tmp_path: Path, stored_bytes: Callable) -> None:
    rgba = np.zeros((6, 9, 4), dtype=np.float32)
    rgba[0, 8] = 1.0  # bottom right
    save_png(tmp_path / "corner.png", rgba)
    assert np.argwhere(stored_bytes(tmp_path / "corner.png")[..., 0]).tolist() == [[0, 8]]


def test_any_name_is_taken_as_it_is(tmp_path: Path) -> None:
    path = tmp_path / "50% {blend} #1.tmp"
    save_png(path, np.ones((2, 2, 4), dtype=np.float32))
    assert path.read_bytes().startswith(b"\x89PNG")
    assert [each.name for each in tmp_path.iterdir()] == [path.name]
    assert "Scene" in bpy.data.scenes
    assert len(bpy.data.scenes) == 1
    assert path.name not in bpy.data.images


def test_a_place_that_cannot_be_written_is_an_os_error(tmp_path: Path) -> None:
    (tmp_path / "file").touch()
    with pytest.raises(NotADirectoryError):
        save_png(tmp_path / "file" / "x.png", np.ones((2, 2, 4), dtype=np.float32))


def test_a_path_longer_than_blenders_is_taken(tmp_path: Path) -> None:
    folder = tmp_path.joinpath(*5 * [250 * "d"])
    folder.mkdir(parents=True)
    save_png(folder / "x.png", np.ones((2, 2, 4), dtype=np.float32))
    assert [each.name for each in folder.iterdir()] == ["x.png"]
    assert [each.name for each in folder.parent.iterdir()] == [folder.name]


def test_a_full_disk_is_told(tmp_path: Path, files_end_at: Callable) -> None:
    noise = np.random.default_rng(1).random((64, 64, 4), dtype=np.float32)
    with files_end_at(1000), pytest.raises(OutputFileError, match="disk with the temporary files is full"):
        save_png(tmp_path / "x.png", noise)
