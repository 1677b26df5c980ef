"""Texels of captured views as linear equations of a material's lobes.

The light of a view set is known, so each texel says: its radiance is the sum over lobes and kernels of weight
times the environment filtered with the kernel, along the lobe's axis.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from ..conventions import Array, Indices, texel_centres
from ..geometry.directions import dot, reflect
from ..kinds.radiance_views.views import RadianceViews
from ..maps import sphere_map
from .captured_light import CapturedLight, in_caches
from .fit import lobe_axes

ACROSS, ACROSS_AT_RIM, ACROSS_AT_SUN = 2, 4, 8
"""Points along each side of a texel, of one at the rim, where mirror directions change fastest, and of one
where a sun is mirrored, whose image may be smaller than the texel."""

NEAR_SUN = 2.0
"""Distance from a sun's mirror image, in texels, within which every texel is taken."""

RIM = 0.9
"""Radius from which texels count as the rim's."""

_LEAST_MU = 1e-3


@dataclass(frozen=True)
class CapturedTexels:
    """N texels of captured views, each the mean of some of M points on the sphere.

    Attributes
    ----------
    normal, view_dir : ndarray, shape (M, 3)
        At the points, those of one texel after those of another.
    share : ndarray, shape (M,)
        Weights of the points: those of a texel sum to 1.
    first : ndarray of int, shape (N,)
        Number of each texel's first point.
    view : ndarray of int, shape (N,)
        Number of its view.
    stands_for : ndarray, shape (N,)
        How many texels of the views each of them stands for.
    diffuse, glossy : ndarray, shape (N, 3)
        Captured radiance.
    """

    normal: Array
    view_dir: Array
    share: Array
    first: Indices
    view: Indices
    stands_for: Array
    diffuse: Array
    glossy: Array

    @cached_property
    def mu(self) -> Array:
        """n.v of each point, shape (M,)."""
        mu: Array = np.maximum(dot(self.normal, self.view_dir), _LEAST_MU)
        return mu

    def means(self, values: Array) -> Array:
        """Means over the texels, shape (N, ...), of values at the points, shape (M, ...)."""
        share = self.share.reshape(-1, *[1] * (values.ndim - 1)).astype(values.dtype)
        means: Array = np.add.reduceat(share * values, self.first, axis=0)
        return means

    def power(self, values: Array) -> float:
        """Sum of squares of values, shape (N, 3), over all texels that the N ones stand for."""
        return float(np.sum(self.stands_for[:, None] * values**2))


def captured_texels(views: RadianceViews, count: int, texels: int, suns: Array) -> CapturedTexels:
    """Texels of the first views: evenly spread ones, and all those in which suns are mirrored.

    Parameters
    ----------
    views : RadianceViews
    count : int
        Number of views.
    texels : int
        About how many texels of all of them together, those of suns aside.
    suns : ndarray, shape (n, 3)
        Unit vectors towards suns.
    """
    size = views.size
    centres = texel_centres(size, size).reshape(-1, 2)
    radius = np.linalg.norm(2.0 * centres - 1.0, axis=-1)
    near = _near_suns(views, count, suns, centres) & (radius < 1.0)
    others = np.argwhere(~near & (radius < 1.0))
    spread = others[np.linspace(0, len(others) - 1, min(texels, len(others))).astype(np.intp)]
    view, texel = np.concatenate([spread, np.argwhere(near)]).T
    stands_for = np.where(near[view, texel], 1.0, len(others) / max(len(spread), 1))
    across = np.where(near[view, texel], ACROSS_AT_SUN, np.where(radius[texel] < RIM, ACROSS, ACROSS_AT_RIM))
    # Those of as many points one after another
    order = np.argsort(across, kind="stable")
    view, texel, stands_for, across = view[order], texel[order], stands_for[order], across[order]
    uv, owner = [], []
    for side in np.unique(across):
        own = np.flatnonzero(across == side)
        offsets = (texel_centres(side, side).reshape(-1, 2) - 0.5) / size
        uv.append((centres[texel[own]][:, None] + offsets).reshape(-1, 2))
        owner.append(np.repeat(own, side**2))
    points, owners = np.concatenate(uv), np.concatenate(owner)
    on_sphere = np.linalg.norm(2.0 * points - 1.0, axis=-1) < 1.0
    points, owners = points[on_sphere], owners[on_sphere]
    frames = views.frames[view[owners]]
    return CapturedTexels(
        normal=np.einsum("nij,nj->ni", frames, sphere_map.normal_from_uv(points)),
        view_dir=frames[:, :, 2],
        share=1.0 / np.bincount(owners)[owners],
        first=np.searchsorted(owners, np.arange(len(view))),
        view=view,
        stands_for=stands_for,
        diffuse=views.diffuse.reshape(len(views.diffuse), -1, 3)[view, texel].astype(np.float64),
        glossy=views.glossy.reshape(len(views.glossy), -1, 3)[view, texel].astype(np.float64),
    )


