"""How wide the lobe of each mip is, and so which mip shows a roughness or an exponent.

Lobes of different shapes are held alike where their spread is: 1 less the mean cosine between a lobe's axis
and its light. Between two mips a lookup mixes their lobes, and the spread of a mixture is that of its parts,
mixed alike.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from ...conventions import Array
from ...errors import RangeError
from ...filtering.radial_lobes import ggx_n_dot_l_lobe
from ...filtering.zonal import zonal_coefficients
from ...light.lamps import directions_in_cap
from ...maps.representation import representation
from ...resample import lookup
from .texture_space import filtered_mips

_CUBE = representation("cube_map")
_DIRECTIONS = 4096


@dataclass(frozen=True)
class MipLobes:
    """How wide the lobe of each mip is.

    Attributes
    ----------
    count : int
        Number of mips.
    roughness : tuple of float, or None
        Of a chain of GGX lobes: see `MipChain`.
    spread : tuple of float, or None
        Ascending: see `MipChain`. That of GGX lobes follows from their roughness.
    """

    count: int
    roughness: tuple[float, ...] | None = None
    spread: tuple[float, ...] | None = None

    def level_of_roughness(self, roughness: float) -> float:
        """The level of detail that shows a GGX lobe.

        Parameters
        ----------
        roughness : float
            In [0, 1]; beyond those of the first or last mip, that mip is used.

        Returns
        -------
        float
            In [0, count - 1]. In a GGX chain linear between the mips' roughnesses, as engines have it; in
            others where the spread is that of the lobe.

        Raises
        ------
        RangeError
            The chain states neither roughness nor spread, as files of version 0.1.
        """
        if self.roughness is not None:
            return float(np.interp(roughness, self.roughness, np.arange(self.count)))
        return self._level_of_spread(ggx_spread(roughness))

    def level_of_exponent(self, exponent: float) -> float:
        """The level of detail whose spread is that of Phong's lobe; `exponent` is at least 1.

        Raises
        ------
        RangeError
            See `level_of_roughness`.
        """
        return self._level_of_spread(phong_spread(exponent))

    def _level_of_spread(self, spread: float) -> float:
        spreads = self.spread
        if self.roughness is not None:
            spreads = tuple(map(ggx_spread, self.roughness))
        if spreads is None:
            raise RangeError(
                "This mip chain does not say how blurred its mips are: bake it again, or choose a mip."
            )
        return float(np.interp(spread, spreads, np.arange(self.count)))


@lru_cache(maxsize=256)
def ggx_spread(roughness: float) -> float:
    """Spread of the GGX lobe that mips are filtered with, in [0, 1/3]; `roughness` is in [0, 1]."""
    # So narrow a lobe has no width in double precision
    if roughness < 1e-4:
        return 0.0
    return float(1.0 - zonal_coefficients(ggx_n_dot_l_lobe(roughness**2), 1)[1])


def phong_spread(exponent: float) -> float:
    """Spread of Phong's lobe cos^n, 1 / (n + 2), in (0, 1/2]; the exponent n is not negative."""
    return 1.0 / (exponent + 2.0)


def phong_exponent(spread: float) -> float:
    """The inverse of `phong_spread`, infinite at 0."""
    return 1.0 / spread - 2.0 if spread > 0.0 else np.inf


@lru_cache(maxsize=32)
def texture_space_spread(size: int, halved: Callable[[Array], Array]) -> tuple[float, ...]:
    """Spread of the mips of a filter that knows texels only.

    Parameters
    ----------
    size : int
        Width of the first mip's faces in texels, a power of 2.
    halved : callable
        `texture_space.box_halved` or `tent_halved`.

    Returns
    -------
    tuple of float
        Of lookups between texels, in the mean over all directions. About 0.60 / n^2 for box filters and
        1.0 / n^2 for tents, where n > 4 is a mip's width.

    Notes
    -----
    Filters are linear. So the mean direction of a lobe's light is what they make of a cube map of directions.
    """
    axes = directions_in_cap((0.0, 0.0, 1.0), np.pi, _DIRECTIONS)
    return tuple(
        1.0 - float(np.einsum("ni,ni->n", lookup(faces, axes, _CUBE), axes).mean())
        for faces in filtered_mips(_CUBE.texel_directions(size), halved)
    )
