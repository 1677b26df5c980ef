"""Errors of lobes as natural light shows them: each octave of its frequencies has the same power.

The integral of a squared error is what a single sun shows. Skies and rooms have most of their light in low
frequencies. There the broad feet of narrow lobes count, which hold much light and little of the square.
"""

import numpy as np

from ..conventions import Array
from ..filtering.zonal import zonal_coefficients
from .bank import KernelBank
from .projection import Lookups
from .target import TargetSlice

DEGREE = 64
"""Harmonics beyond it have little power."""


def natural_equations(
    target: TargetSlice, bank: KernelBank, lookups: Lookups, share: float
) -> tuple[Array, Array]:
    """What natural light adds to `Projector.equations`, in the same units.

    Parameters
    ----------
    target : TargetSlice
    bank : KernelBank
        K kernels.
    lookups : Lookups
        J lobes of one tap.
    share : float
        Weight of the error in an octave, relative to the same error of the lobe's shape.

    Returns
    -------
    system : ndarray, shape (J K, J K)
    right : ndarray, shape (J K, C)

    Notes
    -----
    A lobe that is narrow has the power (2 l + 1) albedo^2 / (4 pi) in the harmonics of degree l. Those of
    1 / (l + 1) octaves weigh so that an error of that share of it counts `share` times.
    """
    degree = np.arange(1, DEGREE + 1)
    weight = share * target.power / np.sum(target.albedo**2) / (degree + 1.0)
    unit = 1.0 / np.sqrt(bank.products(np.zeros(()))[0].diagonal())
    series = np.array([zonal_coefficients(kernel, DEGREE)[1:] for kernel in bank.lobes()])
    kernels = series * unit[:, None]
    angles = lookups.angles[:, 0]
    axes = np.stack([np.sin(angles), np.zeros_like(angles), np.cos(angles)], axis=-1)
    between = _legendre(np.cos(angles[:, None] - angles))
    to_nodes = _legendre(np.clip(axes @ target.light_dir.T, -1.0, 1.0))
    light = target.weight[:, None] * target.lobe / np.sqrt(target.power)
    system = np.einsum("lij,kl,ml,l->ikjm", between, kernels, kernels, weight, optimize=True)
    right = np.einsum("ljc,kl,l->jkc", to_nodes @ light, kernels, weight, optimize=True)
    size = len(angles) * len(bank)
    return system.reshape(size, size), right.reshape(size, -1)


def _legendre(cosine: Array) -> Array:
    """Legendre's polynomials of degrees 1 to `DEGREE`, first axis."""
    polynomials: Array = np.moveaxis(np.polynomial.legendre.legvander(cosine, DEGREE), -1, 0)[1:]
    return polynomials
