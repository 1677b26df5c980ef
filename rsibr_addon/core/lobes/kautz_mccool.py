"""The fits of Kautz & McCool: one lobe by a mean profile, several by minimum profiles, one for all views.

As everywhere here, lobes approximate brdf * n.l. [Kautz2000] fits the brdf, and approximates the cosine by
n.r (its Eq. 2): `without_cosine` and `with_outer_cosine` before and after a fit do the same.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from ..brdf.albedo import hemisphere_quadrature
from ..brdf.model import BrdfFunction
from ..conventions import Array
from ..ties import first_greatest
from .bank import SHARPEST
from .clustering import clustered
from .fit import Fit, offsets_from_axes
from .joint import bank_for
from .radial_profile import RadialProfile, around
from .target import target_slices

PLANES = 8
"""Planes through the axis on which a lobe is sampled: sixteen radial curves."""

_NORMAL = np.array([0.0, 0.0, 1.0])
_RADIAL_NODES, _ARC_NODES, _INNERMOST = 10, 16, 2e-3
_RINGS = 200
_ARC = 1801


@dataclass
class Remainder:
    """Brdf * n.l for one view, less the lobes that were found.

    Attributes
    ----------
    brdf : callable
    mu : float
        n.v; the mirror direction is (sqrt(1 - mu^2), 0, mu).
    angles : ndarray, shape (N,)
        Angles at which profiles are sampled, ascending from 0 to pi [rad].
    clamped : bool
        Whether profiles are kept from becoming negative.
    lobes : list of RadialProfile
    nodes : ndarray, shape (M, 3)
        Directions above the horizon where peaks are sought.
    weight : ndarray, shape (M,)
        Solid angles [sr]; 0 along the plane of incidence, where nodes are added for the peaks.
    values : ndarray, shape (M, 3)
        The remainder in these directions.
    power : float
        Integral of the square of the whole.
    """

    brdf: BrdfFunction
    mu: float
    angles: Array
    clamped: bool = True
    lobes: list[RadialProfile] = field(default_factory=list)
    nodes: Array = field(init=False)
    weight: Array = field(init=False)
    values: Array = field(init=False)
    power: float = field(init=False)

    def __post_init__(self) -> None:
        nodes, weight = hemisphere_quadrature(self.mu, _RADIAL_NODES, _ARC_NODES, _INNERMOST)
        theta = np.linspace(-0.5 * np.pi, 0.5 * np.pi, _ARC)[1:-1]
        arc = np.stack([np.sin(theta), np.zeros_like(theta), np.cos(theta)], axis=-1)
        self.nodes = np.concatenate([arc, nodes])
        self.weight = np.concatenate([np.zeros(len(arc)), weight])
        self.values = self.at(self.nodes)
        self.power = float(np.sum(self.weight @ self.values**2))

    def at(self, directions: Array) -> Array:
        """The remainder in some directions.

        Parameters
        ----------
        directions : ndarray, shape (..., 3)
            Unit vectors; the normal is +Z.

        Returns
        -------
        ndarray, shape (..., 3)
            Red, green and blue [1/sr].
        """
        view_dir = np.array([-np.sqrt(1.0 - self.mu**2), 0.0, self.mu])
        rest = self.brdf(directions, view_dir) * np.maximum(directions[..., 2:], 0.0)
        for lobe in self.lobes:
            rest -= lobe(directions)
        return rest

    def peak(self) -> Array:
        """Direction of the largest remainder, shape (3,)."""
        peak: Array = self.nodes[first_greatest(self.values.sum(axis=1))]
        return peak

    def mean_profile(self, axis: Array) -> RadialProfile:
        """Section 3.1: the mean of the radial curves about an axis, shape (3,)."""
        curves = self.at(around(axis, self.angles, PLANES))
        return RadialProfile(axis, self.angles, curves.mean(axis=1))

    def minimum_profile(self, axis: Array) -> RadialProfile:
        """Section 3.3: the minimum of the radial curves about an axis, shape (3,); not below 0 if clamped."""
        least = self.at(around(axis, self.angles, PLANES)).min(axis=1)
        return RadialProfile(axis, self.angles, np.maximum(least, 0.0) if self.clamped else least)

    def subtract(self, lobe: RadialProfile) -> None:
        """Subtract a lobe from the remainder."""
        self.lobes.append(lobe)
        self.values -= lobe(self.nodes)

    def error(self) -> float:
        """Relative error of the lobes so far, above the horizon."""
        return float(np.sqrt(np.sum(self.weight @ self.values**2) / self.power))


Seek = Callable[[Remainder], Array]
"""Chooses the axis of the next lobe."""


def graded_angles(innermost: float) -> Array:
    """Angles at which profiles are sampled, even in the logarithm from `innermost` [rad] on, shape (N,)."""
    return np.concatenate([[0.0], np.geomspace(innermost, np.pi, _RINGS - 1)])


def greedy_errors(
    brdf: BrdfFunction, mu: Sequence[float] | Array, lobes: int, angles: Array, clamped: bool
) -> Array:
    """The paper's Figure 7: error over the number of lobes.

    Parameters
    ----------
    brdf : callable
    mu : sequence of float
        View elevations.
    lobes : int
    angles : ndarray, shape (N,)
        Angles at which profiles are sampled.
    clamped : bool
        Whether profiles are kept from becoming negative.

    Returns
    -------
    ndarray, shape (lobes,)
        E with 1, 2, ... lobes.

    Notes
    -----
    [Kautz2000] finds that the error rises after six to eight lobes. It does where coarse samples make the
    remainder negative and profiles follow it; clamped, the error keeps falling.
    """
    squares = np.empty((len(mu), lobes))
    for row, cosine in zip(squares, mu, strict=True):
        rest = Remainder(brdf, float(cosine), angles, clamped)
        for index in range(lobes):
            rest.subtract(rest.minimum_profile(rest.peak()))
            row[index] = rest.error() ** 2
    errors: Array = np.sqrt(squares.mean(axis=0))
    return errors


def single_fit(brdf: BrdfFunction, spec: str, mu: Array, sharpest: float = SHARPEST) -> Fit:
    """Section 3.1: one lobe for each elevation, a mean profile about the peak, with the whole's energy.

    Parameters
    ----------
    brdf : callable
    spec : str
        Its text.
    mu : ndarray, shape (S,)
        View elevations, ascending.
    sharpest : float
        Concentration that no kernel exceeds, one of `bank.octaves`.

    Returns
    -------
    Fit
        With one lobe.
    """
    return _fit(brdf, spec, "single", mu, [[_single_lobe(brdf, cosine)] for cosine in mu], sharpest)


def single_2d_fit(brdf: BrdfFunction, spec: str, mu: Array, sharpest: float = SHARPEST) -> Fit:
    """Section 3.2: one profile for all elevations, a mean of theirs, times the elevation's albedo.

    As `single_fit`, but with one profile, so that one map is enough: the mean of least relative error, to
    which an elevation adds the less the brighter and sharper its lobe is.
    """
    each = single_fit(brdf, spec, mu, sharpest)
    albedo = each.albedo
    power = np.einsum("lskc,km,lsmc->ls", each.weights, each.bank.products(np.zeros(()))[0], each.weights)
    share = albedo / power[:, :, None]
    profile, whole = np.einsum("lsc,lskc->lkc", share, each.weights), np.sum(share * albedo, axis=1)[:, None]
    profile = np.divide(profile, whole, out=np.zeros_like(profile), where=whole > 0.0)
    return Fit(
        brdf=spec,
        method="single-2d",
        mu=mu,
        bank=each.bank,
        weights=profile[:, None],
        scale=albedo,
        offsets=each.offsets,
        taps=each.taps,
    )


def greedy_fit(
    brdf: BrdfFunction,
    spec: str,
    mu: Array,
    lobes: int,
    seek: Seek = Remainder.peak,
    sharpest: float = SHARPEST,
) -> Fit:
    """Section 3.3: lobes one after the other, each a minimum profile, then clustered over the elevations.

    Parameters
    ----------
    lobes : int
    seek : callable
        Finds the axis of the next lobe: the highest peak, or a way of `seeking`.
    brdf, spec, mu, sharpest
        See `single_fit`.
    """
    found = []
    for cosine in mu:
        rest = Remainder(brdf, cosine, _angles(brdf, cosine))
        for _ in range(lobes):
            rest.subtract(rest.minimum_profile(seek(rest)))
        found.append(rest.lobes)
    return _fit(brdf, spec, "greedy", mu, found, sharpest)


def without_cosine(brdf: BrdfFunction) -> BrdfFunction:
    """What times n.l is the brdf alone, which the paper's section 3 fits; 0 where n.l is."""

    def quotient(light_dir: Array, view_dir: Array) -> Array:
        cosine = light_dir[..., 2:]
        values = brdf(light_dir, view_dir)
        return np.divide(values, cosine, out=np.zeros_like(values), where=cosine > 0.0)

    return quotient


