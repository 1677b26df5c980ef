"""The target of a fit: brdf times cosine over the sphere, at one view elevation after another."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..brdf.albedo import hemisphere_quadrature
from ..brdf.model import BrdfFunction
from ..conventions import Array
from ..errors import RangeError
from ..ties import first_greatest

RADIAL_NODES, ARC_NODES = 20, 24
_FINENESS = 10.0
_NEGLIGIBLE = 1e-8


@dataclass(frozen=True)
class TargetSlice:
    """Brdf times cosine for one view elevation, sampled where it integrates well.

    The mirror direction is (sin theta, 0, mu), the normal +Z. The lobe is symmetric in y, so that nodes have
    y > 0 and stand for two.

    Attributes
    ----------
    mu : float
        Cosine between normal and view, as between normal and mirror direction, in (0, 1].
    light_dir : ndarray, shape (N, 3)
        Nodes of the quadrature, without those where the lobe is negligible.
    weight : ndarray, shape (N,)
        Solid angles [sr].
    lobe : ndarray, shape (N, C)
        brdf * n.l [1/sr] in C channels: those of linear Rec. 709, or whatever is fitted together.
    albedo : ndarray, shape (C,)
        Integral of the lobe, above 0 in one channel at least.
    power : float
        Integral of its square, summed over the channels [1/sr].
    """

    mu: float
    light_dir: Array
    weight: Array
    lobe: Array
    albedo: Array
    power: float

    @property
    def theta(self) -> float:
        """Angle of the mirror direction from the normal [rad]."""
        return float(np.arccos(self.mu))

    @property
    def radius(self) -> float:
        """Angle [rad] about an axis within which a flat lobe of the same albedo has the same power."""
        return float(np.sqrt(np.sum(self.albedo) ** 2 / (len(self.albedo) * np.pi * self.power)))

    @property
    def core(self) -> float:
        """Chord about the brightest direction within which half of the power lies: a peak's own width.

        `radius` is wider where a broad base holds most of the light.
        """
        square = self.weight * np.sum(self.lobe**2, axis=1)
        peak = self.light_dir[first_greatest(np.sum(self.lobe, axis=1))]
        chord = np.linalg.norm(self.light_dir - peak, axis=1)
        order = np.argsort(chord, kind="stable")
        within = np.cumsum(square[order])
        # 0 where a single node holds as much
        return max(float(chord[order][np.searchsorted(within, 0.5 * within[-1])]), 1e-6)


def elevation_slices(count: int) -> Array:
    """Cosines of the view elevations that are fitted: (k + 1/2) / count, from grazing to the normal.

    Parameters
    ----------
    count : int
        1 to 256.

    Returns
    -------
    ndarray, shape (count,)

    Raises
    ------
    RangeError
        The count is out of range.
    """
    if not 1 <= count <= 256:
        raise RangeError(f"{count} slices are out of range: choose 1 to 256, 16 for most materials.")
    mu: Array = (np.arange(count) + 0.5) / count
    return mu


def target_slices(brdf: BrdfFunction, mu: Sequence[float] | Array) -> tuple[TargetSlice, ...]:
    """Sample a model for the fit.

    Parameters
    ----------
    brdf : callable
        A `Brdf`, or any isotropic function called like one.
    mu : sequence of float
        Cosines of the view elevations, in (0, 1].

    Raises
    ------
    RangeError
        An elevation lies outside (0, 1]; the model reflects nothing at one of them, or is not finite.
    """
    return tuple(_target_slice(brdf, float(cosine)) for cosine in mu)


def _target_slice(brdf: BrdfFunction, mu: float) -> TargetSlice:
    coarse = _sampled(brdf, mu, *_half(*hemisphere_quadrature(mu)))
    narrowest = min(coarse.radius / _FINENESS, 0.5)
    fine = hemisphere_quadrature(mu, RADIAL_NODES, ARC_NODES, narrowest)
    return _sampled(brdf, mu, *_half(*fine))


def _half(light_dir: Array, weight: Array) -> tuple[Array, Array]:
    """The nodes with y > 0, for two."""
    left = light_dir[:, 1] > 0.0
    return light_dir[left], 2.0 * weight[left]


def _sampled(brdf: BrdfFunction, mu: float, light_dir: Array, weight: Array) -> TargetSlice:
    # The mirror direction lies towards +x, so the view lies towards -x
    view_dir = np.array([-np.sqrt(1.0 - mu**2), 0.0, mu])
    lobe = brdf(light_dir, view_dir) * light_dir[:, 2:]
    square = weight * np.sum(lobe**2, axis=1)
    power = float(np.sum(square))
    if not 0.0 < power < np.inf:
        angle = np.degrees(np.arccos(mu))
        raise RangeError(
            f"The reflectance is black, NaN or infinite at {angle:.0f} degrees from the normal: correct it."
        )
    order = np.argsort(square)
    kept = np.sort(order[np.cumsum(square[order]) > _NEGLIGIBLE * power])
    return TargetSlice(mu, light_dir[kept], weight[kept], lobe[kept], weight @ lobe, power)
