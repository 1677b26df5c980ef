"""Radiance views of a reflectance model, integrated exactly: the second method of [Cabral1999] section 2."""

from collections.abc import Sequence
from math import ceil, pi

import numpy as np

from ...brdf.layered import Sum, is_diffuse
from ...brdf.lobe_width import narrowest_alpha
from ...brdf.model import Brdf
from ...conventions import Array, texel_centres
from ...geometry.lit_sphere import LitSphere, lit_spheres
from ...maps import sphere_map
from ...progress import Steps

ACROSS, ACROSS_AT_RIM = 4, 16
"""Points along each side of a texel, whose mean it is, and of one at the rim, which shows many directions."""

RIM = 0.9
"""Radius from which texels count as the rim's."""

AT_ONCE = 1 << 16
"""Points that are looked up at a time, about."""

LEAST_RINGS = 64
"""Fewest rings of points: else two for each row of texels, or across a lobe's width, and one at most for each
row of the light."""


def parts_of(brdf: Brdf) -> tuple[Brdf | None, Brdf | None]:
    """The diffuse and the glossy part of a model, each None where it has none.

    Their sum is the model. One that has no layers, such as a Principled surface or a measurement, is glossy.
    """
    diffuse = tuple(layer for layer in brdf.layers if is_diffuse(layer))
    glossy = tuple(layer for layer in brdf.layers if not is_diffuse(layer))
    return Sum(parts=diffuse) if diffuse else None, Sum(parts=glossy) if glossy else None


def exact_maps(brdf: Brdf, radiance: Array, view_dirs: Sequence[Array], size: int) -> Steps[list[Array]]:
    """Sphere maps of a model, each texel the mean over its area on the sphere.

    Parameters
    ----------
    brdf : Brdf
    radiance : ndarray, shape (height, 2 * height, 3)
        Latitude-longitude map of the environment.
    view_dirs : sequence of ndarray, shape (3,)
    size : int
        Width and height of each map.

    Returns
    -------
    list of ndarray, shape (size, size, 3), float32
        For each view; the corners repeat the rim.
    """
    rings = ring_count(size, len(radiance), narrowest_alpha(brdf))
    spheres = yield from lit_spheres(brdf, radiance, view_dirs, rings)
    return [_mean_map(sphere, size) for sphere in spheres]


def bytes_needed(height: int, views: int, size: int, alpha: float) -> float:
    """Memory [bytes] that `exact_maps` takes; size, height and alpha as in `ring_count`."""
    spectra, spheres = 16.0 * 3 * height * (height + 1), 24.0 * 2 * height * ring_count(size, height, alpha)
    return 3.0 * views * (spectra + spheres)


def ring_count(size: int, height: int, alpha: float) -> int:
    """How many rings of points are integrated.

    Parameters
    ----------
    size : int
        Of the map.
    height : int
        Rows of the light.
    alpha : float
        Width of the narrowest lobe, in normals.
    """
    return max(LEAST_RINGS, min(max(2 * size, ceil(pi / alpha)), height))


def _mean_map(sphere: LitSphere, size: int) -> Array:
    centres = texel_centres(size, size).reshape(-1, 2)
    radius = np.linalg.norm(2.0 * centres - 1.0, axis=-1)
    radiance, coverage = np.zeros((size * size, 3)), np.zeros(size * size)
    for across, chosen in ((ACROSS, radius < RIM), (ACROSS_AT_RIM, radius >= RIM)):
        offsets = (texel_centres(across, across).reshape(-1, 2) - 0.5) / size
        texels = np.flatnonzero(chosen & (radius < 1.0 + 2.0 / size))
        for some in np.array_split(texels, 1 + len(texels) * across**2 // AT_ONCE):
            points = centres[some][:, None] + offsets
            covered = np.linalg.norm(2.0 * points - 1.0, axis=-1) < 1.0
            seen = sphere.at(sphere_map.normal_from_uv(points) @ sphere.frame.T)
            radiance[some] = (seen * covered[..., None]).mean(axis=1)
            coverage[some] = covered.mean(axis=1)
    return sphere_map.fill_rim(radiance.reshape(size, size, 3), coverage.reshape(size, size))
