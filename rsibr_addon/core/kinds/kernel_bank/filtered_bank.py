"""An environment filtered with every kernel of a bank: any BRDF's stack is a small matrix times its maps."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from ...conventions import Array
from ...errors import RangeError, ShapeError
from ...lobes.bank import KernelBank
from ...lobes.fit import Fit
from ..lobe_stack.stack import LobeStack, StackMaps, stack_representation


@dataclass(frozen=True, eq=False)
class FilteredBank(StackMaps):
    """The maps from which those of lobes are summed.

    Attributes
    ----------
    layout : str
        One of `stack.LAYOUTS`: see `stack.stack_representation`.
    bank : KernelBank
        K kernels.
    maps : ndarray, shape (K, sheets, size, size, 3)
        Radiance filtered with each, in single or double precision.
    bound : ndarray, shape (K, 3)
        No texel is further than this from the sum over all texels of the environment, and rounding to
        float32.

    Raises
    ------
    ShapeError
        The arrays' shapes do not fit each other, or the layout.
    RangeError
        There is no such layout, or the maps are too large or too small.
    """

    layout: str
    bank: KernelBank
    maps: Array
    bound: Array

    def __post_init__(self) -> None:
        sheets = stack_representation(self.layout, self.size).shape(self.size)
        for name, shape in {"maps": (*sheets, 3), "bound": (3,)}.items():
            found = getattr(self, name).shape
            if found != (len(self.bank), *shape):
                raise ShapeError(f"{name} of a kernel bank cannot have the shape {found}: bake it again.")

    @property
    def sharpest(self) -> float:
        """Concentration of the last kernel; no fit that is summed from the bank may exceed it."""
        return self.bank.concentrations[-1]


AT_ONCE = 2**24
"""Bytes of maps in double precision that are summed together."""


def stack_from_bank(filtered: FilteredBank, fit: Fit) -> tuple[LobeStack, Array]:
    """Sum the maps of a fit's lobes: filtering is linear, so the map of a sum is the sum of maps.

    Parameters
    ----------
    filtered : FilteredBank
    fit : Fit
        Fit whose kernels, those without weight aside, the bank has.

    Returns
    -------
    stack : LobeStack
    bound : ndarray, shape (3,)
        The bank's bounds, carried over: no texel is further from the sum over all texels of the environment,
        rounding to float32 aside.

    Raises
    ------
    RangeError
        A kernel is not in the bank.
    """
    lobes, profiles = fit.weights.shape[:2]
    maps = np.empty((lobes * profiles, *filtered.maps.shape[1:]), dtype=np.float32)
    for target, made in zip(maps, maps_from_bank(filtered, fit), strict=True):
        target[...] = made
    maps = maps.reshape(lobes, profiles, *maps.shape[1:])
    stack = LobeStack(filtered.layout, fit.mu, maps, fit.scale, fit.offsets, fit.taps, fit.albedo)
    return stack, bound_from_bank(filtered, fit)


def bound_from_bank(filtered: FilteredBank, fit: Fit) -> Array:
    """A bank's bounds, carried over to a fit's maps: see `stack_from_bank`.

    Returns
    -------
    ndarray, shape (3,)
    """
    bound: Array = np.einsum(
        "lpkc,kc->lpc", np.abs(fit.weights[:, :, fit.used]), filtered.bound[_picked(filtered, fit)]
    ).max(axis=(0, 1))
    return bound


def maps_from_bank(filtered: FilteredBank, fit: Fit) -> Iterator[Array]:
    """The maps of `stack_from_bank`, one after another: lobe by lobe, and elevation by elevation within each.

    Parameters
    ----------
    filtered, fit
        See `stack_from_bank`.

    Yields
    ------
    ndarray, shape (sheets, size, size, 3), float32

    Raises
    ------
    RangeError
        A kernel is not in the bank.
    """
    picked = _picked(filtered, fit)
    weights = fit.weights[:, :, fit.used].reshape(-1, len(picked), 3).astype(filtered.maps.dtype)
    every = picked == list(range(len(filtered.bank)))
    of_kernels = filtered.maps if every else filtered.maps[picked]
    channels = [
        np.ascontiguousarray(of_kernels[..., channel].reshape(len(picked), -1)) for channel in range(3)
    ]
    # Several at once, because a single row is summed in another order
    step = max(2, AT_ONCE // channels[0][0].nbytes)
    for part in np.array_split(weights, max(1, len(weights) // step)):
        maps = np.empty((len(part), *filtered.maps.shape[1:]), dtype=np.float32)
        for channel, of_channel in enumerate(channels):
            # A product of matrices, which is much faster than a sum over indices
            maps[..., channel] = (part[..., channel] @ of_channel).reshape(maps.shape[:-1])
        yield from maps


def _picked(filtered: FilteredBank, fit: Fit) -> list[int]:
    """Numbers, in the bank, of the kernels that a fit uses."""
    numbers = {kappa: number for number, kappa in enumerate(filtered.bank.concentrations)}
    wanted = [fit.bank.concentrations[kernel] for kernel in fit.used]
    if missing := [kappa for kappa in wanted if kappa not in numbers]:
        raise RangeError(
            f"The fit has a kernel of concentration {missing[0]:g}, and the bank none: fit with the bank's "
            f"kernels, or bake a larger bank."
        )
    return [numbers[kappa] for kappa in wanted]
