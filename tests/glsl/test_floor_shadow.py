"""A sphere's shadow on the floor that it stands on: the closed form, and the place of a sun's shadow."""

import numpy as np
import pytest
from rsibr.rsibr_addon.core.conventions import Array
from rsibr.rsibr_addon.core.light.median_cut import lamps_above
from rsibr.rsibr_addon.core.maps.representation import representation
from rsibr.rsibr_addon.core.pictures.matte import EXTENT
from rsibr.rsibr_addon.device.floor_shadow import floor_shadow

pytestmark = pytest.mark.needs("gl")

SIZE = 128


def sphere() -> tuple[Array, Array]:
    """Vertices and triangles of a sphere of 64 x 32 squares; its triangles lie up to .003 within."""
    around, up = np.meshgrid(np.linspace(0.0, 2.0 * np.pi, 65), np.linspace(0.0, np.pi, 33))
    ring = np.sin(up)
    vertices = np.stack([ring * np.cos(around), ring * np.sin(around), -np.cos(up)], axis=-1).reshape(-1, 3)
    first = (np.arange(32)[:, None] * 65 + np.arange(64)).ravel()
    corners = [[first, first + 1, first + 66], [first, first + 66, first + 65]]
    return vertices, np.concatenate([np.stack(corner, axis=-1) for corner in corners])


def floor() -> tuple[Array, Array]:
    """X and y of the texels."""
    along = EXTENT * (2.0 * (np.arange(SIZE) + 0.5) / SIZE - 1.0)
    x, y = np.meshgrid(along, along)
    return x, y


def test_a_white_sky_s_shadow_is_the_sphere_s_form_factor() -> None:
    positions, triangles = sphere()
    lamps = lamps_above(np.ones((128, 256, 3)), 512)
    taken = floor_shadow(positions, triangles, -1.0, lamps, SIZE)
    # A sphere of radius 1 that rests on a plane takes 1 / (rho^2 + 1)^(3/2) of its light, rho from its foot.
    expected = (np.add(*(place**2 for place in floor())) + 1.0) ** -1.5
    error = taken[..., 0] / np.pi - expected
    assert np.abs(error.mean()) < 1e-3
    # The edge of a lamp's shadow is one step of 512, and some ten lamps' edges may meet nearby.
    assert np.abs(error).max() < 12.0 / 512.0
    assert taken.max() <= np.pi * 1.001


def test_a_sun_s_shadow_lies_opposite_and_has_its_colour() -> None:
    positions, triangles = sphere()
    light = np.zeros((64, 128, 3))
    light[45, 20] = (3.0, 2.0, 1.0)
    towards = representation("equirect").texel_directions(128)[0, 45, 20]
    lamps = lamps_above(light, 512)
    taken = floor_shadow(positions, triangles, -1.0, lamps, SIZE)
    x, y = floor()
    # The sphere's middle, 1 above the floor, has its shadow here
    foot = -towards[:2] / towards[2]
    inside = taken[..., 0] > 0.0
    texel = 2.0 * EXTENT / SIZE
    np.testing.assert_allclose([x[inside].mean(), y[inside].mean()], foot, atol=0.5 * texel)
    assert inside.sum() * texel**2 == pytest.approx(np.pi / towards[2], rel=0.03)
    np.testing.assert_allclose(
        taken[inside], np.broadcast_to(lamps.irradiance[0], (inside.sum(), 3)), rtol=1e-6
    )
