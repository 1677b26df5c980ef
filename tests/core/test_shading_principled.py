"""Principled materials from a pyramid and families: against sums over all texels of their BRDF."""

from dataclasses import replace

import numpy as np
import pytest
from rsibr.rsibr_addon.core.brdf.principled import Principled, Surface
from rsibr.rsibr_addon.core.conventions import Array, texel_centres
from rsibr.rsibr_addon.core.errors import ShapeError
from rsibr.rsibr_addon.core.filtering.prefilter import prefilter_exact
from rsibr.rsibr_addon.core.filtering.radial_lobes import cosine_lobe, von_mises_fisher_lobe
from rsibr.rsibr_addon.core.geometry.directions import camera_frame, reflect
from rsibr.rsibr_addon.core.kinds.kernel_pyramid.bake import bake_pyramid, width_of
from rsibr.rsibr_addon.core.kinds.kernel_pyramid.pyramid import OCTAHEDRAL, Pyramid
from rsibr.rsibr_addon.core.kinds.kernel_pyramid.shading import (
    Families,
    lookup_diffuse,
    principled_radiance,
)
from rsibr.rsibr_addon.core.lobes.family import KERNELS
from rsibr.rsibr_addon.core.maps import equirect
from rsibr.rsibr_addon.core.progress import drain
from rsibr.rsibr_addon.core.resample import lookup
from rsibr.rsibr_addon.files.kinds.kernel_pyramid import shipped_families
from rsibr.rsibr_addon.settings.kernel_pyramid import KernelPyramidSettings

HEIGHT = 128
SIZE = KernelPyramidSettings().size
TEXELS = equirect.direction_from_uv(texel_centres(2 * HEIGHT, HEIGHT))
WINDOW = np.array([0.6, 0.48, 0.64])
MIRRORS_IT = np.array([0.6, 0.48, 1.64]) / np.sqrt(3.28)
NORMAL = np.array([MIRRORS_IT, [0.6, 0.0, 0.8], [-0.48, 0.6, 0.64], [0.8, -0.36, 0.48], [0.0, 0.96, 0.28]])
VIEW = np.broadcast_to([0.0, 0.0, 1.0], NORMAL.shape)


@pytest.fixture(scope="module")
def families() -> Families:
    return shipped_families()


@pytest.fixture(scope="module")
def radiance() -> Array:
    """A dim sky, a bright window 18 degrees wide, a red floor."""
    light = np.where(TEXELS[..., 2:] > 0.0, [0.3, 0.4, 0.6], [0.3, 0.1, 0.05])
    window = np.exp(40.0 * (TEXELS @ WINDOW - 1.0))
    return light + 20.0 * window[..., None] * [1.0, 0.9, 0.7]


@pytest.fixture(scope="module")
def pyramid(radiance: Array) -> Pyramid:
    return drain(bake_pyramid(radiance, SIZE)).pyramid


def summed(material: Principled, radiance: Array, normal: Array, view_dir: Array) -> Array:
    """Radiance of a point as the sum over all texels."""
    frame = camera_frame(normal)
    above = TEXELS @ normal > 0.0
    light = radiance * equirect.texel_solid_angle(2 * HEIGHT, HEIGHT)[..., None]
    light_dir = TEXELS[above] @ frame
    brdf = material(light_dir, view_dir @ frame)
    shown: Array = np.sum(brdf * light_dir[:, 2:] * light[above], axis=0)
    return shown


MATERIALS = {
    "metal": Principled(
        base_color=(0.9, 0.6, 0.3), metallic=1.0, roughness=0.55, specular_tint=(0.6, 0.8, 1.0)
    ),
    "rough metal": Principled(base_color=(0.9, 0.6, 0.3), metallic=1.0, roughness=0.9),
    "plastic": Principled(base_color=(0.5, 0.05, 0.03), ior=1.7, specular_tint=(1.0, 0.5, 0.2)),
    "clay": Principled(base_color=(0.7, 0.5, 0.4), specular_level=0.0, diffuse_roughness=0.8),
    "coated": Principled(
        base_color=(0.5, 0.2, 0.1),
        metallic=0.4,
        coat_weight=0.7,
        coat_roughness=0.5,
        coat_tint=(0.6, 0.8, 1.0),
    ),
    "cloth": Principled(
        base_color=(0.5, 0.05, 0.03), roughness=0.8, sheen_weight=1.0, sheen_tint=(1.0, 0.8, 0.7)
    ),
}


@pytest.mark.parametrize("name", MATERIALS)
def test_materials_are_as_the_sum_over_all_texels(
    name: str, pyramid: Pyramid, families: Families, radiance: Array
) -> None:
    material = MATERIALS[name]
    exact = np.array([summed(material, radiance, *pair) for pair in zip(NORMAL, VIEW, strict=True)])
    shown = principled_radiance(pyramid, families, material.surface, NORMAL, VIEW)
    # What is asked of textured spheres
    assert np.linalg.norm(shown - exact) < 0.03 * np.linalg.norm(exact)


def test_points_have_their_own_materials(pyramid: Pyramid, families: Families) -> None:
    several = [MATERIALS[name] for name in ("metal", "plastic", "clay", "coated", "metal")]
    names = [name for name in Surface.__dataclass_fields__ if hasattr(several[0], name)]
    surface = Surface(**{name: np.array([getattr(each, name) for each in several]) for name in names})
    shown = principled_radiance(pyramid, families, surface, NORMAL, VIEW)
    for number, material in enumerate(several):
        alone = principled_radiance(pyramid, families, material.surface, NORMAL, VIEW)[number]
        np.testing.assert_allclose(shown[number], alone, rtol=1e-12)


