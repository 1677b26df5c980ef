"""Errors of a fit."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..brdf.albedo import hemisphere_quadrature
from ..brdf.model import BrdfFunction
from ..conventions import Array
from .fit import Fit

GRAZING = 0.1
"""n.v below which elevations count as grazing."""

_RADIAL_NODES, _ARC_NODES = 16, 32


@dataclass(frozen=True)
class FitErrors:
    """Errors at S elevations; all are relative to the model's own brdf * n.l.

    Attributes
    ----------
    mu : ndarray, shape (S,)
        n.v.
    shape : ndarray, shape (S,)
        sqrt(integral of |fit - model|^2 / integral of |model|^2) over the whole sphere and all channels.
    albedo : ndarray, shape (S, 3)
        Integral of the fit over that of the model, minus 1; 0 where the model is black.
    amplification : ndarray, shape (S,)
        Sum over lobes and taps of sqrt(integral of their squares) over that of the model: the factor by which
        errors of single maps may grow in their sum.
    """

    mu: Array
    shape: Array
    albedo: Array
    amplification: Array

    @property
    def error(self) -> float:
        """E, the root mean square of `shape` over the elevations."""
        return float(np.sqrt(np.mean(self.shape**2)))

    @property
    def grazing_error(self) -> float | None:
        """E of elevations below `GRAZING`; None where there is none."""
        grazing = self.shape[self.mu < GRAZING]
        return float(np.sqrt(np.mean(grazing**2))) if len(grazing) else None

    @property
    def albedo_error(self) -> float:
        """Largest error of the albedo at any elevation in any channel."""
        return float(np.max(np.abs(self.albedo)))


def fit_errors(fit: Fit, brdf: BrdfFunction, mu: Sequence[float] | Array | None = None) -> FitErrors:
    """Measure a fit against its model, by a quadrature of its own.

    Parameters
    ----------
    fit : Fit
    brdf : callable
        A `Brdf`, or any isotropic function called like one.
    mu : sequence of float, optional
        Elevations in (0, 1], by default those of the fit; between those the fit is interpolated.
    """
    elevations = fit.mu if mu is None else np.asarray(mu, dtype=np.float64)
    rows = [_errors_at(fit, brdf, float(cosine)) for cosine in elevations]
    shape, albedo, amplification = zip(*rows, strict=True)
    return FitErrors(elevations, np.array(shape), np.array(albedo), np.array(amplification))


def _errors_at(fit: Fit, brdf: BrdfFunction, mu: float) -> tuple[float, Array, float]:
    light_dir, weight = hemisphere_quadrature(mu, _RADIAL_NODES, _ARC_NODES)
    if not np.any(fit.offsets[..., 1]):
        # Symmetric in the plane of incidence
        left = light_dir[:, 1] > 0.0
        light_dir, weight = light_dir[left], 2.0 * weight[left]
    truth = brdf(light_dir, np.array([-np.sqrt(1.0 - mu**2), 0.0, mu])) * light_dir[:, 2:]
    above = fit.evaluate(light_dir, mu) - truth
    below = fit.evaluate(light_dir * (1.0, 1.0, -1.0), mu)
    power = float(np.sum(weight @ truth**2))
    shape = np.sqrt(np.sum(weight @ (above**2 + below**2)) / power)
    albedo = weight @ truth
    _, weights = fit.at(mu)
    got = weights.sum(axis=(0, 1))
    relative = np.divide(got, albedo, out=np.ones(3), where=albedo > 0.0) - 1.0
    own = fit.bank.products(np.zeros(()))[0]
    loudness = np.sqrt(np.maximum(np.einsum("akc,kl,alc->a", weights, own, weights), 0.0))
    return float(shape), relative, float(np.sum(loudness) / np.sqrt(power))
