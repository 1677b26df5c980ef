"""The three ways of previews to average a table, against exact means."""

import numpy as np
import pytest
from rsibr.rsibr_addon.core.antialiased.averaging import Averaging, footprint_mean
from rsibr.rsibr_addon.core.antialiased.footprint import pixel_footprints
from rsibr.rsibr_addon.core.antialiased.quadrilateral import quadrilateral_mean
from rsibr.rsibr_addon.core.antialiased.strips import strip_means
from rsibr.rsibr_addon.core.antialiased.summed_area import summed_area_table
from rsibr.rsibr_addon.core.conventions import texel_centres
from rsibr.rsibr_addon.core.geometry.directions import normalize
from rsibr.rsibr_addon.core.maps import equirect
from rsibr.tests.core.test_antialiased import footprints

HEIGHT = 32
WAYS = pytest.mark.parametrize("averaging", Averaging)


@WAYS
@pytest.mark.parametrize("size", [0.01, 0.2, 1.0])
def test_a_constant_table_stays_constant(averaging: Averaging, size: float) -> None:
    corners = footprints(200, size)
    middle = normalize(corners.sum(axis=1))
    mean = footprint_mean(np.full((HEIGHT, 2 * HEIGHT, 1), 3.0), middle, corners, averaging)
    np.testing.assert_allclose(mean, 3.0, rtol=1e-9)


@WAYS
@pytest.mark.parametrize("shift", [0.0, 0.37])
def test_pixels_side_by_side_share_a_lamp_out(averaging: Averaging, shift: float) -> None:
    table = np.zeros((HEIGHT, 2 * HEIGHT, 1))
    table[15, 20] = 1000.0
    # A grid of pixels of 3.2 x 2.4 texels about the equator, upright
    columns = (np.arange(9) * 3.2 + 8.0 + shift) / (2 * HEIGHT)
    rows = (np.arange(7) * 2.4 + 8.0 + shift) / HEIGHT
    corners = pixel_footprints(equirect.direction_from_uv(np.stack(np.meshgrid(columns, rows), axis=-1)))
    middle = normalize(corners.sum(axis=-2))
    area = (columns[1] - columns[0]) * 2.0 * np.pi * np.diff(-np.cos(np.pi * rows))[:, None, None]
    shared = np.sum(area * footprint_mean(table, middle, corners, averaging))
    lamp = 1000.0 * equirect.texel_solid_angle(2 * HEIGHT, HEIGHT)[15, 20]
    # Rows differ in size by 3 % within the grid. Lookups 2/3 to 1 of a texel apart add the weights of
    # interpolation up to 1 within 9 %, along each side
    assert shared == pytest.approx(lamp, rel=0.2 if averaging is Averaging.SUBDIVIDE else 0.03)


def test_strips_come_near_the_quadrilateral() -> None:
    table = np.random.default_rng(41).random((HEIGHT, 2 * HEIGHT, 1))
    corners = footprints(400, 0.5)
    # Away from the poles, where edges that are straight in the table are none on the sphere
    corners = corners[np.all(np.abs(corners[..., 2]) < 0.7, axis=1)]
    exact = quadrilateral_mean(table, corners)
    error = strip_means(summed_area_table(table), corners) - exact
    assert np.sqrt(np.mean(error**2)) < 0.2 * np.std(table)


def test_a_texel_is_itself() -> None:
    table = np.random.default_rng(42).random((HEIGHT, 2 * HEIGHT, 3))
    direction = equirect.direction_from_uv(texel_centres(2 * HEIGHT, HEIGHT))
    corners = np.repeat(direction[..., None, :], 4, axis=-2)
    for averaging in Averaging:
        np.testing.assert_allclose(footprint_mean(table, direction, corners, averaging), table, rtol=1e-9)
