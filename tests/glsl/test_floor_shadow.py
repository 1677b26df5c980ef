"""A sphere's shadow on the floor that it stands on: the closed form, and the place of a sun's shadow."""

import numpy as np
import pytest
from rsibr.rsibr_addon.core.conventions import Array
from rsibr.rsibr_addon.core.light.median_cut import Lamps, lamps_above
from rsibr.rsibr_addon.core.maps.representation import representation
from rsibr.rsibr_addon.core.pictures.matte import EXTENT
from rsibr.rsibr_addon.device.context import ensure_context
from rsibr.rsibr_addon.device.drawing import GpuMesh
from rsibr.rsibr_addon.device.floor_shadow import FloorArea, floor_map, floor_shadow

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


def shadow_of(lamps: Lamps, *middles: tuple[float, float, float]) -> Array:
    """What spheres of radius 1 take from the floor."""
    ensure_context()
    positions, triangles = sphere()
    mesh, models = GpuMesh(positions, positions, triangles), np.tile(np.eye(4), (len(middles), 1, 1))
    models[:, :3, 3] = middles
    area = FloorArea(np.zeros(2), EXTENT)
    return floor_map(floor_shadow([(mesh, model) for model in models], lamps, area, SIZE))


def floor() -> tuple[Array, Array]:
    """X and y of the texels."""
    along = EXTENT * (2.0 * (np.arange(SIZE) + 0.5) / SIZE - 1.0)
    x, y = np.meshgrid(along, along)
    return x, y


def test_a_white_sky_s_shadow_is_the_sphere_s_form_factor() -> None:
    taken = shadow_of(lamps_above(np.ones((128, 256, 3)), 512), (0.0, 0.0, 1.0))
    # A sphere of radius 1 that rests on a plane takes 1 / (rho^2 + 1)^(3/2) of its light, rho from its foot.
    expected = (np.add(*(place**2 for place in floor())) + 1.0) ** -1.5
    error = taken[..., 0] / np.pi - expected
    assert np.abs(error.mean()) < 1e-3
    # The edge of a lamp's shadow is one step of 512, and some ten lamps' edges may meet nearby.
    assert np.abs(error).max() < 12.0 / 512.0
    assert taken.max() <= np.pi * 1.001


def test_a_sun_s_shadow_lies_opposite_and_has_its_colour() -> None:
    light = np.zeros((64, 128, 3))
    light[45, 20] = (3.0, 2.0, 1.0)
    towards = representation("equirect").texel_directions(128)[0, 45, 20]
    lamps = lamps_above(light, 512)
    taken = shadow_of(lamps, (0.0, 0.0, 1.0))
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


def test_light_that_several_hide_is_taken_once() -> None:
    lamps = lamps_above(np.ones((128, 256, 3)), 512)
    first, second = (0.0, 0.0, 1.0), (0.0, 0.4, 3.0)
    taken, alone = shadow_of(lamps, first, second), [shadow_of(lamps, each) for each in (first, second)]
    assert (taken >= np.maximum(*alone) * (1.0 - 1e-6)).all()
    assert (taken <= np.add(*alone) * (1.0 + 1e-6)).all()
    assert taken.max() <= np.pi * 1.001
    # Straight beneath both, the first hides most of what the second does
    middle = SIZE // 2
    assert taken[middle, middle, 0] < 0.95 * np.add(*alone)[middle, middle, 0]


def test_what_is_below_the_floor_has_no_shadow() -> None:
    lamps = lamps_above(np.ones((32, 64, 3)), 64)
    assert not shadow_of(lamps, (0.0, 0.0, -1.5)).any()
    half = shadow_of(lamps, (0.0, 0.0, 0.0))
    x, y = floor()
    inside = np.hypot(x, y) < 0.9
    # A half sphere leaves nothing beneath it any light
    np.testing.assert_allclose(half[inside], lamps.irradiance.sum(axis=0)[0], rtol=1e-4)
