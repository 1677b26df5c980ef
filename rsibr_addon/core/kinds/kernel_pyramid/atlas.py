"""All maps of a pyramid in one picture, for graphics cards: few fill the mips of a texture as these are."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ...conventions import Array
from ...lobes.bank import KernelBank
from ...lobes.family import KERNELS
from ...lobes.rings import WIDTHS
from ...resample import bordered
from .pyramid import OCTAHEDRAL, Pyramid


@dataclass(frozen=True, eq=False)
class AtlasLayout:
    """Where the maps of a pyramid lie, each within a border of one texel.

    Attributes
    ----------
    corners : list of (int, int)
        Left and lower edge of the borders, in the order of `Pyramid.all_maps`.
    width, height : int
        Of the whole, in texels.
    places : ndarray, shape (1, K + 3 + R, 4), float32
        Left and lower edge of a map, its width and its height, as shares of the whole: of each of `KERNELS`,
        the mirror, both diffuse ones, and the rings. What is not resolved is where the mirror is.
    """

    corners: list[tuple[int, int]]
    width: int
    height: int
    places: Array


def atlas_layout(widths: Sequence[int], bank: KernelBank) -> AtlasLayout:
    """Where maps of some widths are placed.

    Parameters
    ----------
    widths : sequence of int
        In the order of `Pyramid.all_maps`.
    bank : KernelBank
        The kernels among them.
    """
    corners, height = _shelves([width + 2 for width in widths])
    width = max(widths) + 2
    mirror, *others = (
        (left + 1, bottom + 1, size, size) for size, (left, bottom) in zip(widths, corners, strict=True)
    )
    count, rings = len(bank), len(WIDTHS)
    resolved = dict(zip(bank.concentrations, others[:count][::-1], strict=True))
    of_kernels = [resolved.get(kappa, mirror) for kappa in KERNELS.concentrations]
    of_normals = [*others[count + rings :], *others[count : count + rings]]
    places = np.array([[*of_kernels, mirror, *of_normals]]) / (2 * (width, height))
    return AtlasLayout(corners, width, height, places.astype(np.float32))


def atlas_texels(pyramid: Pyramid) -> tuple[Array, Array]:
    """The maps as gpu_shaders/lib/pyramid_lib.glsl reads them; those of kernels lack the suns.

    Returns
    -------
    atlas : ndarray, shape (height, width, 4), float32
        Alpha is 1.
    places : ndarray, shape (1, K + 3 + R, 4), float32
        See `AtlasLayout`.
    """
    every = (pyramid.mirror, *pyramid.sunless[::-1], pyramid.rings, pyramid.diffuse)
    sheets = [sheet for sheets in every for sheet in sheets]
    layout = atlas_layout([len(sheet) for sheet in sheets], pyramid.bank)
    atlas = np.ones((layout.height, layout.width, 4), dtype=np.float32)
    for sheet, (left, bottom) in zip(sheets, layout.corners, strict=True):
        size = len(sheet) + 2
        atlas[bottom : bottom + size, left : left + size, :3] = bordered(sheet[None], OCTAHEDRAL)[0]
    return atlas, layout.places


def _shelves(widths: list[int]) -> tuple[list[tuple[int, int]], int]:
    """Corners (left, bottom) of squares in rows as wide as the widest, in turn, and the height of all."""
    corners, left, bottom, top = [], 0, 0, 0
    for width in widths:
        if left + width > max(widths):
            left, bottom = 0, top
        corners.append((left, bottom))
        left, top = left + width, max(top, bottom + width)
    return corners, top
