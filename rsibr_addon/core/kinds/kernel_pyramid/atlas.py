"""All maps of a pyramid in one picture, for graphics cards: few fill the mips of a texture as these are."""

import numpy as np

from ...conventions import Array
from ...lobes.family import KERNELS
from ...resample import bordered
from .pyramid import OCTAHEDRAL, Pyramid


def atlas_texels(pyramid: Pyramid) -> tuple[Array, Array]:
    """The maps as gpu_shaders/lib/pyramid_lib.glsl reads them; those of kernels lack the suns.

    Returns
    -------
    atlas : ndarray, shape (height, width, 4), float32
        Alpha is 1; the width is that of the widest map within its border.
    places : ndarray, shape (1, K + 3 + R, 4), float32
        Left and lower edge of a map, its width and its height, as shares of the atlas: of each of `KERNELS`,
        the mirror, both diffuse ones, and the rings. What the environment does not resolve is where the
        mirror is.
    """
    every = (pyramid.mirror, *pyramid.sunless[::-1], pyramid.rings, pyramid.diffuse)
    sheets = [sheet for sheets in every for sheet in sheets]
    corners, height = _shelves([len(sheet) + 2 for sheet in sheets])
    atlas = np.ones((height, max(map(len, sheets)) + 2, 4), dtype=np.float32)
    for sheet, (left, bottom) in zip(sheets, corners, strict=True):
        size = len(sheet) + 2
        atlas[bottom : bottom + size, left : left + size, :3] = bordered(sheet[None], OCTAHEDRAL)[0]
    mirror, *others = (
        (left + 1, bottom + 1, len(sheet), len(sheet))
        for sheet, (left, bottom) in zip(sheets, corners, strict=True)
    )
    count, rings = len(pyramid.bank), len(pyramid.rings)
    resolved = dict(zip(pyramid.bank.concentrations, others[:count][::-1], strict=True))
    of_kernels = [resolved.get(kappa, mirror) for kappa in KERNELS.concentrations]
    of_normals = [*others[count + rings :], *others[count : count + rings]]
    places = np.array([[*of_kernels, mirror, *of_normals]]) / (2 * atlas.shape[1::-1])
    return atlas, places.astype(np.float32)


def _shelves(widths: list[int]) -> tuple[list[tuple[int, int]], int]:
    """Corners (left, bottom) of squares in rows as wide as the widest, in turn, and the height of all."""
    corners, left, bottom, top = [], 0, 0, 0
    for width in widths:
        if left + width > max(widths):
            left, bottom = 0, top
        corners.append((left, bottom))
        left, top = left + width, max(top, bottom + width)
    return corners, top
