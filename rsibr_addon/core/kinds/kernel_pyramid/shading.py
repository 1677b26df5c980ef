"""Shading of Principled materials from a pyramid of kernels and families of lobes, without a bake."""

from dataclasses import dataclass

import numpy as np

from ...brdf.bumped_diffuse import bumped_cosine
from ...brdf.fresnel_powers import powers_of
from ...brdf.oren_nayar import bounces, fujii_coefficients
from ...brdf.principled import Layers, Surface, layers_of
from ...conventions import Array, ArrayLike
from ...geometry.directions import dot, normalize, reflect
from ...geometry.sides import seen_surface
from ...lobes.family import Family
from ...lobes.fit import lobe_axes
from ...lobes.rings import SheenTable
from ...resample import lookup
from .pyramid import OCTAHEDRAL, Pyramid

_GRAZING = 1e-4


@dataclass(frozen=True)
class Families:
    """What materials are made of, as `brdf.principled.Albedos`.

    Attributes
    ----------
    ggx : Family
        GGX times each of `fresnel_powers.POWERS`.
    leaning : Family
        `oren_nayar.tilt`, of one width.
    sheen_table : SheenTable
    """

    ggx: Family
    leaning: Family
    sheen_table: SheenTable

    def share(self, alpha: ArrayLike) -> Array:
        """Share of a mirror in a lobe narrower than the family's first: the rest is that one's.

        Parameters
        ----------
        alpha : array_like, shape (...,)
        """
        share: Array = np.clip(1.0 - np.asarray(alpha, dtype=np.float64) / self.ggx.alpha[0], 0.0, 1.0)
        return share

    def powers(self, alpha: Array, mu: Array) -> Array:
        """See `Albedos`."""
        share = self.share(alpha)[..., None]
        mixed: Array = (1.0 - share) * self.ggx.at(self.ggx.albedo, alpha, mu) + share * powers_of(mu)
        return mixed

    def mean(self, alpha: Array) -> Array:
        """See `Albedos`."""
        white = self.ggx.albedo[..., 0] @ self.ggx.mu / np.sum(self.ggx.mu)
        share, rough = self.share(alpha), np.maximum(alpha, self.ggx.alpha[0])
        mixed: Array = (1.0 - share) * np.interp(np.log(rough), np.log(self.ggx.alpha), white) + share
        return mixed

    def sheen(self, roughness: Array, mu: Array) -> Array:
        """See `Albedos`."""
        albedo: Array = self.sheen_table.at(roughness, mu).sum(axis=-1)
        return albedo


def principled_radiance(
    pyramid: Pyramid,
    families: Families,
    surface: Surface,
    normal: ArrayLike,
    view_dir: ArrayLike,
    facet: ArrayLike | None = None,
    coat_normal: ArrayLike | None = None,
    smooth_normal: ArrayLike | None = None,
) -> Array:
    """Radiance of surface points of Principled materials.

    Parameters
    ----------
    pyramid : Pyramid
    families : Families
    surface : Surface
        Inputs of the material, the same for all points or each point's own.
    normal, view_dir : array_like, shape (N, 3)
        Unit vectors in world coordinates.
    facet : array_like, shape (N, 3), optional
        Unit normals of the facets: see `core.kinds`.
    coat_normal : array_like, shape (N, 3), optional
        Unit vectors; the coat's normals where they are not `normal`.
    smooth_normal : array_like, shape (N, 3), optional
        Unit vectors; the surface's own normals where `normal` is bumped.

    Returns
    -------
    ndarray, shape (N, 3), float64
        Covered by `surface.alpha`: what is behind is to be added with the rest.

    Notes
    -----
    GLSL twin: gpu_shaders/lib/principled_radiance_lib.glsl `principled_radiance`, within 2e-3 of the
    brightest from half floats.
    """
    normal, view_dir = np.asarray(normal, np.float64), np.asarray(view_dir, np.float64)
    seen = seen_surface(normal, view_dir, facet)
    mu = np.clip(dot(seen.mirror_normal, view_dir), _GRAZING, 1.0)
    coat_normal = (
        seen.mirror_normal
        if coat_normal is None
        else seen_surface(coat_normal, view_dir, facet).mirror_normal
    )
    coat_mu = np.clip(dot(coat_normal, view_dir), _GRAZING, 1.0)
    # Fibres stand on base and coat alike
    coated = np.clip(np.asarray(surface.coat_weight, np.float64), 0.0, 1.0)[..., None]
    sheen_normal = normalize(seen.normal + coated * (coat_normal - seen.normal))
    sheen_mu = np.clip(dot(sheen_normal, view_dir), 0.0, 1.0)
    layers = layers_of(surface, mu, families, coat_mu, sheen_mu)
    own_mu = np.clip(dot(seen.normal, view_dir), _GRAZING, 1.0)
    smooth = seen.normal if smooth_normal is None else seen_surface(smooth_normal, view_dir, facet).normal
    diffuse = _diffuse(pyramid, families.leaning, surface, layers, seen.normal, smooth, view_dir, own_mu)
    radiance = layers.emission + diffuse
    radiance += layers.sheen * _sheen(pyramid, families.sheen_table, surface, sheen_normal, sheen_mu)
    for roughness, coefficients, layer_normal in (
        (surface.roughness, layers.base, seen.mirror_normal),
        (surface.coat_roughness, layers.coat, coat_normal),
    ):
        reflects = np.any(coefficients, axis=(-2, -1))
        alpha = np.broadcast_to(np.square(roughness), mu.shape)[reflects]
        radiance[reflects] += _glossy(
            pyramid, families, alpha, coefficients[reflects], layer_normal[reflects], view_dir[reflects]
        )
    return radiance


