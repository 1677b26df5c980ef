"""A pyramid of six renders: each map against the integral, and materials against those of a baked pyramid."""

import numpy as np
import pytest
from rsibr.rsibr_addon.core.brdf.principled import Surface
from rsibr.rsibr_addon.core.conventions import Array
from rsibr.rsibr_addon.core.errors import RangeError
from rsibr.rsibr_addon.core.filtering.harmonics.legendre import legendre_series
from rsibr.rsibr_addon.core.filtering.radial_lobes import cosine_lobe, von_mises_fisher_lobe
from rsibr.rsibr_addon.core.filtering.zonal import zonal_coefficients
from rsibr.rsibr_addon.core.geometry.directions import normalize
from rsibr.rsibr_addon.core.kinds.kernel_pyramid.bake import bake_pyramid, leaning_lobe, ring_lobe
from rsibr.rsibr_addon.core.kinds.kernel_pyramid.live import CUBE, live_maps, live_pyramid
from rsibr.rsibr_addon.core.kinds.kernel_pyramid.pyramid import OCTAHEDRAL
from rsibr.rsibr_addon.core.kinds.kernel_pyramid.shading import principled_radiance
from rsibr.rsibr_addon.core.lobes.rings import WIDTHS
from rsibr.rsibr_addon.core.maps.representation import representation
from rsibr.rsibr_addon.core.progress import drain
from rsibr.rsibr_addon.core.suns import NO_SUNS, lamp_suns
from rsibr.rsibr_addon.files.kinds.kernel_pyramid import shipped_families

SIZE = 32
TOWARDS = normalize(np.array([0.6, 0.48, 0.64]))


def sky(direction: Array) -> Array:
    """A dim sky over a red floor, with a window whose light is 60 times as bright."""
    light = 0.35 + 0.1 * np.tanh(6.0 * direction[..., 2:]) * [0.5, 1.0, 2.0]
    return light + 20.0 * np.exp(40.0 * (direction @ TOWARDS - 1.0))[..., None] * [1.0, 0.9, 0.7]


def test_constant_light_has_constant_maps() -> None:
    pyramid = live_pyramid(np.full((6, SIZE, SIZE, 3), 3.0))
    leaning = zonal_coefficients(leaning_lobe(), 0)[0]
    for sheets, integral in (
        *((sheets, 1.0) for sheets in (pyramid.mirror, *pyramid.maps, pyramid.rings, pyramid.diffuse[:1])),
        (pyramid.diffuse[1:], leaning),
    ):
        # A weight of 1e4 for the integral, against errors of the other degrees of a tenth at most
        np.testing.assert_allclose(sheets, 3.0 * integral, rtol=1e-5)


def test_each_map_is_the_integral() -> None:
    """A glow's integrals are known by its zonal coefficients."""
    glow = von_mises_fisher_lobe(30.0)
    faces = glow.profile(np.arccos(np.clip(CUBE.texel_directions(SIZE) @ TOWARDS, -1.0, 1.0)))
    pyramid = live_pyramid(np.repeat(faces[..., None], 3, axis=-1))
    degree = 40
    there = zonal_coefficients(glow, degree) * (2 * np.arange(degree + 1) + 1) / (4.0 * np.pi)

    def error(sheet: Array, coefficients: Array) -> float:
        angle = np.arccos(np.clip(OCTAHEDRAL.texel_directions(len(sheet))[0] @ TOWARDS, -1.0, 1.0))
        expected = legendre_series(there * coefficients, angle.ravel()).reshape(angle.shape)
        wrong = sheet[..., 0] - expected
        return float(np.sqrt(np.mean(wrong**2) / np.mean(expected**2)))

    kernels = [zonal_coefficients(kernel, degree) for kernel in pyramid.bank.lobes()]
    # Bilinear lookups of the sharper map, and lookups that stand for an integral, in each step
    assert max(map(error, (sheets[0] for sheets in pyramid.maps), kernels)) < 0.02
    assert error(pyramid.diffuse[0], zonal_coefficients(cosine_lobe(), degree) / np.pi) < 0.01
    assert error(pyramid.diffuse[1], zonal_coefficients(leaning_lobe(), degree)) < 0.01
    # A ring ends at the horizon, and a narrow one is thinner than the kernel that it is made of
    for sheet, width, most in zip(pyramid.rings, WIDTHS, (0.2, 0.08, 0.02), strict=True):
        assert error(sheet, zonal_coefficients(ring_lobe(width), degree)) < most


