"""The split sum of engines as a family of lobes, so that it is drawn with all else the same.

Engines filter light with GGX at normal = view = mirror direction [Karis2013], and multiply what they look up
along the mirror direction by the exact albedo. As a family that is one lobe about the mirror direction, of
the same shape for all views, whose weights sum to the albedo.
"""

import numpy as np

from ...conventions import Array
from ...filtering.radial_lobes import ggx_n_dot_l_lobe
from ...lobes.family import Family
from .shading import Families

ANGLES = np.concatenate([[0.0], np.geomspace(1e-4, np.pi, 2000)])


def split_families(families: Families) -> Families:
    """The families of materials whose light and reflectance are integrated apart."""
    ggx = families.ggx
    shapes = np.stack([_shape(ggx, alpha) for alpha in ggx.alpha])
    weights = np.zeros_like(ggx.weights)
    weights[:, :, 0] = shapes[:, None, :, None] * ggx.albedo[:, :, None, :]
    return Families(
        Family(ggx.alpha, ggx.mu, ggx.bank, np.zeros_like(ggx.tilts), weights),
        families.leaning,
        families.sheen_table,
    )


def _shape(family: Family, alpha: float) -> Array:
    """Weights of kernels whose sum is nearest to the filter of engines, and sums to 1: shape (K,)."""
    solid = 2.0 * np.pi * np.sin(ANGLES) * np.gradient(ANGLES)
    kernels = family.bank.values(np.sin(0.5 * ANGLES) ** 2)
    wanted = ggx_n_dot_l_lobe(alpha).profile(ANGLES)
    root = np.sqrt(solid)
    weights = np.linalg.lstsq(root[:, None] * kernels, root * wanted, rcond=1e-6)[0]
    shape: Array = weights / weights.sum()
    return shape
