"""The latitude-longitude map: anchors, inverse, solid angles, and what lies beyond its edges."""

import numpy as np
import pytest
from rsibr.rsibr_addon.core.conventions import texel_centres
from rsibr.rsibr_addon.core.geometry.directions import normalize
from rsibr.rsibr_addon.core.maps import equirect

DIRECTIONS = normalize(np.random.default_rng(3).normal(size=(2000, 3)))


def test_texel_centres_start_at_the_bottom_left() -> None:
    centres = texel_centres(4, 2)
    assert centres.shape == (2, 4, 2)
    np.testing.assert_array_equal(centres[0, 0], (0.125, 0.25))
    np.testing.assert_array_equal(centres[1, 3], (0.875, 0.75))


def test_where_the_axes_are() -> None:
    anchors = {
        (0.5, 0.5): (1, 0, 0),
        (0.25, 0.5): (0, 1, 0),
        (0.75, 0.5): (0, -1, 0),
        (0.0, 0.5): (-1, 0, 0),
        (1.0, 0.5): (-1, 0, 0),
        (0.3, 1.0): (0, 0, 1),
        (0.3, 0.0): (0, 0, -1),
        (0.5, 0.75): (np.sqrt(0.5), 0, np.sqrt(0.5)),
    }
    np.testing.assert_allclose(equirect.direction_from_uv(list(anchors)), list(anchors.values()), atol=1e-15)


def test_directions_are_found_again() -> None:
    uv = equirect.uv_from_direction(DIRECTIONS)
    assert np.all((uv >= 0.0) & (uv <= 1.0))
    np.testing.assert_allclose(equirect.direction_from_uv(uv), DIRECTIONS, atol=1e-14)


def test_points_are_found_again() -> None:
    uv = np.random.default_rng(4).random((2000, 2))
    uv[:3] = (0.25, 1e-9), (0.75, 1.0 - 1e-9), (1e-12, 0.3)  # next to the poles and to the seam
    found = equirect.uv_from_direction(equirect.direction_from_uv(uv))
    # A difference of u moves a point by its sine of the polar angle only.
    sine = np.sin(np.pi * uv[:, 1])
    np.testing.assert_allclose((found[:, 0] - uv[:, 0]) * sine, 0.0, atol=1e-15)
    np.testing.assert_allclose(found[:, 1], uv[:, 1], atol=1e-15)


def test_poles_and_seam_have_one_answer() -> None:
    np.testing.assert_array_equal(
        equirect.uv_from_direction([(0.0, 0.0, 1.0), (0.0, 0.0, -1.0)]), [(0.5, 1.0), (0.5, 0.0)]
    )
    np.testing.assert_array_equal(
        equirect.uv_from_direction([(-1.0, 0.0, 0.0), (-1.0, -0.0, 0.0)])[:, 0], (0, 1)
    )


@pytest.mark.parametrize(("width", "height"), [(2, 1), (16, 8), (10, 5), (512, 256)])
def test_solid_angles(width: int, height: int) -> None:
    solid_angle = equirect.texel_solid_angle(width, height)
    assert solid_angle.shape == (height, width)
    assert solid_angle.sum() == pytest.approx(4.0 * np.pi, rel=1e-13)
    # Integrate sin(polar) over each texel with the midpoint rule: its error is (step of polar)^2 / 24.
    steps = 64
    polar = np.pi * (np.arange(height * steps) + 0.5) / (height * steps)
    rows = np.sin(polar).reshape(height, steps).sum(axis=1) * np.pi / (height * steps) * 2.0 * np.pi / width
    error = (np.pi / (height * steps)) ** 2 / 24.0
    np.testing.assert_allclose(
        solid_angle, np.broadcast_to(rows[:, None], (height, width)), rtol=1.01 * error
    )


def test_uniform_directions_fill_texels_by_their_solid_angle() -> None:
    width, height, count = 16, 8, 200_000
    directions = normalize(np.random.default_rng(5).normal(size=(count, 3)))
    column, row = (equirect.uv_from_direction(directions) * (width, height)).astype(int).T
    hits = np.bincount(row * width + column, minlength=width * height)
    expected = count * equirect.texel_solid_angle(width, height).ravel() / (4.0 * np.pi)
    chi_squared = np.sum((hits - expected) ** 2 / expected)
    # 127 degrees of freedom: mean 127, deviation sqrt(254); six deviations.
    assert abs(chi_squared - 127.0) < 6.0 * np.sqrt(254.0)


@pytest.mark.parametrize(("width", "height"), [(16, 8), (10, 5), (2, 1)])
def test_beyond_the_edge_the_sphere_goes_on(width: int, height: int) -> None:
    # The map's formula goes on over the poles and around the horizon by itself; `wrap` has to agree.
    columns, rows = np.meshgrid(np.arange(-width, 2 * width), np.arange(-height, 2 * height))
    inside = equirect.wrap(columns, rows, width, height)
    assert np.all((inside[0] >= 0) & (inside[0] < width) & (inside[1] >= 0) & (inside[1] < height))

    def direction(column: np.ndarray, row: np.ndarray) -> np.ndarray:
        return equirect.direction_from_uv(np.stack([(column + 0.5) / width, (row + 0.5) / height], axis=-1))

    np.testing.assert_allclose(direction(*inside), direction(columns, rows), atol=1e-14)