def test_materials_are_those_of_a_baked_pyramid() -> None:
    equirect = representation("equirect")
    baked = drain(bake_pyramid(sky(equirect.texel_directions(128)[0]), 512)).pyramid
    live = live_pyramid(sky(CUBE.texel_directions(SIZE)))
    rng = np.random.default_rng(3)
    view_dir = normalize(rng.normal(size=(400, 3)))
    normal = normalize(view_dir + 0.6 * rng.normal(size=view_dir.shape))
    seen = np.sum(normal * view_dir, axis=-1) > 0.1
    normal, view_dir = normal[seen], view_dir[seen]
    families = shipped_families()
    for most, inputs in (
        (0.03, {"metallic": 1.0, "roughness": 0.3}),
        (0.03, {"metallic": 1.0, "roughness": 0.55}),
        (0.02, {"base_color": (0.5, 0.05, 0.03), "roughness": 0.4}),
        (0.03, {"base_color": (0.5, 0.05, 0.03), "coat_weight": 1.0, "coat_roughness": 0.25}),
        (0.03, {"specular_level": 0.0, "diffuse_roughness": 1.0}),
        (0.03, {"specular_level": 0.0, "sheen_weight": 1.0, "sheen_roughness": 0.5}),
    ):
        surface = Surface(
            **{
                name: np.broadcast_to(np.asarray(value, np.float64), (len(normal), *np.shape(value)))
                for name, value in inputs.items()
            }
        )
        found, expected = (
            principled_radiance(each, families, surface, normal, view_dir) for each in (live, baked)
        )
        wrong = np.sqrt(np.mean((found - expected) ** 2) / np.mean(expected**2))
        assert wrong < most, inputs


def test_suns_of_lamps_are_in_all_maps_by_the_lobes() -> None:
    """As a baked pyramid has suns of its environment, so that materials reflect both alike."""
    towards = normalize(np.array([[0.2, -0.5, 0.8]]))
    suns = lamp_suns(towards, np.array([[3.0, 2.0, 1.0]]), np.radians(0.5))
    dark, lit = (live_pyramid(np.full((6, SIZE, SIZE, 3), 0.5), each) for each in (NO_SUNS, suns))
    np.testing.assert_array_equal(lit.mirror, dark.mirror)
    for sunless, sheet in zip(lit.sunless, dark.maps, strict=True):
        # What is negligible stays: 1e-8 of the sharpest kernel's peak, of 160 a steradian
        np.testing.assert_allclose(sunless, sheet, rtol=1e-5, atol=1e-5)
    cosine = np.maximum(OCTAHEDRAL.texel_directions(32)[0] @ towards[0], 0.0)[..., None]
    np.testing.assert_allclose(
        lit.diffuse[0] - dark.diffuse[0], cosine / np.pi * suns.irradiance[0], atol=1e-12
    )


def test_a_lamp_s_lobe_is_as_wide_as_the_lamp_or_a_sun_of_an_environment() -> None:
    towards, light = np.array([[0.0, 0.0, 1.0]]), np.ones((1, 3))
    assert lamp_suns(towards, light, 0.0).narrowest == 1.0 / 256.0
    assert lamp_suns(towards, light, 2.0 * np.pi / 256.0).narrowest == pytest.approx(4.0 / 256.0)


def test_small_faces_are_refused() -> None:
    with pytest.raises(RangeError, match=r"^Faces of 16 texels are too small: choose 32 or more\.$"):
        live_maps(16)
