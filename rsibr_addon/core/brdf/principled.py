"""Cycles' Principled BSDF, without transmission, subsurface, anisotropy and thin film.

Sheen lies over a coat, and that over a metal or over a dielectric boundary above a diffuse base. Each layer
leaves what it does not reflect to a view for the layers below, by its directional albedo. Light that bounces
between microfacets is added to GGX by a factor of the single bounce [Kulla2017].
"""

from dataclasses import dataclass
from functools import cache, cached_property
from typing import Annotated, ClassVar, Protocol

import numpy as np

from ..conventions import Array, ArrayLike
from .albedo import hemisphere_quadrature
from .fresnel_powers import dielectric, edge_of, powers_of, rise, schlick
from .ggx import ggx_ndf, smith_visibility
from .layered import COAT_ELEVATIONS
from .model import Brdf, Geometry
from .oren_nayar import bounces, fujii_coefficients, leaning_albedo, tilt
from .parameters import Color, Range
from .sheen_polynomials import sheen_at, sheen_brdf

LARGEST = 1e9
"""Greatest factor of what a tinted coat leaves: at grazing, tints above 1 pass all bounds, as Cycles' do."""


class Albedos(Protocol):
    """Directional albedos of GGX and of sheen."""

    def powers(self, alpha: Array, mu: Array) -> Array:
        """Those of GGX times each of `POWERS`, shape (..., C), for alpha and mu in [0, 1], shape (...,)."""
        ...

    def mean(self, alpha: Array) -> Array:
        """Twice the integral of a white metal's times mu, from 0 to 1, for alpha in [0, 1], shape (...,)."""
        ...

    def sheen(self, roughness: Array, mu: Array) -> Array:
        """Those of white sheen for roughness and mu in [0, 1], all of shape (...,)."""
        ...


@dataclass(frozen=True)
class Surface:
    """Inputs of the Principled BSDF at surface points; the defaults are Blender's.

    Attributes
    ----------
    base_color, specular_tint, coat_tint, sheen_tint, emission : array_like, shape (..., 3)
        In linear Rec. 709. `emission` is colour times strength.
    metallic, roughness, ior, specular_level, diffuse_roughness : array_like, shape (...,)
    coat_weight, coat_roughness, coat_ior : array_like, shape (...,)
        Indices of at least 1.
    sheen_weight, sheen_roughness : array_like, shape (...,)
    alpha : array_like, shape (...,)
        Coverage.
    """

    base_color: ArrayLike = (0.8, 0.8, 0.8)
    metallic: ArrayLike = 0.0
    roughness: ArrayLike = 0.5
    ior: ArrayLike = 1.5
    alpha: ArrayLike = 1.0
    diffuse_roughness: ArrayLike = 0.0
    specular_level: ArrayLike = 0.5
    specular_tint: ArrayLike = (1.0, 1.0, 1.0)
    coat_weight: ArrayLike = 0.0
    coat_roughness: ArrayLike = 0.03
    coat_ior: ArrayLike = 1.5
    coat_tint: ArrayLike = (1.0, 1.0, 1.0)
    sheen_weight: ArrayLike = 0.0
    sheen_roughness: ArrayLike = 0.5
    sheen_tint: ArrayLike = (1.0, 1.0, 1.0)
    emission: ArrayLike = (0.0, 0.0, 0.0)


@dataclass(frozen=True)
class Layers:
    """What a surface is made of, seen from one side.

    Attributes
    ----------
    coat, base : ndarray, shape (..., C, 3)
        GGX of the coat's roughness, and of the surface's own: coefficients of `POWERS`.
    diffuse : ndarray, shape (..., 3)
        Factor of the diffuse reflection of `base_color`.
    emission : ndarray, shape (..., 3)
        Radiance.
    sheen : ndarray, shape (..., 3)
        Factor of white sheen.
    """

    coat: Array
    base: Array
    diffuse: Array
    emission: Array
    sheen: Array


def layers_of(
    surface: Surface,
    mu: ArrayLike,
    albedos: Albedos,
    coat_mu: ArrayLike | None = None,
    sheen_mu: ArrayLike | None = None,
) -> Layers:
    """Shares of a surface's layers towards a view.

    Parameters
    ----------
    surface : Surface
    mu : array_like, shape (...,)
        n.v, in (0, 1].
    albedos : Albedos
    coat_mu : array_like, shape (...,), optional
        n.v of a coat that has a normal of its own.
    sheen_mu : array_like, shape (...,), optional
        n.v of the sheen's normal, which is between the others'.
    """
    mu = np.asarray(mu, dtype=np.float64)
    sheen, left = _sheen(surface, mu if sheen_mu is None else np.asarray(sheen_mu, np.float64), albedos)
    coat, below = _coat(surface, mu if coat_mu is None else np.asarray(coat_mu, np.float64), albedos)
    metallic = np.clip(np.asarray(surface.metallic, np.float64), 0.0, 1.0)[..., None]
    plastic, reflected = _plastic(surface, mu, albedos)
    base = metallic[..., None] * _metal(surface, mu, albedos) + (1.0 - metallic[..., None]) * plastic
    covered = np.clip(np.asarray(surface.alpha, np.float64), 0.0, 1.0)[..., None]
    below = covered * left * below
    return Layers(
        (covered * left)[..., None] * coat,
        below[..., None, :] * base,
        below * (1.0 - metallic) * _left(reflected),
        below * np.asarray(surface.emission, np.float64),
        covered * sheen,
    )


