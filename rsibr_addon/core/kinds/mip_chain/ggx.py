"""Mips filtered with GGX lobes, wider for smaller mips: engines shade glossy surfaces from such mips."""

from collections.abc import Callable, Sequence

import numpy as np

from ...conventions import Array
from ...filtering.radial_lobes import ggx_n_dot_l_lobe
from .chain import check_roughness
from .lobe_mips import LobeMips, lobe_mips


def linear_roughness(count: int) -> tuple[float, ...]:
    """Roughness in proportion to the mip's number.

    Parameters
    ----------
    count : int
        Number of mips, at least 1.

    Returns
    -------
    tuple of float
        mip / (count - 1); 0 for a single mip.
    """
    return tuple(mip / max(count - 1, 1) for mip in range(count))


def quadratic_roughness(count: int) -> tuple[float, ...]:
    """Roughness r with 2 r - r^2 in proportion to the mip's number: smaller steps where lobes are narrow.

    1 - sqrt(1 - mip / (count - 1)), else as `linear_roughness`. The rule of Filament and its tool cmgen.
    """
    return tuple(1.0 - float(np.sqrt(1.0 - share)) for share in linear_roughness(count))


ROUGHNESS_RULES: dict[str, Callable[[int], tuple[float, ...]]] = {
    "linear": linear_roughness,
    "quadratic": quadratic_roughness,
}
"""Name -> function from a number of mips to their roughnesses, from 0 to 1."""


def ggx_mips(radiance: Array, size: int, roughness: Sequence[float], degree: int = 0) -> LobeMips:
    """Filter an environment with the GGX lobes that engines filter with: normal = view = mirror direction.

    Parameters
    ----------
    radiance : ndarray, shape (height, 2 * height, 3)
        Latitude-longitude map, not negative.
    size : int
        Width of the first mip's faces in texels, a power of 2.
    roughness : sequence of float
        Roughness of each mip, ascending or equal in [0, 1]. A mip of roughness 0 shows the environment
        itself.
    degree : int
        See `lobe_mips`.

    Raises
    ------
    RangeError
        Size or roughnesses are out of range, or a lobe is too narrow: see `core.filtering.zonal.expand`.

    Notes
    -----
    Radiance times `ggx_n_dot_l_lobe` of alpha = roughness^2, to a relative root-mean-square error of
    `TOLERANCE`: [Karis2013], with the whole sum instead of samples. See `lobe_mips`.
    """
    check_roughness(tuple(roughness), repeated=True)
    lobes = [None if r == 0.0 else ggx_n_dot_l_lobe(r**2) for r in roughness]
    named = [f"roughness {r:.3g}, choose a larger one" for r in roughness]
    return lobe_mips(radiance, size, lobes, named, degree)
