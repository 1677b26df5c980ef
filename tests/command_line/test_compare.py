"""What `rsibr compare` tells of its errors in a terminal."""

from dataclasses import dataclass

import numpy as np
import pytest
from rsibr.rsibr_addon.command_line.compare import lines
from rsibr.rsibr_addon.core.errors import RangeError
from rsibr.rsibr_addon.core.metrics import relative_rmse
from rsibr.rsibr_addon.tasks.compare.comparison import Comparison, WayError, way_error


@dataclass(frozen=True)
class Way:
    """A way to draw."""

    name: str
    slug: str = ""


def test_errors_fit_into_a_narrow_terminal() -> None:
    ways = Way("12 views, paper, single warp"), Way("42 views, fragment, albedo warp")
    errors = tuple(WayError(way, (0.125, 0.5, 0.25), 0.3) for way in ways)
    about = ("paint.rsibr.exr", "", "room.exr", "car-paint", 256, None, ((0.0, 0.0, 1.0),) * 3)
    assert list(lines(Comparison(*about, 0.142, errors), "Cycles")) == [
        "Relative RMSE against Cycles, whose own noise is 0.1420, 3 views:",
        "all views  median   worst  way of drawing",
        "   0.3000  0.2500  0.5000  12 views, paper, single warp",
        "   0.3000  0.2500  0.5000  42 views, fragment, albedo warp",
    ]
    head = next(lines(Comparison(*about, 0.0, errors), "the model itself"))
    assert head == "Relative RMSE against the model itself, 3 views:"


def test_a_flat_mesh_from_its_edge_leaves_the_other_views() -> None:
    true, coverage = np.ones((2, 4, 4, 3)), np.zeros((2, 4, 4))
    with pytest.raises(RangeError, match="show nothing of the mesh"):
        way_error(Way("mips"), relative_rmse, true, true, coverage)
    coverage[1] = 1.0
    error = way_error(Way("mips"), relative_rmse, 1.5 * true, true, coverage)
    assert (error.per_view, error.pooled) == ((0.0, 0.5), 0.5)
