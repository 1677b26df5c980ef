"""Lines as pixels cover what lines cover."""

import numpy as np
import pytest
from rsibr.rsibr_addon.core.pictures.line_drawing import DASH, GAP, line_coverage


@pytest.mark.parametrize("width", [1.0, 2.0, 3.0])
def test_a_line_along_an_axis_covers_its_width(width: float) -> None:
    coverage = line_coverage([(-5.0, 6.5), (25.0, 6.5)], (16, 20), width)
    np.testing.assert_allclose(coverage.sum(axis=0), width, atol=1e-12)
    assert coverage[15 - 6].min() == 1.0  # the line lies in the seventh row from the top
    np.testing.assert_array_equal(coverage, coverage[:, :1] @ np.ones((1, 20)))


def test_a_slanting_line_covers_its_area() -> None:
    coverage = line_coverage([(10.0, 10.0), (70.0, 40.0)], (50, 80), 3.0)
    # Its ends are round, each half a disk more
    area = 3.0 * np.hypot(60.0, 30.0) + np.pi * 1.5**2
    assert coverage.sum() == pytest.approx(area, rel=0.03)
    assert coverage.min() == 0.0
    assert coverage.max() <= 1.0


def test_dashes_leave_gaps() -> None:
    row = line_coverage([(0.0, 0.5), (400.0, 0.5)], (1, 400), 1.0, dashed=True)[0]
    assert row.mean() == pytest.approx(DASH / (DASH + GAP), abs=0.1)
    assert (row == 0.0).any()


def test_what_lies_outside_is_left_out() -> None:
    assert not line_coverage([(30.0, -9.0), (60.0, 90.0)], (10, 20), 3.0).any()