def _sheen(surface: Surface, mu: Array, albedos: Albedos) -> tuple[Array, Array]:
    """The factor of white sheen, shape (..., 3), and what it leaves for what is below, shape (..., 1)."""
    weight = np.maximum(np.asarray(surface.sheen_weight, np.float64), 0.0)[..., None]
    factor = weight * np.maximum(np.asarray(surface.sheen_tint, np.float64), 0.0)
    albedo = albedos.sheen(np.asarray(surface.sheen_roughness, np.float64), mu)[..., None]
    return factor, _left(factor * albedo)


def _coat(surface: Surface, mu: Array, albedos: Albedos) -> tuple[Array, Array]:
    """The coat's coefficients, and what it leaves for what is below, shape (..., 3)."""
    index = np.maximum(np.asarray(surface.coat_ior, np.float64), 1.0)
    weight = np.clip(np.asarray(surface.coat_weight, np.float64), 0.0, 1.0)[..., None]
    glass = dielectric(index)[..., None] * np.ones(3)
    mean = dielectric_mean(index)[..., None]
    coat, reflected = _bounced(glass, mean, surface.coat_roughness, mu, albedos)
    # The view's refracted way through the coat, whose depth is 1
    way = 1.0 / np.sqrt(1.0 - (1.0 - mu**2) / index**2)
    with np.errstate(over="ignore"):
        through = np.maximum(np.asarray(surface.coat_tint, np.float64), 0.0) ** way[..., None]
    through = np.minimum(through, LARGEST)
    return weight[..., None] * coat, _left(weight * reflected) * (1.0 - weight + weight * through)


def _metal(surface: Surface, mu: Array, albedos: Albedos) -> Array:
    """A metal's coefficients."""
    tint = np.clip(np.asarray(surface.specular_tint, np.float64), 0.0, 1.0)
    f0 = np.clip(np.asarray(surface.base_color, np.float64), 0.0, 1.0)
    edge = edge_of(f0, tint)
    # Means over a hemisphere of uniform light: (1 - c)^5 has 1 / 21, c (1 - c)^6 has 1 / 126
    mean = f0 + (1.0 - f0) / 21.0 - edge / 126.0
    return _bounced(np.moveaxis(schlick(f0, edge), -1, -2), mean, surface.roughness, mu, albedos)[0]


def _plastic(surface: Surface, mu: Array, albedos: Albedos) -> tuple[Array, Array]:
    """Coefficients of the boundary over the diffuse base, and its albedo, shape (..., 3)."""
    index = np.maximum(np.asarray(surface.ior, np.float64), 1.0)
    level = np.maximum(np.asarray(surface.specular_level, np.float64), 0.0)
    amplitude = np.minimum((index - 1.0) / (index + 1.0) * np.sqrt(2.0 * level), 0.99)
    f0 = (amplitude**2)[..., None]
    tinted = f0 * np.clip(np.asarray(surface.specular_tint, np.float64), 0.0, 1.0)
    coefficients = rise(amplitude)[..., None] * (1.0 - tinted)[..., None, :]
    coefficients[..., 0, :] += tinted
    mean = dielectric_mean((1.0 + amplitude) / (1.0 - amplitude))[..., None]
    risen = np.clip((mean - f0) / (1.0 - f0), 0.0, 1.0)
    return _bounced(coefficients, tinted + (1.0 - tinted) * risen, surface.roughness, mu, albedos)


def dielectric_mean(index: ArrayLike) -> Array:
    """Mean reflectance of a dielectric under uniform light [Kulla2017].

    Parameters
    ----------
    index : array_like, shape (...,)
        At least 1.

    Returns
    -------
    ndarray, shape (...,), float64
        In [0, 1).
    """
    index = np.asarray(index, dtype=np.float64)
    mean: Array = (index - 1.0) / (4.08567 + 1.00071 * index)
    return mean


def _bounced(
    coefficients: Array, mean: Array, roughness: ArrayLike, mu: Array, albedos: Albedos
) -> tuple[Array, Array]:
    """A lobe with the light that bounces between its facets [Kulla2017], and its albedo, shape (..., 3).

    Each bounce meets the mean reflectance; Cycles scales the single bounce, which it leaves in shape.
    """
    alpha = np.square(roughness)
    single = albedos.powers(alpha, mu)
    white, white_mean = single[..., :1], albedos.mean(alpha)[..., None]
    again = mean * white_mean / (1.0 - mean * (1.0 - white_mean))
    gain = 1.0 + again * (1.0 - white) / white
    return coefficients * gain[..., None, :], gain * np.einsum("...c,...ci->...i", single, coefficients)


