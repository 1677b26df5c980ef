"""An environment filtered with the kernels of families of lobes, each map as large as its kernel needs."""

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from ...conventions import Array, ArrayLike
from ...errors import RangeError, ShapeError
from ...lobes.bank import KernelBank
from ...lobes.family import KERNELS, Family
from ...lobes.rings import WIDTHS
from ...maps.representation import representation
from ...resample import lookup, lookup_variance
from ...suns import NO_SUNS, Suns

OCTAHEDRAL = representation("octahedral")


@dataclass(frozen=True, eq=False)
class Pyramid:
    """Octahedral maps of an environment: itself, K kernels, two diffuse ones, and R rings.

    Attributes
    ----------
    bank : KernelBank
        K kernels.
    mirror : ndarray, shape (1, n, n, 3)
        The environment itself: what a mirror shows.
    maps : tuple of ndarray, shape (1, n, n, 3) each
        Radiance filtered with each kernel, each of its own width n.
    diffuse : ndarray, shape (2, n, n, 3)
        By direction of the normal: what Lambert's reflection shows of white, and the integral of radiance
        times n.l times `oren_nayar.leaning_albedo`.
    rings : ndarray, shape (R, n, n, 3)
        By direction of the normal: radiance filtered with `lobes.rings.ring` of each of its `WIDTHS`.
    suns : Suns
        What lobes leave to GGX itself. All maps have their light; with none, lobes show all.

    Raises
    ------
    ShapeError
        There are not as many maps as kernels or rings, or a map is no square.
    RangeError
        The kernels are not the first ones of `family.KERNELS`.
    """

    bank: KernelBank
    mirror: Array
    maps: tuple[Array, ...]
    diffuse: Array
    rings: Array
    suns: Suns = NO_SUNS

    def __post_init__(self) -> None:
        square = all(sheets.shape[1:] == (sheets.shape[1], sheets.shape[1], 3) for sheets in self.all_maps)
        counts = (len(self.maps), len(self.rings)) == (len(self.bank), len(WIDTHS))
        if not counts or not square:
            raise ShapeError("A pyramid has a square map for each of its kernels and rings: bake it again.")
        if self.bank.concentrations != KERNELS.concentrations[: len(self.bank)]:
            raise RangeError("Its kernels are not those that materials are made of: bake it again.")

    @property
    def all_maps(self) -> tuple[Array, ...]:
        """Every map, the sharpest first."""
        return (self.mirror, *self.maps[::-1], self.rings, self.diffuse)

    @property
    def texels(self) -> int:
        """Number of texels of all maps; as half floats with four channels, each takes 8 bytes of memory."""
        return sum(sheets[..., 0].size for sheets in self.all_maps)

    @cached_property
    def sunless(self) -> tuple[Array, ...]:
        """`maps` without the light of suns."""
        if not len(self.suns):
            return self.maps
        sizes = {sheets.shape[1] for sheets in self.maps}
        texel_dir = {size: OCTAHEDRAL.texel_directions(size) for size in sizes}
        return tuple(
            self.suns.left_of(sheets, texel_dir[sheets.shape[1]], kappa)
            for sheets, kappa in zip(self.maps, self.bank.concentrations, strict=True)
        )

    def resolved(self, family: Family) -> Family:
        """The family with the kernels that this has maps of: see `resolved`."""
        return resolved(family, self.bank, self.mirror.shape[1])

    def kernel(self, concentration: float, direction: ArrayLike) -> Array:
        """The environment without its suns, filtered with a kernel.

        Parameters
        ----------
        concentration : float
            One of the bank's; of larger ones none is resolved, and the environment itself is shown: see
            `resolved`.
        direction : array_like, shape (..., 3)
            Axes of the kernel.

        Returns
        -------
        ndarray, shape (..., 3)
        """
        if concentration > self.bank.concentrations[-1]:
            return np.minimum(lookup(self.mirror, direction, OCTAHEDRAL), self.suns.ceiling)
        number = self.bank.concentrations.index(concentration)
        return lookup(self.sunless[number], direction, OCTAHEDRAL)


def resolved(family: Family, bank: KernelBank, width: int) -> Family:
    """A family whose kernels are those that have maps, and the mirror's.

    Parameters
    ----------
    family : Family
        Its kernels are `family.KERNELS`.
    bank : KernelBank
        The first ones of these, which have maps.
    width : int
        Texels along the mirror's map.

    Returns
    -------
    Family
        What a kernel without a map shows is shared between the mirror and the sharpest map, so that both
        together are as wide as the kernel.
    """
    count, variance = len(bank), 1.0 / family.bank.kappa
    # The mirror was looked up in an environment of as many columns, and is looked up itself
    mirror = lookup_variance((2.0 * np.pi / width) ** 2) + lookup_variance(4.0 * np.pi / width**2)
    sharpest = variance[count - 1]
    shares = np.clip((sharpest - variance[count:]) / (sharpest - mirror), 0.0, 1.0)
    weights = np.array(family.weights, dtype=np.float64)
    of_others = weights[..., count:, :]
    weights[..., count - 1, :] += np.einsum("k,...kc->...c", 1.0 - shares, of_others)
    of_others *= shares[:, None]
    return replace(family, weights=weights)
