"""Pictures of radiance written and read, in both formats."""

from pathlib import Path

import numpy as np
import pytest
from rsibr.rsibr_addon.core.errors import InputFileError, OutputFileError, RangeError, ShapeError
from rsibr.rsibr_addon.files.radiance_hdr import read_hdr, write_hdr
from rsibr.rsibr_addon.files.radiance_pictures import (
    check_radiance_target,
    holds_radiance,
    read_radiance,
    write_radiance,
)

RNG = np.random.default_rng(0)
PICTURE = np.exp(8.0 * RNG.standard_normal((5, 9, 3))).astype(np.float32)


def test_exr_keeps_every_bit(tmp_path: Path) -> None:
    path = tmp_path / "a.exr"
    write_radiance(path, PICTURE.astype(np.float64))
    np.testing.assert_array_equal(read_radiance(path), PICTURE)
    assert holds_radiance(path)


@pytest.mark.parametrize("width", [1, 9, 40000])
def test_hdr_is_within_half_a_step(tmp_path: Path, width: int) -> None:
    picture = np.exp(8.0 * RNG.standard_normal((3, width, 3)))
    path = tmp_path / "a.hdr"
    write_radiance(path, picture)
    found = read_radiance(path)
    # The greatest of a pixel's mantissas is 128 or more: half a step is at most 1/256 of it
    step = picture.max(axis=-1, keepdims=True) / 256.0
    assert np.all(np.abs(found - picture) <= step * (1.0 + 1e-6))
    # What was read is written again as it was
    write_radiance(path, found, force=True)
    np.testing.assert_array_equal(read_radiance(path), found)


def test_hdr_at_the_ends_of_its_range(tmp_path: Path) -> None:
    greatest, least = 255.0 * 2.0**119, 2.0**-128
    values = np.array(
        [0.0, 255.4 / 256, 255.6 / 256, 1.0, greatest * (1 - 1e-7), least, least * 0.99, 1e-300]
    )
    path = tmp_path / "a.hdr"
    write_hdr(path, np.repeat(values[None, :, None], 3, axis=2))
    found = read_hdr(path)[0, :, 0]
    expected = [0.0, 255 / 256, 1.0, 1.0, greatest, least, 0.0, 0.0]
    np.testing.assert_array_equal(found, np.float32(expected))


def test_the_first_row_of_a_file_is_the_top(tmp_path: Path) -> None:
    write_hdr(tmp_path / "a.hdr", np.array([[[1.0] * 3], [[2.0] * 3]]))
    assert (tmp_path / "a.hdr").read_bytes().endswith(bytes([128, 128, 128, 130, 128, 128, 128, 129]))


@pytest.mark.parametrize("value", [-1e-30, np.nan, np.inf, 2e38])
def test_hdr_refuses_what_it_cannot_hold(tmp_path: Path, value: float) -> None:
    picture = np.ones((2, 2, 3))
    picture[1, 0, 2] = value
    with pytest.raises(RangeError, match=r"a\.hdr cannot hold values that are negative"):
        write_hdr(tmp_path / "a.hdr", picture)
    assert not list(tmp_path.iterdir())


def test_other_shapes_and_names_are_refused(tmp_path: Path) -> None:
    with pytest.raises(ShapeError, match=r"not \(2, 2, 4\)"):
        write_hdr(tmp_path / "a.hdr", np.ones((2, 2, 4)))
    for name in ("a.png", "a", "a.exr.jpg"):
        with pytest.raises(OutputFileError, match=r"does not end in \.exr or \.hdr: give"):
            write_radiance(tmp_path / name, PICTURE)
    write_radiance(tmp_path / "a.HDR", PICTURE)
    with pytest.raises(OutputFileError, match="exists: give another name, or --force"):
        check_radiance_target(tmp_path / "a.HDR")
    with pytest.raises(OutputFileError, match="exists"):
        write_radiance(tmp_path / "a.HDR", PICTURE)


def test_other_files_hold_no_radiance(tmp_path: Path) -> None:
    path = tmp_path / "a.exr"
    path.write_bytes(b"\x89PNG\r\n\x1a\n")
    assert not holds_radiance(path)
    with pytest.raises(InputFileError, match="neither OpenEXR nor Radiance HDR"):
        read_radiance(path)
    with pytest.raises(InputFileError, match="does not exist"):
        holds_radiance(tmp_path / "b.exr")
