"""An environment as lamps, each as much of the light as the others: the median cut of [Debevec2005]."""

from dataclasses import dataclass

import numpy as np

from ..conventions import Array, ArrayLike, texel_centres
from ..maps import equirect
from .luminance import luminance


@dataclass(frozen=True)
class Lamps:
    """Distant lamps.

    Attributes
    ----------
    directions : ndarray, shape (n, 3)
        Unit vectors towards them.
    irradiance : ndarray, shape (n, 3)
        What each gives to a plane.
    """

    directions: Array
    irradiance: Array


def lamps_above(radiance: Array, count: int, up: ArrayLike = (0.0, 0.0, 1.0)) -> Lamps:
    """Lamps that light a plane from above as an environment does.

    Parameters
    ----------
    radiance : ndarray, shape (height, 2 * height, 3)
        Latitude-longitude map, not negative.
    count : int
        Most lamps, a power of 2. Fewer are made of light that is in few texels.
    up : array_like, shape (3,)
        The plane's unit normal.

    Returns
    -------
    Lamps
        Their irradiance sums to that of the plane, but for what texels at its horizon lose.

    Notes
    -----
    Regions of the map are cut in two again and again, across their longer side, so that both parts have the
    same luminance on the plane. A lamp stands at its region's middle, weighted by that.
    """
    rows, width = radiance.shape[:2]
    direction = equirect.direction_from_uv(texel_centres(width, rows))
    cosine = np.maximum(direction @ np.asarray(up), 0.0)
    irradiance = radiance * (equirect.texel_solid_angle(width, rows) * cosine)[..., None]
    weight = luminance(irradiance)
    regions = [(slice(0, rows), slice(0, width))]
    for _ in range(count.bit_length() - 1):
        regions = [part for region in regions for part in _halves(weight, direction, region)]
    lit = [region for region in regions if weight[region].any()]
    middles = [np.einsum("ij,ijk->k", weight[region], direction[region]) for region in lit]
    towards = np.array(middles).reshape(-1, 3)
    return Lamps(
        towards / np.linalg.norm(towards, axis=1, keepdims=True),
        np.array([irradiance[region].sum(axis=(0, 1)) for region in lit]).reshape(-1, 3),
    )


def _halves(weight: Array, direction: Array, region: tuple[slice, slice]) -> list[tuple[slice, slice]]:
    """The two parts of a region; the region itself where it has no light or is a single texel."""
    rows, columns = region
    height, width = rows.stop - rows.start, columns.stop - columns.start
    total = weight[region].sum()
    if total == 0.0 or height * width == 1:
        return [region]
    x, y, _ = direction[(rows.start + rows.stop) // 2, columns.start]
    sideways = height == 1 or (width > 1 and width * np.hypot(x, y) > height)
    along = np.cumsum(weight[region].sum(axis=0 if sideways else 1))
    cut = min(int(np.searchsorted(along, 0.5 * total)) + 1, len(along) - 1)
    if sideways:
        at = columns.start + cut
        return [(rows, slice(columns.start, at)), (rows, slice(at, columns.stop))]
    at = rows.start + cut
    return [(slice(rows.start, at), columns), (slice(at, rows.stop), columns)]
