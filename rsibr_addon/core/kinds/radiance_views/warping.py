"""The warps of radiance views, what each carries, and which of them to take."""

from collections.abc import Mapping
from enum import StrEnum

import numpy as np

from ...conventions import Array
from ...geometry.reflection_warp import Warp
from ...maps import sphere_map
from ...resample import bilinear
from ...ties import first_greatest


class Warping(StrEnum):
    """The warp of each part of radiance.

    SINGLE warps the whole radiance by the mirror direction. SPLIT warps diffuse radiance by the normal and
    glossy by the mirror direction. ALBEDO is SPLIT of radiance divided by directional albedo: a source saw a
    direction at another angle than the fragment does, and albedo tells the effect of Fresnel's equations
    without a picture.
    """

    SINGLE = "single"
    SPLIT = "split"
    ALBEDO = "albedo"


class WarpChoice(StrEnum):
    """A `Warping` of the same name, or the one that predicts captured views best."""

    AUTO = "auto"
    ALBEDO = "albedo"
    SPLIT = "split"
    SINGLE = "single"


LEAST_ALBEDO = 1e-3
"""Added to albedo before it divides, so that black from everywhere stays black, with its noise."""


def chosen_warping(choice: WarpChoice, left_out: Mapping[Warping, float]) -> Warping:
    """The warp that a choice stands for.

    Parameters
    ----------
    choice : WarpChoice
    left_out : mapping of Warping to float
        See `RadianceViews.left_out`.

    Returns
    -------
    Warping
        Where no errors are known, AUTO is ALBEDO.
    """
    if choice is not WarpChoice.AUTO:
        return Warping(choice)
    if not left_out:
        return Warping.ALBEDO
    return list(left_out)[first_greatest(-np.array(list(left_out.values())))]


def carried(diffuse: Array, glossy: Array, warping: Warping) -> dict[Warp, Array]:
    """What each warp carries; a single warp carries nothing by the normal.

    Parameters
    ----------
    diffuse, glossy : ndarray, shape (..., 3)
        Radiance of views, of equal shapes: their maps, or what was looked up in them.
    warping : Warping

    Returns
    -------
    dict of Warp to ndarray
        Of the same shape.
    """
    if warping is Warping.SINGLE:
        return {Warp.MIRROR: diffuse + glossy}
    return {Warp.NORMAL: diffuse, Warp.MIRROR: glossy}


def albedo_table(albedo: Array, warping: Warping) -> Array:
    """The table to divide and multiply by, shape (2, M, 3); ones without albedo.

    Parameters
    ----------
    albedo : ndarray, shape (2, M, 3)
        See `RadianceViews.albedo`.
    warping : Warping
    """
    return albedo + LEAST_ALBEDO if warping is Warping.ALBEDO else np.ones((2, 1, 3))


def albedo_at(table: Array, warp: Warp, cosine: Array) -> Array:
    """The row of a warp in a table of albedo, interpolated.

    Parameters
    ----------
    table : ndarray, shape (2, M, 3)
        See `albedo_table`.
    warp : Warp
    cosine : ndarray, shape (...,)
        Between normal and view, in [0, 1].

    Returns
    -------
    ndarray, shape (..., 3)
    """
    row = 0.25 if warp is Warp.NORMAL else 0.75
    return bilinear(table, np.stack([cosine, np.full_like(cosine, row)], axis=-1), sphere_map.wrap)
