"""A mirror in an environment against closed forms."""

import numpy as np
import pytest
from rsibr.rsibr_addon.core.antialiased.averaging import Averaging
from rsibr.rsibr_addon.core.antialiased.footprint import parallelogram, pixel_footprints
from rsibr.rsibr_addon.core.conventions import texel_centres
from rsibr.rsibr_addon.core.environment import Environment
from rsibr.rsibr_addon.core.errors import RangeError
from rsibr.rsibr_addon.core.geometry.directions import dot, normalize, reflect
from rsibr.rsibr_addon.core.kinds.environment import EnvironmentLook, mirrored_environment
from rsibr.rsibr_addon.core.maps import equirect
from rsibr.tests.mirror_capture import environment, radiance_from

RNG = np.random.default_rng(61)
NORMAL = normalize(RNG.normal(size=(500, 3)))
VIEW = normalize(NORMAL + 0.9 * normalize(RNG.normal(size=(500, 3))))
INTERPOLATED = EnvironmentLook(antialiased=False)


def random_environment(height: int) -> Environment:
    return Environment(RNG.random((height, 2 * height, 3), dtype=np.float32), "random")


def test_a_mirror_shows_texels_where_they_are() -> None:
    light = random_environment(6)
    texels = equirect.direction_from_uv(texel_centres(12, 6))
    view_dir = np.broadcast_to((0.0, 0.6, 0.8), texels.shape)
    shown = mirrored_environment(light, normalize(texels + view_dir), view_dir, INTERPOLATED)
    np.testing.assert_allclose(shown, light.radiance, atol=1e-12)


def test_a_footprint_of_a_texel_shows_that_texel() -> None:
    height = 8
    light = random_environment(height)
    corners = np.stack(
        np.meshgrid(np.arange(2 * height + 1) / (2 * height), np.arange(height + 1) / height), axis=-1
    )
    footprint = pixel_footprints(equirect.direction_from_uv(corners))
    texels = equirect.direction_from_uv(texel_centres(2 * height, height))
    view_dir = np.broadcast_to((0.0, 0.6, 0.8), texels.shape)
    look = EnvironmentLook(averaging=Averaging.SUMMED)
    shown = mirrored_environment(light, normalize(texels + view_dir), view_dir, look, footprint)
    # Rows at the poles have corners that coincide, and boxes all around.
    np.testing.assert_allclose(shown[1:-1], light.radiance[1:-1], rtol=1e-9)


def test_a_small_footprint_is_interpolated() -> None:
    light = environment(64)
    mirror_dir = reflect(VIEW, NORMAL)
    footprint = parallelogram(mirror_dir, 1e-6 * VIEW, 1e-6 * NORMAL)
    averaged = mirrored_environment(light, NORMAL, VIEW, EnvironmentLook(), footprint)
    between = mirrored_environment(light, NORMAL, VIEW, INTERPOLATED)
    of_points = mirrored_environment(light, NORMAL, VIEW, EnvironmentLook())
    np.testing.assert_allclose(of_points, averaged, atol=1e-5)
    # Of two rows the one nearer to the equator weighs more, by the ratio of their solid angles: of a row k
    # from a pole, at most 1 / k, times a quarter of what they differ by, 1.7 times pi / 64 at most.
    from_pole = np.maximum(np.arccos(np.abs(mirror_dir[:, 2])) * 64 / np.pi, 1.0)
    bound = 0.25 / from_pole * 1.7 * np.pi / 64
    assert np.all(np.abs(averaged - between) < bound[:, None] + 1e-6)
    # And either is the closed form's, as far as texels of 2.8 degrees tell: h^2 / 8 of second derivatives up
    # to 16 / 4 along each axis.
    assert np.abs(between - radiance_from(mirror_dir)).max() < 4.0 * (np.pi / 64) ** 2


def test_reflectance_is_schlick_s() -> None:
    light = Environment(np.ones((4, 8, 3), np.float32), "even")
    look = EnvironmentLook(f0=(1.0, 0.5, 0.0), antialiased=False)
    shown = mirrored_environment(light, NORMAL, VIEW, look)
    fifth = (1.0 - np.clip(dot(NORMAL, VIEW), 0.0, 1.0)) ** 5
    np.testing.assert_allclose(shown, np.stack([np.ones(500), 0.5 + 0.5 * fifth, fifth], axis=-1))


def test_what_cannot_be_shaded_is_refused() -> None:
    with pytest.raises(RangeError, match=r"Reflectance cannot be 1\.5"):
        EnvironmentLook(f0=(1.0, 1.0, 1.5))