def _glossy(
    pyramid: Pyramid, families: Families, alpha: Array, coefficients: Array, normal: Array, view_dir: Array
) -> Array:
    """GGX, shape (N, 3); 0 where signed lobes sum to less."""
    mirror_dir, mu = reflect(view_dir, normal), dot(normal, view_dir)
    share = families.share(alpha)
    rough = (1.0 - share)[:, None, None] * coefficients
    radiance = _lobes(pyramid, families.ggx, alpha, mu, rough, normal, mirror_dir)
    suns = pyramid.suns
    of_suns = suns.mirror_share(alpha)
    mirrors = (share > 0.0) | (of_suns > 0.0)
    factor = np.einsum("nc,nci->ni", powers_of(mu[mirrors]), coefficients[mirrors])
    shown = lookup(pyramid.mirror, mirror_dir[mirrors], OCTAHEDRAL)
    below = np.minimum(shown, suns.ceiling)
    shown = share[mirrors, None] * below + of_suns[mirrors, None] * (shown - below)
    radiance[mirrors] += factor * shown
    return np.maximum(radiance, 0.0) + suns.glossy(alpha, coefficients, normal, view_dir)


def _lobes(
    pyramid: Pyramid,
    family: Family,
    alpha: Array,
    mu: Array,
    coefficients: Array,
    normal: Array,
    mirror_dir: Array,
) -> Array:
    """The sum of a family's lobes, shape (N, 3); kernels without weight are not looked up."""
    family = pyramid.resolved(family)
    weights = np.einsum("njkc,nci->njki", family.at(family.weights, alpha, mu), coefficients)
    tilts = family.at(family.tilts, alpha, mu)
    offsets = np.stack([tilts, np.zeros_like(tilts)], axis=-1)
    axes = lobe_axes(normal[:, None], mirror_dir[:, None], offsets)
    radiance = np.zeros(normal.shape)
    for lobe in range(tilts.shape[1]):
        for number, kappa in enumerate(family.bank.concentrations):
            weight = weights[:, lobe, number]
            counts = np.any(weight, axis=1)
            radiance[counts] += weight[counts] * pyramid.kernel(kappa, axes[counts, lobe])
    return radiance


def _diffuse(
    pyramid: Pyramid,
    leaning: Family,
    surface: Surface,
    layers: Layers,
    normal: Array,
    smooth_normal: Array,
    view_dir: Array,
    mu: Array,
) -> Array:
    """Oren and Nayar's reflection, shape (N, 3): see `brdf.principled.diffuse_brdf`."""
    color, roughness = np.maximum(surface.base_color, 0.0), np.asarray(surface.diffuse_roughness, np.float64)
    a, b = (np.broadcast_to(value, mu.shape)[:, None] for value in fujii_coefficients(roughness))
    again = np.broadcast_to(bounces(color, roughness, mu), normal.shape)
    axis, share = bumped_cosine(normal, smooth_normal)
    white, leant = lookup_diffuse(pyramid, axis)
    radiance = (a + again * (1.0 - np.pi * a)) * np.pi * white - again * b * leant
    is_rough = b[:, 0] > 0.0
    axes = normal[is_rough], reflect(view_dir, normal)[is_rough]
    ones = np.ones((np.count_nonzero(is_rough), 1, 3))
    radiance[is_rough] += b[is_rough] * _lobes(
        pyramid, leaning, np.ones(len(ones)), mu[is_rough], ones, *axes
    )
    of_suns = pyramid.suns.leaning(mu[is_rough], normal[is_rough], view_dir[is_rough])
    radiance[is_rough] += b[is_rough] * of_suns
    return layers.diffuse * color * share[:, None] * np.maximum(radiance, 0.0)


def _sheen(pyramid: Pyramid, table: SheenTable, surface: Surface, normal: Array, mu: Array) -> Array:
    """White sheen, shape (N, 3)."""
    weights = table.at(surface.sheen_roughness, mu)
    maps = (pyramid.diffuse[0], *pyramid.rings)
    shown = np.stack([lookup(sheet[None], normal, OCTAHEDRAL) for sheet in maps], axis=1)
    radiance: Array = np.einsum("nr,nri->ni", weights, shown)
    return radiance


def lookup_diffuse(pyramid: Pyramid, normal: Array) -> tuple[Array, Array]:
    """Both of `Pyramid.diffuse` towards normals, shapes (N, 3)."""
    both = [lookup(sheet[None], normal, OCTAHEDRAL) for sheet in pyramid.diffuse]
    return both[0], both[1]
