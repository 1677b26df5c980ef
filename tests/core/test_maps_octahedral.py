"""The octahedral map: corners and axes by hand, folds, solid angles."""

import numpy as np
import pytest
from rsibr.rsibr_addon.core.geometry.directions import normalize
from rsibr.rsibr_addon.core.maps import octahedral

RNG = np.random.default_rng(0)
DIRECTIONS = np.concatenate([normalize(RNG.standard_normal((3000, 3))), np.eye(3), -np.eye(3)])


def test_by_hand() -> None:
    anchors = {
        (0.5, 0.5): (0, 0, 1),
        (1.0, 0.5): (1, 0, 0),
        (0.5, 1.0): (0, 1, 0),
        (0.0, 0.5): (-1, 0, 0),
        (0.5, 0.0): (0, -1, 0),
        (0.75, 0.75): (np.sqrt(0.5), np.sqrt(0.5), 0),
        (0.75, 0.5): (np.sqrt(0.5), 0, np.sqrt(0.5)),
        (1.0, 0.75): (np.sqrt(0.5), 0, -np.sqrt(0.5)),
        (0.0, 1.0): (0, 0, -1),
        (1.0, 1.0): (0, 0, -1),
    }
    np.testing.assert_allclose(
        octahedral.direction_from_uv(list(anchors)), list(anchors.values()), atol=1e-15
    )
    np.testing.assert_array_equal(octahedral.uv_from_direction((0.0, 0.0, -1.0)), (1.0, 1.0))


def test_inverse() -> None:
    found = octahedral.direction_from_uv(octahedral.uv_from_direction(DIRECTIONS))
    np.testing.assert_allclose(found, DIRECTIONS, atol=1e-15)
    uv = RNG.random((3000, 2))
    np.testing.assert_allclose(octahedral.uv_from_direction(octahedral.direction_from_uv(uv)), uv, atol=1e-15)


@pytest.mark.parametrize("size", [1, 2, 3, 8, 9])
def test_solid_angles(size: int) -> None:
    found = octahedral.texel_solid_angle(size)
    assert found.sum() == pytest.approx(4.0 * np.pi, rel=1e-14)
    # On a face of the octahedron, p = (x, y, z) with |x| + |y| + |z| = 1, d omega = dx dy / |p|^3
    fine = 256 * size
    x = 2.0 * (np.arange(fine) + 0.5) / fine - 1.0
    y = x[:, None]
    above = np.abs(x) + np.abs(y) < 1.0
    z = 1.0 - np.abs(x) - np.abs(y)
    px, py = np.where(above, x, 1.0 - np.abs(y)), np.where(above, y, 1.0 - np.abs(x))
    density = (px**2 + py**2 + z**2) ** -1.5 * (2.0 / fine) ** 2
    expected = density.reshape(size, 256, size, 256).sum(axis=(1, 3))
    # The midpoint rule, where kinks of the density run along the lines of its own grid or diagonally
    # across its cells: h^2 times second derivatives below 30
    np.testing.assert_allclose(found, expected, rtol=30.0 * (2.0 / fine) ** 2)


@pytest.mark.parametrize("size", [1, 4, 7])
def test_beyond_an_edge_is_the_texel_that_touches_it(size: int) -> None:
    """A texel beyond the edge, seen from the edge's point that both touch, is where it says it is."""
    along = np.arange(size)
    edges = [
        (along, np.full(size, -1), along + 0.5, np.zeros(size)),
        (along, np.full(size, size), along + 0.5, np.full(size, float(size))),
        (np.full(size, -1), along, np.zeros(size), along + 0.5),
        (np.full(size, size), along, np.full(size, float(size)), along + 0.5),
    ]
    for column, row, x, y in edges:
        columns, rows = octahedral.wrap(column, row, size, size)
        on_edge = octahedral.direction_from_uv(np.stack([x, y], axis=-1) / size)
        # The found texel's own edge has the same middle: the nearest point of it, half a texel away
        uv = np.stack([columns + 0.5, rows + 0.5], axis=-1) / size
        reached = np.stack([uv + 0.5 / size * np.array(step) for step in ((1, 0), (-1, 0), (0, 1), (0, -1))])
        gap = np.linalg.norm(octahedral.direction_from_uv(reached) - on_edge, axis=-1).min(axis=0)
        np.testing.assert_allclose(gap, 0.0, atol=1e-7)
    # Around -z, all four corners meet
    np.testing.assert_array_equal(octahedral.wrap(np.array(size), np.array(size), size, size), (0, 0))


def test_inside_is_itself() -> None:
    column, row = (index.ravel() for index in np.meshgrid(np.arange(6), np.arange(6)))
    np.testing.assert_array_equal(octahedral.wrap(column, row, 6, 6), (column, row))
