"""Exactly lit spheres against brute force, furnaces and exact irradiance."""

import numpy as np
import pytest
from rsibr.rsibr_addon.core.brdf.albedo import directional_albedo
from rsibr.rsibr_addon.core.brdf.lambert import Lambert
from rsibr.rsibr_addon.core.brdf.spec import brdf_from_spec
from rsibr.rsibr_addon.core.conventions import Array, texel_centres
from rsibr.rsibr_addon.core.errors import RangeError, ShapeError
from rsibr.rsibr_addon.core.filtering.irradiance import irradiance_exact
from rsibr.rsibr_addon.core.geometry.directions import camera_frame, normalize
from rsibr.rsibr_addon.core.geometry.lit_sphere import LitSphere, lit_spheres, ring_radiance
from rsibr.rsibr_addon.core.maps import equirect
from rsibr.rsibr_addon.core.progress import Progress, drain

GOLD = brdf_from_spec("ggx:alpha=0.3,metal=gold", lambda name, path: Lambert(kd=0.0))
WHITE = Lambert(kd=1.0)
RNG = np.random.default_rng(11)
HEIGHT = 24


def brute_force(brdf, radiance: Array, normal: Array, view_dir: Array) -> Array:
    """The sum over all texels for one surface point, with axes of its own: any two in the surface."""
    height, width = radiance.shape[:2]
    light_dir = equirect.direction_from_uv(texel_centres(width, height))
    axes = np.stack([*np.linalg.svd(normal[None])[2][1:], normal])
    axes[0] *= np.linalg.det(axes)
    lobe = brdf(light_dir @ axes.T, axes @ view_dir) * np.maximum(light_dir @ normal, 0.0)[..., None]
    return np.sum(lobe * radiance * equirect.texel_solid_angle(width, height)[..., None], axis=(0, 1))


def normals_of_ring(mu: float, width: int) -> Array:
    azimuth = np.pi * (1.0 - 2.0 * (np.arange(width) + 0.5) / width)
    radius = np.sqrt(1.0 - mu**2)
    return np.stack([radius * np.cos(azimuth), radius * np.sin(azimuth), np.full(width, mu)], axis=-1)


@pytest.mark.parametrize("mu", [0.02, 0.4, 0.97, 1.0])
def test_a_ring_is_the_sum_over_all_texels(mu: float) -> None:
    radiance = RNG.random((HEIGHT, 2 * HEIGHT, 3)) ** 8
    radiance[5, 7] = 1e3
    found = ring_radiance(GOLD, radiance, [mu])
    assert found.shape == (1, 2 * HEIGHT, 3)
    view_dir = np.array([0.0, 0.0, 1.0])
    for column in (0, 13, 40):
        normal = normals_of_ring(mu, 2 * HEIGHT)[column]
        expected = brute_force(GOLD, radiance, normal, view_dir)
        # Transforms are off by roundings of the largest value; at mu = 1 half vectors by some 1e-12.
        np.testing.assert_allclose(found[0, column], expected, rtol=1e-9, atol=1e-10)


def test_maps_can_be_many() -> None:
    maps = RNG.random((2, 3, HEIGHT, 2 * HEIGHT, 3))
    found = ring_radiance(GOLD, maps, [0.3, 0.8])
    np.testing.assert_allclose(found[1, 2], ring_radiance(GOLD, maps[1, 2], [0.3, 0.8]), rtol=1e-13)


def test_in_even_light_a_sphere_shows_its_albedo() -> None:
    mu = [0.2, 0.7]
    found = ring_radiance(GOLD, np.ones((256, 512, 1)), mu)
    # The midpoint rule on texels of 0.7 degrees: the lobe is some 30 wide and the horizon cuts texels,
    # of a cosine that vanishes there; both err by (0.7 degrees)^2 times a few.
    np.testing.assert_allclose(
        found, np.repeat(directional_albedo(GOLD, mu)[:, None], 512, axis=1), rtol=1e-3
    )


def test_a_lambertian_sphere_shows_irradiance() -> None:
    radiance = RNG.random((HEIGHT, 2 * HEIGHT, 3)) ** 8
    found = ring_radiance(WHITE, radiance, [0.35])[0]
    expected = irradiance_exact(radiance, normals_of_ring(0.35, 2 * HEIGHT)) / np.pi
    np.testing.assert_allclose(found, expected, rtol=1e-12)


