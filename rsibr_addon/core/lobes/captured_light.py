"""The light of captures, its suns apart.

Suns are cut from the environment that sharp kernels filter, and what these make of them in closed form is
added to what is looked up: see `core.suns`.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ..conventions import Array
from ..geometry.directions import dot
from ..kinds.kernel_bank.filtered_bank import FilteredBank
from ..resample import texels_around
from ..suns import LOBES_LEAST_SHARE, Suns, far_from, find_suns, sharp_of
from .bank import KernelBank

_IN_CACHES = 2048


def in_caches(count: int) -> Iterator[slice]:
    """Parts of some points, so that what kernels give at those of one part stays in a processor's caches."""
    for first in range(0, count, _IN_CACHES):
        yield slice(first, first + _IN_CACHES)


@dataclass(frozen=True, eq=False)
class CapturedLight:
    """An environment filtered with K kernels.

    Attributes
    ----------
    filtered : FilteredBank
        Maps of `sharp_of` its kernels are those of the environment without its suns.
    suns : Suns
    """

    filtered: FilteredBank
    suns: Suns

    @cached_property
    def _texels(self) -> Array:
        """The maps as lookups take them, all kernels side by side: shape (texels, K * 3), float32."""
        maps = np.moveaxis(self.filtered.maps, 0, -2).astype(np.float32)
        return np.ascontiguousarray(maps).reshape(-1, 3 * len(self.filtered.bank))

    def along(self, axes: Array) -> Array:
        """The filtered environment along axes, shape (M, K * 3), float32.

        Parameters
        ----------
        axes : ndarray, shape (M, 3)
            Unit vectors.
        """
        filtered = self.filtered
        # All kernels' maps at once, as `resample.lookup` takes one
        columns, rows, sheets, shares = texels_around(
            axes, filtered.representation, filtered.size, filtered.size
        )
        places = (sheets * filtered.size + rows) * filtered.size + columns
        shares = shares.astype(np.float32)[..., None]
        found = np.empty((len(axes), self._texels.shape[1]), dtype=np.float32)
        for some in in_caches(len(axes)):
            found[some] = shares[0, some] * self._texels[places[0, some]]
            for index, share in zip(places[1:, some], shares[1:, some], strict=True):
                found[some] += share * self._texels[index]
            self._add_suns(axes[some], found[some].reshape(-1, len(filtered.bank), 3))
        return found

    def _add_suns(self, axes: Array, found: Array) -> None:
        """Add all suns at once, as `Suns.near` gives them one by one: a fit asks for them at each step."""
        sharp = sharp_of(self.filtered.bank)
        if sharp is None or not len(self.suns):
            return
        seen_as = self.suns.widened(sharp)
        near = np.flatnonzero(np.max(axes @ self.suns.direction.T, axis=1) > 1.0 - far_from(seen_as))
        between = axes[near, None] - self.suns.direction
        kernels = seen_as.values(0.25 * dot(between, between)).astype(np.float32)
        light = np.swapaxes(kernels, 1, 2) @ self.suns.irradiance.astype(np.float32)
        found[near, -len(sharp) :] += light


def captured_light(
    radiance: Array, bank: KernelBank, filter_light: Callable[[Array, KernelBank], FilteredBank]
) -> CapturedLight:
    """Filter an environment, its suns apart.

    Parameters
    ----------
    radiance : ndarray, shape (height, 2 * height, 3)
    bank : KernelBank
        K kernels.
    filter_light : callable
        An environment and kernels to its filtered maps.
    """
    suns, sharp = find_suns(radiance, LOBES_LEAST_SHARE), sharp_of(bank)
    broad = bank.concentrations[: len(bank) - (len(sharp) if sharp else 0)]
    parts = [filter_light(radiance, KernelBank(broad))] if broad else []
    if sharp is not None:
        parts.append(filter_light(np.minimum(radiance, suns.ceiling), sharp))
    maps, bound = (np.concatenate([getattr(part, name) for part in parts]) for name in ("maps", "bound"))
    return CapturedLight(FilteredBank(parts[0].layout, bank, maps, bound), suns)
