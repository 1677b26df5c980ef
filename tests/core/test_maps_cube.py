"""The cube map against OpenGL's own table, and across its edges."""

import numpy as np
import pytest
from rsibr.rsibr_addon.core.geometry.directions import normalize
from rsibr.rsibr_addon.core.maps import cube_map

RNG = np.random.default_rng(0)
DIRECTIONS = normalize(RNG.standard_normal((3000, 3)))


def opengl(direction: np.ndarray) -> tuple[float, float, int]:
    """(s, t, face) as OpenGL 4.6, table 8.19 has it: (sc, tc, ma) of each major axis."""
    x, y, z = direction
    rows = [(-z, -y, x), (z, -y, -x), (x, z, y), (x, -z, -y), (x, -y, z), (-x, -y, -z)]
    face = int(np.argmax([ma for _, _, ma in rows]))
    sc, tc, ma = rows[face]
    return 0.5 * (sc / ma + 1.0), 0.5 * (tc / ma + 1.0), face


def test_the_table() -> None:
    uv, sheet = cube_map.uv_from_direction(DIRECTIONS)
    expected = np.array([opengl(direction) for direction in DIRECTIONS])
    np.testing.assert_allclose(uv, expected[:, :2], atol=1e-15)
    np.testing.assert_array_equal(sheet, expected[:, 2])
    assert cube_map.SHEETS == ("px", "nx", "py", "ny", "pz", "nz")


def test_inverse() -> None:
    uv, sheet = cube_map.uv_from_direction(DIRECTIONS)
    np.testing.assert_allclose(cube_map.direction_from_uv(uv, sheet), DIRECTIONS, atol=1e-15)
    uv, sheet = RNG.random((3000, 2)), RNG.integers(0, 6, 3000)
    found, on = cube_map.uv_from_direction(cube_map.direction_from_uv(uv, sheet))
    np.testing.assert_array_equal(on, sheet)
    np.testing.assert_allclose(found, uv, atol=1e-15)


@pytest.mark.parametrize("size", [1, 2, 5, 8])
def test_solid_angles(size: int) -> None:
    found = cube_map.texel_solid_angle(size)
    assert found.shape == (6, size, size)
    assert found.sum() == pytest.approx(4.0 * np.pi, rel=1e-15)
    # Midpoint rule of (1 + s^2 + t^2)^(-3/2) over each texel: error h^2 / 24 times second derivatives below 6
    fine = 128 * size
    s = 2.0 * (np.arange(fine) + 0.5) / fine - 1.0
    density = (1.0 + s * s + s[:, None] ** 2) ** -1.5 * (2.0 / fine) ** 2
    expected = density.reshape(size, 128, size, 128).sum(axis=(1, 3))
    np.testing.assert_allclose(found, np.broadcast_to(expected, found.shape), rtol=0.5 * (2.0 / fine) ** 2)


def centre(column: np.ndarray, row: np.ndarray, sheet: np.ndarray, size: int) -> np.ndarray:
    uv = np.stack([(column + 0.5) / size, (row + 0.5) / size], axis=-1)
    return cube_map.direction_from_uv(uv, sheet)


@pytest.mark.parametrize("size", [1, 4, 7])
def test_beyond_an_edge_is_the_neighbour_nearest_to_it(size: int) -> None:
    along = np.arange(size)
    for sheet in range(6):
        for column, row in [
            (along, -1),
            (along, size),
            (np.full(size, -1), along),
            (np.full(size, size), along),
        ]:
            column, row = np.broadcast_arrays(column, row)
            columns, rows, sheets = cube_map.wrap(column, row, np.full(size, sheet), size, size)
            assert np.all(sheets != sheet)
            # Folded over the edge: the own texel inside and the one found mirror each other about the
            # plane through the edge and the cube's centre
            inside = centre(
                np.clip(column, 0, size - 1), np.clip(row, 0, size - 1), np.full(size, sheet), size
            )
            found = centre(columns, rows, sheets, size)
            normals = cube_map.FACES[sheet, 2] - cube_map.FACES[sheets[0], 2]
            mirrored = inside - (inside @ normals)[:, None] * normals
            np.testing.assert_allclose(found, mirrored, atol=1e-15)


def test_farther_beyond_an_edge_goes_as_far_down_the_neighbour() -> None:
    # +Z continues to the right on +X, whose s grows towards -z
    columns, rows, sheets = cube_map.wrap(np.array([8, 9, 15]), np.array([2, 2, 2]), np.full(3, 4), 8, 8)
    np.testing.assert_array_equal((columns, rows, sheets), [(0, 1, 7), (2, 2, 2), (0, 0, 0)])


def test_beyond_a_corner_is_nothing_and_within_is_itself() -> None:
    column, row = (index.ravel() for index in np.meshgrid([-1, 5], [-1, 5]))
    for sheet in range(6):
        *_, sheets = cube_map.wrap(column, row, np.full(4, sheet), 5, 5)
        np.testing.assert_array_equal(sheets, cube_map.NOWHERE)
    column, row, sheet = (index.ravel() for index in np.meshgrid(np.arange(5), np.arange(5), np.arange(6)))
    np.testing.assert_array_equal(cube_map.wrap(column, row, sheet, 5, 5), (column, row, sheet))
