"""The light of captures, its suns apart.

Maps are looked up between texels, which blurs what a sharp kernel makes of a sun: one of the few texels that
hold most of the squared radiance. So these are cut from the environment that sharp kernels filter. What a
kernel makes of a single direction is known in closed form, and is added to what is looked up.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ..conventions import Array, texel_centres
from ..geometry.directions import dot
from ..kinds.kernel_bank.filtered_bank import FilteredBank
from ..maps import equirect
from ..resample import texels_around
from .bank import KernelBank

MOST_SUNS = 8
"""Most texels that are cut."""

FAINTEST_SUN = 1e-3
"""Least share of the environment's squared radiance that makes a texel a sun."""

SHARP = 200.0
"""Concentration above which kernels take suns apart: below, they are many texels wide in any map."""

_IN_CACHES = 2048
_LEAST = 1e-7
"""Value of a kernel, over its peak, below which a sun is too far away to be added."""


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
        Sharp kernels' maps are those of the environment without its N suns.
    sun_dir : ndarray, shape (N, 3)
        Unit vectors towards the suns.
    irradiance : ndarray, shape (N, 3)
        Radiance times solid angle of each.
    """

    filtered: FilteredBank
    sun_dir: Array
    irradiance: Array

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
        self._add_suns(axes, found.reshape(len(axes), -1, 3))
        return found

    def _add_suns(self, axes: Array, found: Array) -> None:
        bank, first = self.filtered.bank, _first_sharp(self.filtered.bank)
        if first == len(bank):
            return
        sharp = KernelBank(bank.concentrations[first:])
        within = np.cos(np.sqrt(-2.0 * np.log(_LEAST) / sharp.kappa[0]))
        near_each = (axes @ self.sun_dir.T > within).T
        for near, sun_dir, irradiance in zip(near_each, self.sun_dir, self.irradiance, strict=True):
            chosen = np.flatnonzero(near)
            between = axes[chosen] - sun_dir
            found[chosen, first:] += sharp.values(0.25 * dot(between, between))[..., None] * irradiance


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
    sun_dir, irradiance, rest = _cut_suns(radiance)
    first = _first_sharp(bank)
    parts = [
        filter_light(light, KernelBank(kernels))
        for light, kernels in ((radiance, bank.concentrations[:first]), (rest, bank.concentrations[first:]))
        if kernels
    ]
    maps, bound = (np.concatenate([getattr(part, name) for part in parts]) for name in ("maps", "bound"))
    return CapturedLight(FilteredBank(parts[0].layout, bank, maps, bound), sun_dir, irradiance)


def _first_sharp(bank: KernelBank) -> int:
    return int(np.searchsorted(bank.kappa, SHARP))


def _cut_suns(radiance: Array) -> tuple[Array, Array, Array]:
    """Directions of suns, radiance times solid angle of each, and the environment without them."""
    height, width = radiance.shape[:2]
    solid_angle = np.broadcast_to(equirect.texel_solid_angle(width, height), (height, width)).reshape(-1, 1)
    rest = radiance.astype(np.float64).reshape(-1, 3)
    power = np.sum(rest**2, axis=1) * solid_angle[:, 0]
    order = np.argsort(-power, kind="stable")[: MOST_SUNS + 1]
    suns = order[:-1][power[order[:-1]] > FAINTEST_SUN * power.sum()]
    # A sun is cut down to the brightest texel that is none
    remaining = np.minimum(rest[suns], rest[order[len(suns)]])
    irradiance = (rest[suns] - remaining) * solid_angle[suns]
    rest[suns] = remaining
    sun_dir = equirect.direction_from_uv(texel_centres(width, height).reshape(-1, 2)[suns])
    return sun_dir, irradiance, rest.reshape(radiance.shape).astype(radiance.dtype)
