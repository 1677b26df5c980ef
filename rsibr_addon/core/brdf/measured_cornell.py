"""Reflectance from scattered measurements, such as those of Cornell's goniometer, made into a table."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from ..conventions import Array
from ..errors import RangeError
from ..ties import first_greatest
from .fresnel import fresnel_schlick
from .ggx import smith_visibility
from .model import Brdf, Geometry
from .tabulated import Tabulated, half_difference_angles

SHAPE = (60, 45, 12)
"""Cells of the table's theta_h, theta_d and phi_d."""

DARKEST = 1e-5
"""[1/sr] Mean reflectance below which a sample counts as missing: the instrument stores six decimals."""

NEIGHBOURS = 8
"""Samples from which a cell is computed."""

REACHES = (3.0, 8.0, 20.0)
"""Half angles [degrees] up to which a peak may be one profile for all difference angles."""

KNOTS = 65
"""Half angles at which such a profile is computed."""

PREDICTED, BETTER = 32, 0.9
"""Samples nearest to the peak that are predicted from the others, and the greatest share of the error of
planes alone at which a profile is used."""

MOST_SAMPLES = 10_000
"""The laboratory's measurements have 1500; a table takes time in proportion, of so many some seconds."""

DIFFERENCE_SCALE, AZIMUTH_SCALE = 0.8, 0.5
"""Weights of theta_d and phi_d relative to theta_h in the distance between samples.

With eight neighbours, the others predict a sample that is left out to 4 % in the median (the lacquer cayman)
and 1.3 % (garnet red).
"""


class Facets(NamedTuple):
    """Facets that may explain a reflectance: what is not their density.

    Attributes
    ----------
    alpha : float
        Width of GGX whose shadowing they have.
    coated : bool
        Whether they reflect as a coat of index 1.5 does, or as white ones.
    """

    alpha: float
    coated: bool

    def reflectance(self, geometry: Geometry) -> Array:
        """Reflectance for a density of 1, shape (N,)."""
        visibility = smith_visibility(geometry.n_dot_l, geometry.n_dot_v, self.alpha)
        return visibility * fresnel_schlick(geometry.h_dot_l, 0.04) if self.coated else visibility


FACETS = (*(Facets(alpha, coated=True) for alpha in (0.03, 0.1, 0.3, 1.0)), Facets(1.0, coated=False))
"""From thin coats to rough metals and Lambert surfaces."""

GRAZING = 4
"""One in so many samples, those nearest to the horizon, are predicted from the others to choose `FACETS`."""


@dataclass(frozen=True, eq=False)
class Scattered(Brdf):
    """The model of scattered measurements.

    Attributes
    ----------
    density : Tabulated
        Density of the facets in each colour [1/sr]; its spec is the model's.
    facets : Facets
    """

    density: Tabulated
    facets: Facets

    @property
    def spec(self) -> str:
        """The text that stands for it: see `core.brdf.spec`."""
        return self.density.spec

    @property
    def is_noisy(self) -> bool:
        """See `Brdf`: each sample has an error of its own, which spreads over cells."""
        return True

    def above_horizon(self, geometry: Geometry) -> Array:
        """See `Brdf`."""
        return self.density.above_horizon(geometry) * self.facets.reflectance(geometry)[:, None]


