"""A cube map at falling sizes, each blurrier than the one before, and nine harmonics of its light."""

from dataclasses import dataclass

import numpy as np

from ...conventions import Array
from ...errors import RangeError, ShapeError
from ...filtering.irradiance import turned_harmonics
from ...maps import cube_map

LARGEST = 1024
"""Width of the largest faces: to filter and upload such a chain takes some 1.5 GB."""


@dataclass(frozen=True)
class MipChain:
    """The light that [Kautz2004] shades from: glossy by the mirror direction, diffuse by the normal.

    Attributes
    ----------
    mips : tuple of ndarray, shape (6, n, n, 3), float32
        Radiance on the faces of `core.maps.cube_map`, n a power of 2 that halves from mip to mip.
    harmonics : ndarray, shape (9, 3), float64
        Coefficients of the environment's radiance, in the order of
        `core.filtering.irradiance.real_harmonics`.
    roughness : tuple of float, or None
        Roughness of each mip, ascending in [0, 1]: square root of the alpha of its GGX lobe, 0 if it was not
        filtered. None where mips were not filtered with GGX lobes.

    Raises
    ------
    ShapeError
        The mips are not cube faces that halve in size, there are not nine coefficients, or not as many
        roughnesses as mips.
    RangeError
        The roughnesses do not ascend within [0, 1], or a size is out of range: see `check_size`.
    """

    mips: tuple[Array, ...]
    harmonics: Array
    roughness: tuple[float, ...] | None = None

    def __post_init__(self) -> None:
        check_size(self.size, len(self.mips))
        for mip, faces in enumerate(self.mips):
            expected = (6, self.size >> mip, self.size >> mip, 3)
            if faces.shape != expected:
                raise ShapeError(f"Mip {mip} must have the shape {expected}, not {faces.shape}.")
        if self.harmonics.shape != (9, 3):
            raise ShapeError(f"A mip chain needs nine coefficients of three, not {self.harmonics.shape}.")
        if self.roughness is not None:
            if len(self.roughness) != len(self.mips):
                raise ShapeError(
                    f"{len(self.mips)} mips need as many roughnesses, not {len(self.roughness)}."
                )
            check_roughness(self.roughness)

    @property
    def size(self) -> int:
        """Width and height of the first mip's faces in texels."""
        return int(self.mips[0].shape[1])

    def turned(self, rotation: Array) -> "MipChain":
        """The same light in other axes.

        Parameters
        ----------
        rotation : ndarray, shape (3, 3)
            New directions from old ones; takes axes to axes.
        """
        mips = tuple(cube_map.turned(faces, rotation) for faces in self.mips)
        return MipChain(mips, turned_harmonics(self.harmonics, rotation), self.roughness)

    def mip_of(self, roughness: float) -> float:
        """The level of detail at which a GGX chain shows a roughness.

        Parameters
        ----------
        roughness : float
            In [0, 1]; beyond the first or last mip's roughness, that mip is used.

        Returns
        -------
        float
            In [0, mips - 1], linear between the mips' roughnesses.

        Raises
        ------
        RangeError
            The mips were not filtered with GGX lobes.
        """
        if self.roughness is None:
            raise RangeError("A box-filtered mip chain has no roughness: choose a mip instead.")
        return float(np.interp(roughness, self.roughness, np.arange(len(self.roughness))))


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
            f"Roughnesses {', '.join(f'{r:g}' for r in roughness)} do not ascend from 0 to 1: order them."
        )