@pytest.mark.parametrize("roughness", [0.0, 0.1, 0.3, 0.6, 1.0])
@pytest.mark.parametrize("metallic", [0.0, 1.0])
def test_white_surfaces_vanish_in_a_white_furnace(
    roughness: float, metallic: float, families: Families
) -> None:
    baked = drain(bake_pyramid(np.ones((HEIGHT, 2 * HEIGHT, 3)), SIZE)).pyramid
    # Sums over texels are not quite even near the poles
    furnace = replace(baked, maps=tuple(np.ones_like(sheets) for sheets in baked.maps))
    surface = Surface(base_color=(1.0, 1.0, 1.0), metallic=metallic, roughness=roughness, coat_weight=0.5)
    shown = principled_radiance(furnace, families, surface, NORMAL, VIEW)
    # The family's numbers, and half of what is asked
    np.testing.assert_allclose(shown, 1.0, atol=0.005)


def test_a_mirror_shows_the_environment_itself(pyramid: Pyramid, families: Families) -> None:
    surface = Surface(base_color=(1.0, 1.0, 1.0), metallic=1.0, roughness=0.0)
    shown = principled_radiance(pyramid, families, surface, NORMAL, VIEW)
    mirrored = lookup(pyramid.mirror, reflect(VIEW, NORMAL), OCTAHEDRAL)
    np.testing.assert_allclose(shown, mirrored, rtol=1e-6)


def test_emission_is_added_and_all_is_covered_by_alpha(pyramid: Pyramid, families: Families) -> None:
    dark = principled_radiance(pyramid, families, Surface(), NORMAL, VIEW)
    lit = Surface(emission=(1.0, 2.0, 3.0), alpha=0.25)
    shown = principled_radiance(pyramid, families, lit, NORMAL, VIEW)
    np.testing.assert_allclose(shown, 0.25 * (dark + [1.0, 2.0, 3.0]), rtol=1e-12)


def test_kernels_are_as_large_as_they_need_and_follow_the_sum(pyramid: Pyramid, radiance: Array) -> None:
    assert pyramid.bank.concentrations == KERNELS.concentrations[: len(pyramid.bank)]
    for kappa, sheets in zip(pyramid.bank.concentrations, pyramid.maps, strict=True):
        width = width_of(kappa, 2 * HEIGHT)
        assert sheets.shape == (1, width, width, 3)
        exact = prefilter_exact(radiance, [von_mises_fisher_lobe(kappa)], NORMAL)[0]
        error = np.linalg.norm(pyramid.kernel(kappa, NORMAL) - exact)
        # A kernel of concentration kappa has second derivatives of kappa times its peak, and texels are about
        # sqrt(4 pi) / (16 sqrt(kappa)) wide
        assert error < 0.015 * np.linalg.norm(exact)


def test_diffuse_light_is_the_sum_over_all_texels(pyramid: Pyramid, radiance: Array) -> None:
    exact = prefilter_exact(radiance, [cosine_lobe()], NORMAL)[0] / np.pi
    # On a fold of the octahedron, as the last normal is, lookups are off by what changes in half a texel
    np.testing.assert_allclose(lookup_diffuse(pyramid, NORMAL)[0], exact, rtol=0.01)


def test_a_kernel_that_is_not_resolved_is_the_environment(pyramid: Pyramid) -> None:
    assert pyramid.bank.concentrations[-1] < 16384.0
    shown = pyramid.kernel(16384.0, NORMAL)
    np.testing.assert_array_equal(shown, lookup(pyramid.mirror, NORMAL, OCTAHEDRAL))


def test_kernels_without_maps_are_shared_between_the_mirror_and_the_sharpest_map(
    pyramid: Pyramid, families: Families
) -> None:
    rows, columns = families.ggx.weights.shape[:2]
    count, lobes = len(pyramid.bank), families.ggx.tilts.shape[2]
    weights = np.zeros((rows, columns, lobes, len(KERNELS), 1))
    for number, kappa in enumerate(KERNELS.concentrations):
        weights[:] = 0.0
        weights[..., number, 0] = 3.0
        shown = pyramid.resolved(replace(families.ggx, weights=weights)).weights[0, 0, 0, :, 0]
        assert shown.sum() == pytest.approx(3.0)
        if number < count:
            np.testing.assert_array_equal(shown, weights[0, 0, 0, :, 0])
            continue
        mirror = shown[number] / 3.0
        # A sixth of the squared distance of texels, of the environment and of its map
        variance = ((2.0 * np.pi) ** 2 + 4.0 * np.pi) / (6.0 * pyramid.mirror.shape[1] ** 2)
        mixed = mirror * variance + (1.0 - mirror) / pyramid.bank.concentrations[-1]
        assert mirror == 1.0 if variance > 1.0 / kappa else mixed == pytest.approx(1.0 / kappa)


def test_a_pyramid_for_the_family_fits_into_graphics_memory() -> None:
    texels = sum(width_of(kappa, SIZE) ** 2 for kappa in KERNELS.concentrations[:-1]) + SIZE**2
    assert 8 * texels < 40e6


def test_a_pyramid_that_lacks_a_map_is_refused(pyramid: Pyramid) -> None:
    with pytest.raises(ShapeError, match="a square map for each of its kernels"):
        Pyramid(pyramid.bank, pyramid.mirror, pyramid.maps[1:], pyramid.diffuse, pyramid.rings)
