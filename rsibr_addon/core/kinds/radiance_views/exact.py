"""Radiance views of a reflectance model, integrated exactly: the second method of [Cabral1999] section 2."""

from collections.abc import Iterator, Sequence
from math import ceil, pi

import numpy as np

from ...brdf.layered import Sum, is_diffuse, uncoated
from ...brdf.model import Brdf
from ...brdf.principled import Principled
from ...conventions import Array, texel_centres
from ...geometry.lit_sphere import LitSphere, lit_spheres
from ...maps import sphere_map
from ...progress import Steps

ACROSS = 4
"""Points along each side of a texel, whose mean it is."""

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
    """Memory that `exact_maps` takes in light of so many rows."""
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


def narrowest_alpha(brdf: Brdf) -> float:
    """Width of the narrowest lobe of a model that states one; 1 where none does."""
    widths = [1.0]
    for layer in map(uncoated, brdf.layers):
        widths.append(getattr(layer, "alpha", 1.0))
        if isinstance(layer, Principled):
            widths += [layer.roughness**2, layer.coat_roughness**2 if np.any(layer.coat_weight) else 1.0]
    return max(min(widths), 1e-4)


def is_resolved(alpha: float, height: int) -> bool:
    """Whether the sum over texels of light of so many rows is good for a lobe, two texels wide at least."""
    return alpha >= pi / height


def _mean_map(sphere: LitSphere, size: int) -> Array:
    rows = list(_mean_rows(sphere, size))
    return sphere_map.fill_rim(np.stack([row for row, _ in rows]), np.stack([share for _, share in rows]))


def _mean_rows(sphere: LitSphere, size: int) -> Iterator[tuple[Array, Array]]:
    """Of each row of texels the radiance times coverage, and the coverage."""
    points = texel_centres(ACROSS * size, ACROSS * size).reshape(size, ACROSS, size, ACROSS, 2)
    for row in points:
        covered = np.linalg.norm(2.0 * row - 1.0, axis=-1) < 1.0
        seen = sphere.at(sphere_map.normal_from_uv(row) @ sphere.frame.T)
        yield (seen * covered[..., None]).mean(axis=(0, 2)), covered.mean(axis=(0, 2))