@dataclass(frozen=True)
class Equations:
    """What N texels see along the axes of J lobes, by kernels of which there are K.

    Attributes
    ----------
    below : ndarray of int, shape (N,)
        Number of the elevation below each texel.
    rows : ndarray, shape (N, 2, J * K, 3), float32
        Factors of the weights at the elevation below and at that above, in each channel. A texel that reaches
        beyond both continues the line between them.
    """

    below: Indices
    rows: Array

    def radiance(self, chosen: Array, weights: Array) -> Array:
        """Radiance of some texels, shape (n, 3), for weights of shape (S, J * K, 3)."""
        below = self.below[chosen]
        both = np.stack([weights[below], weights[below + 1]], axis=1)
        radiance: Array = np.einsum("nemc,nemc->nc", self.rows[chosen], both)
        return radiance


def equations_of(texels: CapturedTexels, light: CapturedLight, mu: Array, tilts: Array) -> Equations:
    """The texels' equations of the weights of all kernels about axes of given tilts.

    Parameters
    ----------
    texels : CapturedTexels
    light : CapturedLight
        The environment of the captures.
    mu : ndarray, shape (S,)
        Cosines of the elevations between which tilts and weights are linear.
    tilts : ndarray, shape (S, J)
        See `fit.lobe_axes`.
    """
    position = np.interp(texels.mu, mu, np.arange(len(mu)))
    below = np.minimum(texels.means(position).astype(np.intp), len(mu) - 2)
    above = position - np.repeat(below, np.diff(texels.first, append=len(position)))
    shares = np.stack([1.0 - above, above], axis=1).astype(np.float32)
    rows = [
        texels.means(shares[:, :, None] * filtered[:, None]).reshape(len(below), 2, -1, 3)
        for filtered in _filtered_along(texels, light, mu, tilts)
    ]
    return Equations(below, np.concatenate(rows, axis=2))


def seen_functions(
    texels: CapturedTexels, light: CapturedLight, mu: Array, tilts: Array, weights: Array
) -> Array:
    """What the texels see of functions that are sums of lobes.

    Parameters
    ----------
    texels, light, mu, tilts
        See `equations_of`.
    weights : ndarray, shape (S, J, K, P)
        Weights of the kernels for each of P functions; all channels share them.

    Returns
    -------
    ndarray, shape (N, P, 3)
    """
    position = np.interp(texels.mu, mu, np.arange(len(mu)))
    below = np.minimum(position.astype(np.intp), len(mu) - 2)
    above = (position - below).astype(np.float32)[:, None, None]
    weights = weights.astype(np.float32)
    seen: Array = np.zeros((len(position), weights.shape[-1], 3), dtype=np.float32)
    for lobe, filtered in enumerate(_filtered_along(texels, light, mu, tilts)):
        for some in in_caches(len(seen)):
            own = weights[below[some], lobe]
            own += above[some] * (weights[below[some] + 1, lobe] - own)
            seen[some] += np.swapaxes(own, 1, 2) @ filtered[some].reshape(len(own), -1, 3)
    return texels.means(seen).astype(np.float64)


def _filtered_along(texels: CapturedTexels, light: CapturedLight, mu: Array, tilts: Array) -> Iterator[Array]:
    """The light along the axis of each lobe at the points, shape (M, K * 3), float32."""
    reflect_dir = reflect(texels.view_dir, texels.normal)
    for of_lobe in tilts.T:
        tilt = np.interp(texels.mu, mu, of_lobe)
        yield light.along(
            lobe_axes(texels.normal, reflect_dir, np.stack([tilt, np.zeros_like(tilt)], axis=-1))
        )


def _near_suns(views: RadianceViews, count: int, suns: Array, centres: Array) -> NDArray[np.bool]:
    """Which texels of the first views mirror a sun, or are next to one that does, shape (count, texels)."""
    near = np.zeros((count, len(centres)), dtype=bool)
    for view, frame in enumerate(views.frames[:count]):
        for mirrored in sphere_map.uv_from_direction(suns @ frame):
            near[view] |= np.linalg.norm(centres - mirrored, axis=-1) < NEAR_SUN / views.size
    return near
