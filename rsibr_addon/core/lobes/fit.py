"""A fit: reflectance as a few radially symmetric lobes for each view elevation.

The fit approximates the whole brdf * n.l over the sphere, 0 below the horizon: the lobes include the cosine.
[Kautz2000] Eq. 2 takes it out of the integral as n.r, which at least doubles the error.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from ..conventions import Array, ArrayLike, Indices
from ..errors import RangeError, ShapeError
from ..filtering.zonal import ZonalLobe
from ..geometry.directions import dot
from .bank import KernelBank


@dataclass(frozen=True, eq=False)
class Fit:
    """L lobes at S view elevations, each looked up in T directions ("taps") that share its maps.

    brdf * n.l towards light l at elevation s is about

        sum over lobes and taps of taps * scale * sum over kernels of weights * kernel(l . axis)

    with the axis from `lobe_axes`. Between two elevations everything is linear in mu = n.v; beyond the first
    and the last, the values of these hold.

    Attributes
    ----------
    brdf : str
        The text of the model.
    method : str
        Method of the fit: "joint", "greedy", "single", "single-2d" or "captured".
    mu : ndarray, shape (S,)
        Cosines of the view elevations, ascending, in (0, 1].
    bank : KernelBank
        K kernels, which integrate to 1.
    weights : ndarray, shape (L, P, K, 3)
        Weights of the kernels whose sums are the lobes' profiles, one for each channel of linear Rec. 709.
        They are signed, and not normalised, because the integral of a signed lobe may be 0. P is S, or 1
        where all elevations share one profile, and so one map.
    scale : ndarray, shape (L, S, 3)
        Factor of the profile: k(theta) of [Kautz2000] section 3.2, and 1 in other methods.
    offsets : ndarray, shape (L, S, T, 2)
        Offsets of the axes from the mirror direction: see `lobe_axes`.
    taps : ndarray, shape (L, S, T)
        Weights of the taps; the first is 1 where there is only one.
    left_out : float or None
        Relative root-mean-square error of captured views that the lobes were not fitted to, their noise
        included: of each view by the others, or, of a fit to the material that was captured, of all. None of
        other fits, and where there are too few views.

    Raises
    ------
    ShapeError
        The arrays' shapes do not fit each other.
    RangeError
        A value is not finite, or the elevations do not ascend within (0, 1].
    """

    brdf: str
    method: str
    mu: Array
    bank: KernelBank
    weights: Array
    scale: Array
    offsets: Array
    taps: Array
    left_out: float | None = None

    def __post_init__(self) -> None:
        slices, lobes, taps = len(self.mu), len(self.weights), self.taps.shape[-1]
        expected = {
            "mu": (slices,),
            "weights": (lobes, self.weights.shape[1], len(self.bank), 3),
            "scale": (lobes, slices, 3),
            "offsets": (lobes, slices, taps, 2),
            "taps": (lobes, slices, taps),
        }
        for name, shape in expected.items():
            array = getattr(self, name)
            if array.shape != shape or 0 in shape or self.weights.shape[1] not in (1, slices):
                raise ShapeError(f"{name} of a fit has shape {array.shape}, unlike the rest: make it anew.")
            if not np.all(np.isfinite(array)):
                raise RangeError(f"{name} of a fit holds values that are not finite: make it anew.")
        if np.any(np.diff(self.mu, prepend=0.0) <= 0.0) or self.mu[-1] > 1.0:
            raise RangeError("mu of a fit does not ascend from above 0 to at most 1: make it anew.")

    @property
    def albedo(self) -> Array:
        """Directional albedo of each lobe at each elevation with all its taps, shape (L, S, 3)."""
        albedo: Array = self.weights.sum(axis=2) * self.scale * self.taps.sum(axis=2)[..., None]
        return albedo

    @property
    def used(self) -> Indices:
        """Indices of the bank's kernels that have a weight, ascending, shape (k,)."""
        return np.flatnonzero(np.any(self.weights, axis=(0, 1, 3)))

    def blunted(self, sharpest: float) -> "Fit":
        """The fit with one kernel in place of all that are sharper.

        Parameters
        ----------
        sharpest : float
            Concentration of that kernel.
        """
        kappas = tuple(sorted({min(kappa, sharpest) for kappa in self.bank.concentrations}))
        weights = np.zeros((*self.weights.shape[:2], len(kappas), 3))
        for kernel, kappa in enumerate(self.bank.concentrations):
            weights[:, :, kappas.index(min(kappa, sharpest))] += self.weights[:, :, kernel]
        return replace(self, bank=KernelBank(kappas), weights=weights)

    def lobe(self, lobe: int, elevation_slice: int, channel: int) -> ZonalLobe:
        """One profile as a lobe to filter environments with, without `scale` and `taps`.

        Parameters
        ----------
        lobe, elevation_slice, channel : int
            Below L, P and 3.
        """
        return self.bank.mixture(self.weights[lobe, elevation_slice, :, channel])

    def at(self, mu: float) -> tuple[Array, Array]:
        """The fit for one view, interpolated between elevations as a stack of maps is.

        Parameters
        ----------
        mu : float
            n.v, in (0, 1]; the normal is +Z and the mirror direction (sqrt(1 - mu^2), 0, mu).

        Returns
        -------
        axes : ndarray, shape (L * T, 3)
            Unit vectors.
        weights : ndarray, shape (L * T, K, 3)
            Weights of the kernels about each axis.
        """
        below, share = self._neighbours(mu)

        def between(array: Array) -> Array:
            above = min(below + 1, array.shape[1] - 1)
            mixed: Array = (1.0 - share) * array[:, min(below, above)] + share * array[:, above]
            return mixed

        mirror = np.array([np.sqrt(1.0 - mu**2), 0.0, mu])
        axes = lobe_axes(np.array([0.0, 0.0, 1.0]), mirror, between(self.offsets))
        profiles = between(self.weights) * between(self.scale)[:, None]
        weights = between(self.taps)[:, :, None, None] * profiles[:, None]
        return axes.reshape(-1, 3), weights.reshape(len(axes.reshape(-1, 3)), len(self.bank), 3)

    def evaluate(self, light_dir: ArrayLike, mu: float) -> Array:
        """The approximation of brdf * n.l.

        Parameters
        ----------
        light_dir : array_like, shape (..., 3)
            Unit vectors, anywhere on the sphere.
        mu : float
            As in `at`.

        Returns
        -------
        ndarray, shape (..., 3)
            [1/sr]; not 0 below the horizon, and negative in places unless no weight is.
        """
        total: Array = self.evaluate_lobes(light_dir, mu).sum(axis=0)
        return total

    def evaluate_lobes(self, light_dir: ArrayLike, mu: float) -> Array:
        """The share of each lobe in `evaluate`, shape (L, ..., 3)."""
        light_dir = np.asarray(light_dir, dtype=np.float64)
        values = np.zeros((len(self.weights), *light_dir.shape))
        taps = self.taps.shape[2]
        for index, (axis, weights) in enumerate(zip(*self.at(mu), strict=True)):
            chord = light_dir - axis
            falls = np.stack([fall.copy() for fall in self.bank.falls(0.25 * dot(chord, chord))], axis=-1)
            values[index // taps] += falls @ (self.bank.peaks[:, None] * weights)
        return values

    def _neighbours(self, mu: float) -> tuple[int, float]:
        """The elevation below `mu`, and the share of the one above."""
        if len(self.mu) == 1:
            return 0, 0.0
        below = int(np.clip(np.searchsorted(self.mu, mu) - 1, 0, len(self.mu) - 2))
        share = (mu - self.mu[below]) / (self.mu[below + 1] - self.mu[below])
        return below, float(np.clip(share, 0.0, 1.0))


def lobe_axes(normal: ArrayLike, reflect_dir: ArrayLike, offsets: ArrayLike) -> Array:
    """Axes of lobes, by their offsets from the mirror direction.

    Parameters
    ----------
    normal, reflect_dir : array_like, shapes (..., 3)
        Unit vectors.
    offsets : array_like, shape (..., 2)
        (tilt, turn): the axis lies sin(theta) * tilt radians from the mirror direction towards the normal,
        and sin(theta) * turn radians towards normal x mirror direction.

    Returns
    -------
    ndarray, shape (..., 3)
        Unit vectors.

    Notes
    -----
    sin(theta), the sine between normal and mirror direction, lets all offsets vanish where the view is along
    the normal and there is no plane of incidence: the axis is smooth there, with offsets linear in mu.
    """
    normal, reflect_dir, offsets = (np.asarray(array, np.float64) for array in (normal, reflect_dir, offsets))
    up = normal - dot(normal, reflect_dir)[..., None] * reflect_dir
    tangent = offsets[..., :1] * up + offsets[..., 1:] * np.cross(normal, reflect_dir)
    angle = np.linalg.norm(tangent, axis=-1, keepdims=True)
    axes: Array = np.cos(angle) * reflect_dir + np.sinc(angle / np.pi) * tangent
    return axes


def offsets_from_axes(normal: ArrayLike, reflect_dir: ArrayLike, axes: ArrayLike) -> Array:
    """The inverse of `lobe_axes`.

    Parameters
    ----------
    normal, reflect_dir, axes : array_like, shapes (..., 3)
        Unit vectors; normal and mirror direction differ, axes are not opposite to the mirror direction.

    Returns
    -------
    ndarray, shape (..., 2)
        (tilt, turn).
    """
    normal, reflect_dir, axes = (np.asarray(array, np.float64) for array in (normal, reflect_dir, axes))
    chord = np.linalg.norm(axes - reflect_dir, axis=-1)
    angle = 2.0 * np.arcsin(np.minimum(0.5 * chord, 1.0))
    up = normal - dot(normal, reflect_dir)[..., None] * reflect_dir
    aside = np.cross(normal, reflect_dir)
    # Across the mirror direction an axis reaches the sine of its angle
    factor = 1.0 / (np.sinc(angle / np.pi) * dot(up, up))
    return np.stack([dot(axes, up) * factor, dot(axes, aside) * factor], axis=-1)


def joined(fits: Sequence[Fit], brdf: str) -> Fit:
    """The sum of several fits, such as those of a material's layers.

    Parameters
    ----------
    fits : sequence of Fit
        At the same elevations; at least one.
    brdf : str
        The text of the whole model.

    Returns
    -------
    Fit
        All lobes of the fits, in their order, with as many taps as the fit that has most.
    """
    kappas = sorted({kappa for fit in fits for kappa in fit.bank.concentrations})
    taps = max(fit.taps.shape[2] for fit in fits)
    weights, offsets, tap_weights = [], [], []
    for fit in fits:
        padded = np.zeros((len(fit.weights), len(fit.mu), len(kappas), 3))
        padded[:, :, [kappas.index(kappa) for kappa in fit.bank.concentrations]] = fit.weights
        weights.append(padded)
        missing = taps - fit.taps.shape[2]
        offsets.append(np.pad(fit.offsets, [(0, 0), (0, 0), (0, missing), (0, 0)]))
        tap_weights.append(np.pad(fit.taps, [(0, 0), (0, 0), (0, missing)]))
    return Fit(
        brdf=brdf,
        method=fits[0].method,
        mu=fits[0].mu,
        bank=KernelBank(tuple(kappas)),
        weights=np.concatenate(weights),
        scale=np.concatenate([fit.scale for fit in fits]),
        offsets=np.concatenate(offsets),
        taps=np.concatenate(tap_weights),
    )
