"""Looking maps up between their texels."""

from collections.abc import Callable

import numpy as np

from .conventions import Array, ArrayLike, Indices

type Wrap = Callable[[Indices, Indices, int, int], tuple[Indices, Indices]]
"""`wrap` of a map representation: texel indices beyond the edge to the texels they mean."""


def bilinear(image: Array, uv: ArrayLike, wrap: Wrap, layer: Indices | None = None) -> Array:
    """Bilinear interpolation between texel centres, across the map's seams.

    Parameters
    ----------
    image : ndarray, shape ([layers,] height, width, channels)
        The map, or several of one size; row 0 at the bottom.
    uv : array_like, shape (..., 2)
        Map coordinates.
    wrap : callable
        The map representation's own `wrap`.
    layer : ndarray of int, broadcastable to uv's shape (...,), optional
        Which of several maps to look up.

    Returns
    -------
    ndarray, shape (..., channels), float64

    Notes
    -----
    What graphics hardware does, at full precision: hardware may round the weights to 1/256.
    """
    height, width = image.shape[-3:-1]
    position = np.asarray(uv, dtype=np.float64) * (width, height) - 0.5
    corner = np.floor(position)
    fraction = position - corner
    column, row = corner[..., 0].astype(np.intp), corner[..., 1].astype(np.intp)

    def texel(right: int, up: int) -> Array:
        columns, rows = wrap(column + right, row + up, width, height)
        found: Array = image[rows, columns] if layer is None else image[layer, rows, columns]
        return found.astype(np.float64)

    right, up = fraction[..., :1], fraction[..., 1:]
    bottom = (1.0 - right) * texel(0, 0) + right * texel(1, 0)
    top = (1.0 - right) * texel(0, 1) + right * texel(1, 1)
    return (1.0 - up) * bottom + up * top
