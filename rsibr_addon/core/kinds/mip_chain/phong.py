"""Mips filtered with Phong's lobes, which [Kautz2004] puts box filters in the place of."""

from collections.abc import Sequence
from itertools import pairwise

import numpy as np

from ...conventions import Array
from ...errors import RangeError
from ...filtering.radial_lobes import phong_lobe
from .lobe_mips import LobeMips, lobe_mips
from .mip_lobes import phong_exponent, texture_space_spread
from .texture_space import box_halved

SHARPEST = 2e5
"""Exponent of the narrowest lobe that mips are filtered with unless told, 0.5 degrees wide."""


def phong_mips(radiance: Array, size: int, exponents: Sequence[float], degree: int = 0) -> LobeMips:
    """Filter an environment with Phong's lobes: [Kautz2004] Eq. 7.

    Parameters
    ----------
    radiance : ndarray, shape (height, 2 * height, 3)
        Latitude-longitude map, not negative.
    size : int
        Width of the first mip's faces in texels, a power of 2.
    exponents : sequence of float
        Exponent of each mip, descending or equal, from 1. A mip whose exponent is infinite shows the
        environment itself.
    degree : int
        See `lobe_mips`.

    Raises
    ------
    RangeError
        Size or exponents are out of range, or a lobe is too narrow.
    """
    check_exponents(tuple(exponents))
    lobes = [None if n == np.inf else phong_lobe(n) for n in exponents]
    named = [f"exponent {n:.6g}, choose a smaller one" for n in exponents]
    return lobe_mips(radiance, size, lobes, named, degree)


def check_exponents(exponents: tuple[float, ...]) -> None:
    """Refuse exponents that no lookup can interpolate.

    Raises
    ------
    RangeError
        They are not descending numbers from 1.
    """
    if not all(n >= 1.0 for n in exponents) or any(n < after for n, after in pairwise(exponents)):
        raise RangeError(
            f"Exponents {', '.join(f'{n:g}' for n in exponents)} do not descend to 1 or more: order them."
        )


def box_exponents(size: int) -> tuple[float, ...]:
    """Phong's exponents whose lobes spread as box filters do: what b is to [Kautz2004], N is to Phong.

    Parameters
    ----------
    size : int
        Width of the first mip's faces in texels, a power of 2.

    Returns
    -------
    tuple of float
        Infinite for mip 0, which is not filtered, and from 1 to `SHARPEST` for the others.
    """
    spreads = texture_space_spread(size, box_halved)[1:]
    return np.inf, *(min(max(phong_exponent(spread), 1.0), SHARPEST) for spread in spreads)