def scattered_brdf(light_dir: Array, view_dir: Array, brdf: Array, spec: str) -> Scattered:
    """The isotropic model of scattered measurements.

    Parameters
    ----------
    light_dir, view_dir : ndarray, shape (N, 3)
        Unit vectors above the horizon; more than `NEIGHBOURS` pairs.
    brdf : ndarray, shape (N, 3)
        Measured reflectance [1/sr] in linear Rec. 709, at least 0; samples below `DARKEST` are left out.
    spec : str
        The text that stands for it.

    Returns
    -------
    Scattered
        Reciprocal, and the same on both sides of the plane of incidence.

    Raises
    ------
    RangeError
        Too few samples are above `DARKEST`.

    Notes
    -----
    Planes are fitted to the nearest samples (moving least squares) in the half and difference angles of
    [Rusinkiewicz1998], where lobes stay in place while the view moves. The planes fit the logarithm of the
    density of facets that would explain the reflectance. It hardly changes along theta_d, so the few samples
    that hit a sharp peak tell about all its elevations. The facets are those of `FACETS` by which the samples
    nearest to the horizon are predicted best from the others: elevations beyond what was measured follow
    from these in the same way. Where it predicts left-out samples better, planes are fitted to what a profile
    over theta_h alone leaves. A fit never leaves the range of its samples.
    """
    bright = brdf.mean(axis=1) >= DARKEST
    if np.count_nonzero(bright) <= NEIGHBOURS:
        raise RangeError(
            f"A measured reflectance needs more than {NEIGHBOURS} samples above {DARKEST:g} per sr."
        )
    if len(brdf) > MOST_SAMPLES:
        raise RangeError(f"A reflectance of {len(brdf)} samples takes too long: keep {MOST_SAMPLES} at most.")
    geometry, brdf = Geometry(light_dir[bright], view_dir[bright]), brdf[bright]
    places = _coordinates(*half_difference_angles(geometry))
    brightness = brdf.sum(axis=1)
    hues = brdf / brightness[:, None]
    facets = _best_facets(geometry, places, brightness)
    density = np.log(brightness / facets.reflectance(geometry))
    predicted = _predictor(places, density, hues, _best_reach(places, density, hues))
    # phi_d and pi - phi_d are mirror images: half of the azimuths give the other half
    half_angle = ((np.arange(SHAPE[0]) + 0.5) / SHAPE[0]) ** 2 * (np.pi / 2.0)
    difference_angle = (np.arange(SHAPE[1]) + 0.5)[:, None] / SHAPE[1] * (np.pi / 2.0)
    azimuth = (np.arange(SHAPE[2] // 2) + 0.5) / SHAPE[2] * np.pi
    table = np.empty((*SHAPE[:2], SHAPE[2] // 2, 3))
    for row, theta_h in zip(table, half_angle, strict=True):
        cells = _coordinates(*np.broadcast_arrays(theta_h, difference_angle, azimuth))
        log_density, hue = predicted(cells.reshape(-1, 3))
        row[:] = (np.exp(log_density)[:, None] * hue).reshape(row.shape)
    return Scattered(Tabulated(np.concatenate([table, table[:, :, ::-1]], axis=2), spec), facets)


def _coordinates(theta_h: Array, theta_d: Array, phi_d: Array) -> Array:
    """Coordinates of samples in which reflectance is smooth, shape (..., 3)."""
    half = np.sqrt(theta_h * (2.0 / np.pi))
    # The azimuth means nothing where either angle is 0; it has the period pi and is even
    azimuth = AZIMUTH_SCALE * half * np.sin(theta_d) * np.cos(2.0 * phi_d)
    return np.stack([half, DIFFERENCE_SCALE * theta_d * (2.0 / np.pi), azimuth], axis=-1)


def _best_facets(geometry: Geometry, places: Array, brightness: Array) -> Facets:
    """The facets by which samples near the horizon are predicted best, in the root of the light they reflect.

    The root lets neither the peak's few samples decide alone, nor the many dark ones.
    """
    lowest = np.minimum(geometry.n_dot_l, geometry.n_dot_v)
    grazing, others = np.split(np.argsort(lowest, kind="stable"), [len(lowest) // GRAZING])
    root = np.sqrt(brightness * np.sqrt(geometry.n_dot_l * geometry.n_dot_v))[grazing]
    unhued = np.ones((len(others), 1))
    missed = np.zeros(len(FACETS))
    for row, facets in enumerate(FACETS):
        density = np.log(brightness / facets.reflectance(geometry))
        found, _ = _fit(places[grazing], places[others], density[others], unhued)
        missed[row] = np.sum((np.expm1(0.5 * (found - density[grazing])) * root) ** 2)
    return FACETS[first_greatest(-missed)]


def _best_reach(places: Array, density: Array, hues: Array) -> float:
    """The reach [degrees] of the peak's profile that predicts left-out samples best; 0 where none does."""
    reaches = (0.0, *REACHES)
    missed = np.zeros(len(reaches))
    for index in np.argsort(places[:, 0], kind="stable")[:PREDICTED]:
        others = np.arange(len(density)) != index
        for row, reach in enumerate(reaches):
            predicted = _predictor(places[others], density[others], hues[others], reach)
            found, _ = predicted(places[index : index + 1])
            missed[row] += (found[0] - density[index]) ** 2
    best = first_greatest(-missed)
    return reaches[best] if missed[best] < BETTER**2 * missed[0] else 0.0


def _predictor(
    places: Array, density: Array, hues: Array, reach: float
) -> Callable[[Array], tuple[Array, Array]]:
    """What gives the logarithm of density, shape (P,), and hues at some `_coordinates`, shape (P, 3)."""
    if not reach:
        return lambda points: _fit(points, places, density, hues)
    knots = np.linspace(0.0, np.sqrt(reach / 90.0), KNOTS)
    profile, _ = _fit(knots[:, None], places[:, :1], density, hues)

    def peak(points: Array) -> Array:
        values: Array = np.interp(points[:, 0], knots, profile)
        return values

    rest = density - peak(places)

    def predicted(points: Array) -> tuple[Array, Array]:
        value, hue = _fit(points, places, rest, hues)
        return value + peak(points), hue

    return predicted


def _fit(points: Array, samples: Array, values: Array, hues: Array) -> tuple[Array, Array]:
    """Planes through the nearest samples' values, and the weighted means of their hues."""
    squared = np.zeros((len(points), len(samples)))
    for point, sample in zip(points.T, samples.T, strict=True):
        squared += (point[:, None] - sample) ** 2
    count = min(NEIGHBOURS, len(samples) - 1)
    nearest = np.argpartition(squared, count, axis=1)[:, : count + 1]
    offset = samples[nearest] - points[:, None]
    distance = np.linalg.norm(offset, axis=2)
    # The weight falls to (almost) 0 at the farthest sample, so that neighbours are replaced without a jump
    weight = (1.0 - 0.999 * distance / np.maximum(distance.max(axis=1, keepdims=True), 1e-12)) ** 2
    weight /= weight.sum(axis=1, keepdims=True)
    design = np.concatenate([np.ones_like(distance)[..., None], offset], axis=2)
    weighted = design * weight[..., None]
    ridge = 1e-6 * np.eye(design.shape[2])
    near = values[nearest]
    normal_matrix = np.einsum("pki,pkj->pij", weighted, design) + ridge
    plane = np.linalg.solve(normal_matrix, np.einsum("pki,pk->pi", weighted, near)[..., None])
    value = np.clip(plane[:, 0, 0], near.min(axis=1), near.max(axis=1))
    return value, np.einsum("pk,pkc->pc", weight, hues[nearest])
