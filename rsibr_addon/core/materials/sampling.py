"""Sampling of images, as Cycles does it; the specification of the shader."""

import numpy as np

from ..conventions import Array, Indices
from .principled import Extension, Input, Texture


def sample(texture: Texture, texels: Array, uv: Array) -> Array:
    """An image's colours at points of a UV map.

    Parameters
    ----------
    texture : Texture
    texels : ndarray, shape (height, width, 4)
        Row 0 at the bottom.
    uv : ndarray, shape (..., 2)

    Returns
    -------
    ndarray, shape (..., 4)
    """
    if texture.covered:
        texels = np.concatenate([texels[..., :3] * texels[..., 3:], texels[..., 3:]], axis=-1)
    height, width = texels.shape[:2]
    a, b, c, d, e, f = texture.mapping
    u, v = uv[..., 0], uv[..., 1]
    x, y = (a * u + b * v + c) * width, (d * u + e * v + f) * height
    if texture.closest:
        return _fetch(texels, np.floor(x).astype(int), np.floor(y).astype(int), texture.extension)
    x, y = x - 0.5, y - 0.5
    left, low = np.floor(x), np.floor(y)
    column, row = left.astype(int), low.astype(int)
    right, high = (x - left)[..., None], (y - low)[..., None]
    corners = [
        [_fetch(texels, column + i, row + j, texture.extension) for i in (0, 1)] for j in (0, 1)
    ]  # [row][column]
    rows = [near + right * (far - near) for near, far in corners]
    sampled: Array = rows[0] + high * (rows[1] - rows[0])
    return sampled


def evaluate(value: Input, texels: Array | None, uv: Array) -> Array:
    """An input's numbers at points of a UV map.

    Parameters
    ----------
    value : Input
    texels : ndarray, shape (height, width, 4), optional
        Those of its texture; None for a constant.
    uv : ndarray, shape (..., 2)

    Returns
    -------
    ndarray, shape (..., n)
    """
    rows = np.array(value.rows)
    if value.texture is None or texels is None:
        return np.broadcast_to(rows[:, 4], (*uv.shape[:-1], len(rows)))
    evaluated: Array = sample(value.texture, texels, uv) @ rows[:, :4].T + rows[:, 4]
    return evaluated


def _fetch(texels: Array, column: Indices, row: Indices, extension: Extension) -> Array:
    height, width = texels.shape[:2]
    found: Array = texels[_inside(row, height, extension), _inside(column, width, extension)]
    if extension == "CLIP":
        is_inside = (column >= 0) & (column < width) & (row >= 0) & (row < height)
        found = np.where(is_inside[..., None], found, 0.0)
    return found


def _inside(index: Indices, size: int, extension: Extension) -> Indices:
    if extension == "REPEAT":
        return index % size
    if extension == "MIRROR":
        place = index % (2 * size)
        return np.minimum(place, 2 * size - 1 - place)
    return np.clip(index, 0, size - 1)
