"""A cube map at falling sizes, each blurrier than the one before, and harmonics of its light."""

from dataclasses import dataclass, replace

import numpy as np

from ...conventions import Array
from ...errors import RangeError, ShapeError
from ...filtering.irradiance import degree_of, turned_harmonics
from ...maps import cube_map
from .mip_lobes import MipLobes
from .probes import Probe

LARGEST = 1024
"""Width of the largest faces: to filter and upload such a chain takes some 1.5 GB."""


MOST_DEGREES = 20
"""Largest degree of harmonics, which misses 1.5 % of all light at most."""


@dataclass(frozen=True)
class MipChain:
    """The light that [Kautz2004] shades from: glossy by the mirror direction, diffuse by the normal.

    Attributes
    ----------
    mips : tuple of ndarray, shape (6, n, n, 3), float32
        Radiance on the faces of `core.maps.cube_map`, n a power of 2 that halves from mip to mip.
    harmonics : ndarray, shape ((degree + 1)**2, 3), float64
        Coefficients of the environment's radiance, in the order of
        `core.filtering.irradiance.real_harmonics`: nine in the paper, up to `MOST_DEGREES`.
    roughness : tuple of float, or None
        Roughness of each mip, ascending in [0, 1]: square root of the alpha of its GGX lobe, 0 if it was not
        filtered. None where mips were not filtered with GGX lobes.
    spread : tuple of float, or None
        1 less the mean cosine between the axis of each mip's lobe and its light, ascending in [0, 2]; None
        where it is not known, or follows from the roughness.
    probes : tuple of Probe
        Light of rooms, which counts in them instead.

    Raises
    ------
    ShapeError
        The mips are not cube faces that halve in size, the coefficients are not those of a degree, there
        are not as many roughnesses or spreads as mips, or a probe has mips of other sizes.
    RangeError
        Roughnesses or spreads do not ascend within their range, there are too many coefficients, or a size is
        out of range: see `check_size`.
    """

    mips: tuple[Array, ...]
    harmonics: Array
    roughness: tuple[float, ...] | None = None
    spread: tuple[float, ...] | None = None
    probes: tuple[Probe, ...] = ()

    def __post_init__(self) -> None:
        check_size(self.size, len(self.mips))
        for probe in self.probes:
            if [faces.shape for faces in probe.mips] != [faces.shape for faces in self.mips]:
                raise ShapeError("A probe needs mips of the same sizes as the chain that it belongs to.")
        for mip, faces in enumerate(self.mips):
            expected = (6, self.size >> mip, self.size >> mip, 3)
            if faces.shape != expected:
                raise ShapeError(f"Mip {mip} must have the shape {expected}, not {faces.shape}.")
        if self.harmonics.ndim != 2 or self.harmonics.shape[1] != 3:
            raise ShapeError(f"A mip chain needs coefficients of three, not {self.harmonics.shape}.")
        if degree_of(self.harmonics) > MOST_DEGREES:
            raise RangeError(
                f"{len(self.harmonics)} coefficients are of a degree above {MOST_DEGREES}: make fewer."
            )
        for name, values in (("roughnesses", self.roughness), ("spreads", self.spread)):
            if values is not None and len(values) != len(self.mips):
                raise ShapeError(f"{len(self.mips)} mips need as many {name}, not {len(values)}.")
        if self.roughness is not None:
            check_roughness(self.roughness)
        if self.spread is not None and (min(self.spread) < 0.0 or np.any(np.diff(self.spread) < 0.0)):
            raise RangeError(f"Spreads {', '.join(f'{s:g}' for s in self.spread)} do not ascend from 0.")

    @property
    def size(self) -> int:
        """Width and height of the first mip's faces in texels."""
        return int(self.mips[0].shape[1])

    def turned(self, rotation: Array) -> "MipChain":
        """The same light in other axes, without probes.

        Parameters
        ----------
        rotation : ndarray, shape (3, 3)
            New directions from old ones; takes axes to axes.
        """
        mips = tuple(cube_map.turned(faces, rotation) for faces in self.mips)
        return replace(self, mips=mips, harmonics=turned_harmonics(self.harmonics, rotation), probes=())

    @property
    def lobes(self) -> MipLobes:
        """How wide the lobe of each mip is."""
        return MipLobes(len(self.mips), self.roughness, self.spread)


def check_size(size: int, count: int) -> None:
    """Refuse sizes that no mip chain has.

    Parameters
    ----------
    size : int
        Width of the first mip's faces in texels.
    count : int
        Number of mips.

    Raises
    ------
    RangeError
        The size is not a power of 2 up to `LARGEST`, or cannot be halved so often.
    """
    if not 1 <= size <= LARGEST or size & (size - 1):
        raise RangeError(f"A mip chain cannot be {size} texels wide: choose a power of 2 up to {LARGEST}.")
    if not 1 <= count <= size.bit_length():
        raise RangeError(
            f"A chain from {size} texels has 1 to {size.bit_length()} mips, not {count}: "
            f"choose another number, or another size."
        )


def check_roughness(roughness: tuple[float, ...], repeated: bool = False) -> None:
    """Refuse roughnesses that no lookup can interpolate.

    Parameters
    ----------
    roughness : tuple of float
    repeated : bool
        Whether several mips may have the same.

    Raises
    ------
    RangeError
        They are not ascending numbers in [0, 1].
    """
    steps = np.diff(roughness)
    if not all(0.0 <= r <= 1.0 for r in roughness) or np.any(steps < 0.0 if repeated else steps <= 0.0):
        raise RangeError(
            f"Roughnesses {', '.join(f'{r:g}' for r in roughness)} do not ascend within 0 to 1: change them."
        )
