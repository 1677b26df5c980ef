"""What the lobes of a stack make of suns, apart from its maps: see `core.suns`."""

from dataclasses import dataclass, replace

import numpy as np

from ...conventions import Array, Indices
from ...lobes.bank import KernelBank
from ...lobes.fit import Fit
from ...suns import LOBES_LEAST_SHARE, Suns, find_suns, sharp_of


@dataclass(frozen=True, eq=False)
class Sunlight:
    """Suns, and the sharp kernels of L lobes.

    Attributes
    ----------
    suns : Suns
    bank : KernelBank
        K kernels.
    weights : ndarray, shape (L, P, K, 3)
        Those of `Fit.weights`.
    """

    suns: Suns
    bank: KernelBank
    weights: Array

    def along(self, lobe: int, axis: Array, below: Indices, share: Array) -> Array:
        """A lobe's share of suns, to be added to what its map shows.

        Parameters
        ----------
        lobe : int
        axis : ndarray, shape (..., 3)
            Unit vectors.
        below, share : ndarray, shapes (...,)
            Elevations: see `LobeStack.elevation`.

        Returns
        -------
        ndarray, shape (..., 3)

        Notes
        -----
        GLSL twin: gpu_shaders/lib/lobe_stack_lib.glsl `lobe_sunlight`.
        """
        weights, last = self.weights[lobe], self.weights.shape[1] - 1
        radiance = np.zeros(axis.shape)
        for near, light in self.suns.near(self.bank, axis):
            number, part = below[near], share[near, None, None]
            first, second = (weights[np.minimum(each, last)] for each in (number, number + 1))
            radiance[near] += np.sum((first + part * (second - first)) * light, axis=-2)
        return radiance


def take_suns_apart(
    maps: Array, texel_dir: Array, fit: Fit, sharpest: float, radiance: Array
) -> Sunlight | None:
    """Take suns out of the maps of lobes.

    Parameters
    ----------
    maps : ndarray, shape (L, P, sheets, size, size, 3)
        Of the whole light; changed in place, as maps may fill the memory.
    texel_dir : ndarray, shape (sheets, size, size, 3)
        Direction of each of their texels.
    fit : Fit
        The lobes.
    sharpest : float
        Concentration of the kernel that stands for sharper ones in the maps.
    radiance : ndarray, shape (height, 2 * height, 3)
        The environment.

    Returns
    -------
    Sunlight or None
        What has been taken; None where there are no suns, or no kernel is sharp.
    """
    suns, bank = find_suns(radiance, LOBES_LEAST_SHARE), sharp_of(fit.bank)
    if not len(suns) or bank is None:
        return None
    weights = fit.weights[:, :, -len(bank) :]
    in_maps = replace(fit, bank=bank, weights=weights).blunted(sharpest)
    for near, light in suns.near(in_maps.bank, texel_dir):
        maps[..., near, :] -= np.einsum("lpkc,nkc->lpnc", in_maps.weights, light)
    return Sunlight(suns, bank, weights)