def _left(reflected: Array) -> Array:
    """What a layer leaves for those below: as much of every colour."""
    left: Array = np.clip(1.0 - reflected.max(axis=-1, keepdims=True), 0.0, 1.0)
    return left


@dataclass(frozen=True, kw_only=True)
class Principled(Brdf):
    """One material of Cycles' Principled BSDF: see `Surface`.

    It is not reciprocal, as Cycles' is not: layers take what the view's side reflects, not the light's.
    """

    model: ClassVar[str] = "principled"
    base_color: Annotated[Color, Range(0.0, 1.0)] = 0.8
    metallic: Annotated[float, Range(0.0, 1.0)] = 0.0
    roughness: Annotated[float, Range(0.0, 1.0, low_open=True)] = 0.5
    ior: Annotated[float, Range(1.0, 100.0)] = 1.5
    diffuse_roughness: Annotated[float, Range(0.0, 1.0)] = 0.0
    specular_level: Annotated[float, Range(0.0, 10.0)] = 0.5
    specular_tint: Annotated[Color, Range(0.0, 1.0)] = 1.0
    coat_weight: Annotated[float, Range(0.0, 1.0)] = 0.0
    coat_roughness: Annotated[float, Range(0.0, 1.0, low_open=True)] = 0.03
    coat_ior: Annotated[float, Range(1.0, 4.0)] = 1.5
    coat_tint: Annotated[Color, Range(0.0, 1.0)] = 1.0
    sheen_weight: Annotated[float, Range(0.0, 1.0)] = 0.0
    sheen_roughness: Annotated[float, Range(0.0, 1.0)] = 0.5
    sheen_tint: Annotated[Color, Range(0.0, 1.0)] = 1.0

    @cached_property
    def surface(self) -> Surface:
        """The material as arrays."""
        names = (name for name in Surface.__dataclass_fields__ if hasattr(self, name))
        return Surface(**{name: np.array(getattr(self, name)) for name in names})

    def above_horizon(self, geometry: Geometry) -> Array:
        """See `Brdf`."""
        mu = geometry.n_dot_v
        layers = layers_of(self.surface, mu, ExactAlbedos())
        found = layers.diffuse * diffuse_brdf(self.surface, geometry)
        for coefficients, roughness in ((layers.base, self.roughness), (layers.coat, self.coat_roughness)):
            found += np.einsum("nc,nci->ni", ggx_by_powers(geometry, roughness**2), coefficients)
        if self.sheen_weight:
            found += layers.sheen * sheen_brdf(self.sheen_roughness, geometry)[:, None]
        return found


def diffuse_brdf(surface: Surface, geometry: Geometry) -> Array:
    """Oren and Nayar's reflection of a base colour, shape (N, 3) [1/sr]."""
    color = np.asarray(surface.base_color, dtype=np.float64)
    a, b = fujii_coefficients(surface.diffuse_roughness)
    leaning = tilt(geometry.n_dot_l, geometry.n_dot_v, geometry.l_dot_v)
    lost = 1.0 - np.pi * a - b * leaning_albedo(geometry.n_dot_l)
    again = bounces(color, surface.diffuse_roughness, geometry.n_dot_v) * lost[:, None]
    found: Array = color * ((a + b * leaning)[:, None] + again)
    return found


def ggx_by_powers(geometry: Geometry, alpha: float) -> Array:
    """GGX of alpha in (0, 1], without a Fresnel term, times each of `POWERS`, shape (N, C) [1/sr]."""
    facets = ggx_ndf(geometry.half_sine_squared, alpha)
    facets = facets * smith_visibility(geometry.n_dot_l, geometry.n_dot_v, alpha)
    return facets[:, None] * powers_of(geometry.h_dot_l)


class ExactAlbedos:
    """Albedos of `Principled`, of one width at a time.

    Those of GGX come by quadrature, and are interpolated between `COAT_ELEVATIONS`.
    """

    def powers(self, alpha: Array, mu: Array) -> Array:
        """See `Albedos`."""
        table = _exact_albedo(float(alpha))
        return np.stack([np.interp(mu, COAT_ELEVATIONS, column) for column in table.T], axis=-1)

    def mean(self, alpha: Array) -> Array:
        """See `Albedos`."""
        node, weight = np.polynomial.legendre.leggauss(32)
        mu = 0.5 * (node + 1.0)
        return np.asarray(weight @ (mu * self.powers(alpha, mu)[:, 0]))

    def sheen(self, roughness: Array, mu: Array) -> Array:
        """See `Albedos`."""
        return sheen_at(float(roughness), mu).albedo


@cache
def _exact_albedo(alpha: float) -> Array:
    """Albedos of GGX times each of `POWERS` at `COAT_ELEVATIONS`, shape (33, C)."""
    rows = []
    for mu in np.maximum(COAT_ELEVATIONS, 1e-4).tolist():
        light_dir, weight = hemisphere_quadrature(mu)
        pairs = Geometry(*np.broadcast_arrays(light_dir, [np.sqrt(1.0 - mu**2), 0.0, mu]))
        rows.append((weight * light_dir[:, 2]) @ ggx_by_powers(pairs, alpha))
    return np.array(rows)