def with_outer_cosine(fit: Fit) -> Fit:
    """A fit of a brdf alone times n.r, which is n.v: Eq. 2."""
    if fit.weights.shape[1] == 1:
        return replace(fit, scale=fit.scale * fit.mu[:, None])
    return replace(fit, weights=fit.weights * fit.mu[:, None, None])


def _angles(brdf: BrdfFunction, mu: float) -> Array:
    (target,) = target_slices(brdf, [mu])
    return graded_angles(target.radius / 50.0)


def _single_lobe(brdf: BrdfFunction, mu: float) -> RadialProfile:
    (target,) = target_slices(brdf, [mu])
    rest = Remainder(brdf, mu, graded_angles(target.radius / 50.0))
    mean = rest.mean_profile(_in_plane(rest.peak()))
    got = mean.integral
    energy = np.divide(target.albedo, got, out=np.zeros(3), where=got > 0.0)
    return RadialProfile(mean.axis, mean.angles, mean.values * energy)


def _in_plane(axis: Array) -> Array:
    """The nearest direction in the plane of incidence, where an isotropic lobe's centre must be."""
    flat: Array = axis * (1.0, 0.0, 1.0)
    return flat / np.linalg.norm(flat)


def _fit(
    brdf: BrdfFunction,
    spec: str,
    method: str,
    mu: Array,
    found: Sequence[Sequence[RadialProfile]],
    sharpest: float,
) -> Fit:
    bank = bank_for(target_slices(brdf, mu), sharpest)
    mirror = np.stack([np.sqrt(1.0 - mu**2), np.zeros_like(mu), mu], axis=-1)
    axes = np.array([[lobe.axis for lobe in lobes] for lobes in found])
    offsets = offsets_from_axes(_NORMAL, mirror[:, None], axes)
    order = clustered(offsets)
    weights = np.array([[lobe.weights(bank) for lobe in lobes] for lobes in found])
    rows = np.arange(len(mu))[:, None]
    lobes, slices = order.shape[1], len(mu)
    return Fit(
        brdf=spec,
        method=method,
        mu=mu,
        bank=bank,
        weights=weights[rows, order].swapaxes(0, 1),
        scale=np.ones((lobes, slices, 3)),
        offsets=offsets[rows, order].swapaxes(0, 1)[:, :, None],
        taps=np.ones((lobes, slices, 1)),
    )
