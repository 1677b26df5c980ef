"""Photographs of a cube's faces agree along its edges after balancing."""

import numpy as np
import pytest
from rsibr.rsibr_addon.core.errors import RangeError
from rsibr.rsibr_addon.core.light.cube_balance import balancing_gains, edge_pairs
from rsibr.rsibr_addon.core.maps.representation import representation

RNG = np.random.default_rng(0)


def smooth_cube(size: int) -> np.ndarray:
    """Radiance 2 + direction."""
    return 2.0 + representation("cube_map").texel_directions(size)


def test_texels_across_an_edge_are_neighbours() -> None:
    size = 16
    face, other, texel, across = edge_pairs(representation("cube_map").texel_directions(size))
    assert np.all(face != other)
    # Neighbouring centres are one texel apart: at an edge's middle 2 / 16 at a distance of sqrt(2) from the
    # cube's centre, and folded, less
    assert np.linalg.norm(texel - across, axis=-1).max() < 2.0 / size
    # Each of twelve edges from both sides
    assert len(np.unique(face * 6 + other)) == 24


def test_gains_are_undone() -> None:
    applied = np.exp(RNG.normal(0.0, 0.7, (6, 3)))
    gains = balancing_gains(smooth_cube(64) / applied[:, None, None], np.inf)
    restored = gains / applied
    # Neighbours differ by up to 1/32 / 0.8 in the direction's channel; the sign differs between edges
    np.testing.assert_allclose(restored / restored[0], 1.0, rtol=0.02)
    np.testing.assert_allclose(np.log(gains).mean(axis=0), 0.0, atol=1e-12)


def test_a_constant_environment_comes_back_exactly() -> None:
    applied = np.array([1.0, 2.0, 0.5, 4.0, 3.0, 0.25])[:, None]
    gains = balancing_gains(np.ones((6, 4, 4, 1)) / applied[:, None, None], np.inf)
    np.testing.assert_allclose(gains * np.prod(applied) ** (1 / 6), applied, rtol=1e-12)


def test_saturated_edges_count_nothing() -> None:
    cube = np.ones((6, 8, 8, 1)) * 0.5
    cube[3] *= 0.5
    # A lamp over most of the edge between faces 2 and 5, clipped on the one only
    cube[2, :2] = 1.0
    gains = balancing_gains(cube, 0.96)
    np.testing.assert_allclose(gains[:, 0] / gains[0, 0], [1, 1, 1, 2, 1, 1], rtol=1e-12)


@pytest.mark.parametrize("value", [0.0, 1.0])
def test_a_face_that_tells_nothing_is_refused(value: float) -> None:
    cube = np.full((6, 8, 8, 3), 0.5)
    cube[4] = value
    with pytest.raises(RangeError, match="too few texels on their edges are neither black nor white"):
        balancing_gains(cube, 0.96)