@pytest.mark.parametrize("view_dir", [(0.0, 0.0, 1.0), (0.0, 0.0, -1.0), (0.6, -0.8, 0.0), (0.48, 0.64, 0.6)])
def test_spheres_are_seen_from_anywhere(view_dir: tuple[float, float, float]) -> None:
    direction = equirect.direction_from_uv(texel_centres(128, 64))
    radiance = np.exp(direction @ np.array([[0.5, -0.3, 1.0], [0.2, 0.8, -0.1], [-0.4, 0.3, 0.6]]))
    (sphere,) = drain(lit_spheres(GOLD, radiance, [view_dir], 16))
    np.testing.assert_array_equal(sphere.frame, camera_frame(view_dir))
    normal = normalize(np.asarray(view_dir) + 0.8 * RNG.uniform(-1.0, 1.0, (5, 3)) / np.sqrt(3.0))
    expected = [brute_force(GOLD, radiance, each, np.asarray(view_dir)) for each in normal]
    # Bilinear lookups of a map with second derivatives up to 2 between texels of 0.05: 2 * 0.05^2 / 8 =
    # 6e-4; cubics through rings 0.1 apart err by 3 / 128 of their fourth differences, some 100 * 1e-4.
    np.testing.assert_allclose(sphere.at(normal), expected, rtol=2e-3)


def test_interpolation_is_exact_for_cubics_and_continuous_at_the_pole() -> None:
    rings, width = 8, 64
    angle = (np.arange(rings) + 0.5) / rings
    cubic = 1.0 + 2.0 * angle - 3.0 * angle**2 + 0.5 * angle**3
    sphere = LitSphere(np.eye(3), np.repeat(cubic[:, None, None], width, axis=1) * np.ones(3))
    # Of 8 rings, those within two rings of the pole see the other side.
    rise = np.linspace(0.5 / rings, 1.0 - 1.5 / rings, 50)
    normal = np.stack([np.cos(rise * np.pi / 2), 0.0 * rise, np.sin(rise * np.pi / 2)], axis=-1)
    expected = 1.0 + 2.0 * rise - 3.0 * rise**2 + 0.5 * rise**3
    np.testing.assert_allclose(sphere.at(normal)[:, 0], expected, rtol=1e-12)
    # A function of the normal that is smooth at the pole comes out so: x, an odd one.
    polar = 0.5 * np.pi * (1.0 - angle)
    azimuth = np.pi * (1.0 - 2.0 * (np.arange(width) + 0.5) / width)
    sphere = LitSphere(np.eye(3), (np.sin(polar)[:, None] * np.cos(azimuth))[..., None] * np.ones(3))
    near = normalize([(0.01, 0.02, 1.0), (-0.05, 0.0, 1.0), (0.0, 0.0, 1.0), (0.3, -0.1, 1.0)])
    # Cubics in the angle: 3 / 128 (pi / 16)^4 = 3e-5; linear along rings: (2 pi / 64)^2 / 8 of x.
    np.testing.assert_allclose(sphere.at(near)[:, 1], near[:, 0], atol=5e-4)


def test_normals_that_point_away_are_taken_for_the_rim() -> None:
    sphere = LitSphere(np.eye(3), RNG.random((8, 16, 3)))
    rim, behind = sphere.at(normalize([(0.6, 0.8, 0.0), (0.6, 0.8, -0.3)]))
    np.testing.assert_allclose(behind, rim, rtol=1e-12)


def test_progress_goes_ring_by_ring() -> None:
    steps = list(lit_spheres(WHITE, np.ones((4, 8, 3)), [(0.0, 0.0, 1.0)], 5))
    assert steps[0] == Progress(0, 5, "integrating ring 1 of 5")
    assert [step.done for step in steps] == list(range(5))


@pytest.mark.parametrize("mu", [0.0, -0.1, 1.1, np.nan])
def test_elevations_have_limits(mu: float) -> None:
    with pytest.raises(RangeError, match="greater than 0 and at most 1"):
        ring_radiance(WHITE, np.ones((4, 8, 3)), [mu])


def test_maps_of_other_shapes_are_refused() -> None:
    with pytest.raises(ShapeError, match="twice as wide as high, not 9x4"):
        ring_radiance(WHITE, np.ones((4, 9, 3)), [0.5])
    with pytest.raises(RangeError, match="3 rings are too few"):
        drain(lit_spheres(WHITE, np.ones((4, 8, 3)), [(0.0, 0.0, 1.0)], 3))
