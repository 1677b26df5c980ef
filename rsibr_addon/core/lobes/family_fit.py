"""Fits families: lobes tracked over widths as over elevations, then smoothed, thinned, and solved.

The axes are fitted to a few materials together, the guides, such as a white metal and a dielectric, each
scaled to like power. For given axes the weights of all channels are one linear system (`projection`); which
kernels count is decided by the guides too (`thinning`).
"""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ..brdf.cook_torrance import CookTorrance
from ..brdf.fresnel import Schlick
from ..brdf.fresnel_powers import POWERS, dielectric, powers_of, schlick
from ..brdf.model import BrdfFunction, Geometry
from ..brdf.oren_nayar import tilt
from ..brdf.principled import ggx_by_powers
from ..brdf.ward import Ward
from ..conventions import Array
from ..progress import Progress, Steps
from .bank import KernelBank
from .family import KERNELS, Family
from .joint import MOST_AMPLIFICATION, State, added_lobe, amplification, settled, tilts_of, tracked
from .natural_light import natural_equations
from .projection import UNIFORM_LIGHT, Lookups, Projector
from .smoothing import lines
from .target import TargetSlice, elevation_slices, target_slices
from .thinning import Equations, solution, thinned

WIDTHS = 2.0 ** np.linspace(-8.0, 0.0, 49)
"""alpha of the rows of the GGX family, six an octave."""

ELEVATIONS, LOBES, LEANING_LOBES, CLOSER_LOBES = 16, 4, 2, 8

GUIDES = np.stack([schlick(1.0), dielectric(1.5)], axis=1)
"""A white metal and glass, as coefficients of `POWERS`, shape (C, 2)."""

GAUSSIAN_GUIDES = np.array([[1.0, 0.0], [0.0, 0.04], [0.0, 0.96]])
"""Ward's model, and a dielectric's of Beckmann's facets."""

SMOOTHNESS = 0.1
"""Price of tilts' squared distance from the line between their neighbours'."""

_SHARPNESS = 16.0
_FIRST_ELEVATION = 0.25
_STIFFER, _STIFFEST = 1.4, 1e4


@dataclass(frozen=True)
class Refinement:
    """What a family is fitted for beside the squared error of its lobes.

    Attributes
    ----------
    finer : int
        Elevations of the family for each at which axes are fitted; from 2 onwards they are those of
        `elevation_slices`.
    thrift : float
        Share by which the squared error may rise for fewer kernels: see `thinned`; 0 keeps all that a width
        needs.
    natural : float
        Weight of an error in an octave of natural light, relative to the same error of the lobe's shape.
    reach : float
        Largest tilt of an axis, in widths alpha; where it is finite, tilts are smoothed in that unit. A lobe
        that leaves the peak at one elevation has a long way back at the next, where it is needed.
    start : float
        Width alpha at which lobes are added; all others are tracked from there.
    """

    finer: int = 1
    thrift: float = 0.0
    natural: float = 0.0
    reach: float = np.inf
    start: float = 0.25


SQUARED_ERROR = Refinement()
"""Fits all kernels to the squared error alone."""

OF_GGX = Refinement(finer=2, thrift=0.02, natural=4.0, reach=3.0, start=2.0**-4.5)
"""Begins where lobes are narrow: in units of alpha they are alike, and keep their order at all elevations."""


def fit_leaning(elevations: int = ELEVATIONS, lobes: int = LEANING_LOBES) -> Steps[Family]:
    """The family of what leaning facets add to diffuse reflection: `oren_nayar.tilt`, of one width, 1."""
    return (
        yield from fit_family(
            lambda _: _above(lambda pair: tilt(pair.n_dot_l, pair.n_dot_v, pair.l_dot_v)[:, None]),
            np.ones((1, 1)),
            np.ones(1),
            elevation_slices(elevations),
            lobes,
            Refinement(thrift=0.06),
        )
    )


def fit_ggx(widths: Array = WIDTHS, elevations: int = ELEVATIONS, lobes: int = LOBES) -> Steps[Family]:
    """The family of GGX reflection by alpha, (A,), ascending, for Fresnel terms that are sums of `POWERS`."""
    mu = elevation_slices(elevations)
    return (yield from fit_family(_ggx, GUIDES, widths, mu, lobes, OF_GGX))


def fit_gaussian(
    widths: Array = WIDTHS[6::3], elevations: int = ELEVATIONS, lobes: int = LOBES
) -> Steps[Family]:
    """The same of lobes that end sooner than GGX's: Ward's, and Beckmann's times 1 and (1 - cos)^5."""
    return (yield from fit_family(_gaussian, GAUSSIAN_GUIDES, widths, elevation_slices(elevations), lobes))


def fit_closer_ggx(alpha: float) -> Steps[Family]:
    """The family of `fit_ggx` of one alpha, with `CLOSER_LOBES`, which are closer at grazing above all."""
    return (yield from _fit_closer(_ggx, GUIDES, alpha))


def fit_closer_gaussian(alpha: float) -> Steps[Family]:
    """The family of `fit_gaussian` of one alpha, with `CLOSER_LOBES`."""
    return (yield from _fit_closer(_gaussian, GAUSSIAN_GUIDES, alpha))


def _fit_closer(model: Callable[[float], BrdfFunction], guides: Array, alpha: float) -> Steps[Family]:
    return (
        yield from fit_family(model, guides, np.array([alpha]), elevation_slices(ELEVATIONS), CLOSER_LOBES)
    )


def fit_family(
    model: Callable[[float], BrdfFunction],
    guides: Array,
    widths: Array,
    mu: Array,
    lobes: int,
    refinement: Refinement = SQUARED_ERROR,
) -> Steps[Family]:
    """Fit lobes to functions at all widths.

    Parameters
    ----------
    model : callable
        From a width to C functions, called like a `Brdf`.
    guides : ndarray, shape (C, G)
        Materials whose lobes the axes are fitted to, as coefficients of the functions.
    widths : ndarray, shape (A,)
    mu : ndarray, shape (S,)
        Cosines of the view elevations that axes are fitted at, ascending.
    lobes : int
        Number J of lobes.
    refinement : Refinement
    """
    finer, natural = refinement.finer, refinement.natural
    tilts, rows = yield from _tracked_tilts(model, guides, widths, mu, lobes, refinement)
    # Beside tilts of wide lobes, those of narrow ones would not count
    unit = widths[:, None, None] if np.isfinite(refinement.reach) else 1.0
    tilts = unit * smoothed(tilts / unit, np.log(widths), mu, SMOOTHNESS)
    if finer > 1:
        coarse, mu = mu, elevation_slices(finer * len(mu))
        tilts = np.apply_along_axis(lambda column: np.interp(mu, coarse, column), 1, tilts)
        rows = {row: list(target_slices(model(float(widths[row])), mu)) for row in rows}
    yield Progress(len(widths), 2 * len(widths), "leaving out what hardly counts")
    kept = _kept(rows, tilts, widths, guides, refinement)
    weights = np.zeros((*tilts.shape, len(KERNELS), len(guides)))
    for row in range(len(widths)):
        yield Progress(len(widths) + row, 2 * len(widths), f"solving for weights at alpha {widths[row]:.3g}")
        bank = kernels_of(widths[row])
        for column, target in enumerate(rows[row]):
            solved = _solved(target, bank, tilts[row, column], guides, kept[row, : len(bank)], natural)
            weights[row, column, :, : len(bank)] = solved
    return Family(widths, mu, KERNELS, tilts, weights)


def _tracked_tilts(
    model: Callable[[float], BrdfFunction],
    guides: Array,
    widths: Array,
    mu: Array,
    lobes: int,
    refinement: Refinement,
) -> Steps[tuple[Array, dict[int, list[TargetSlice]]]]:
    """Tilts of the lobes at each width and elevation, shape (A, S, J), and the targets of each width."""
    start = int(np.argmin(np.abs(np.log(widths / refinement.start))))
    tilts: Array = np.empty((len(widths), len(mu), lobes))
    rows: dict[int, list[TargetSlice]] = {}
    outwards = [*range(start, len(widths)), *range(start - 1, -1, -1)]
    for done, row in enumerate(outwards):
        yield Progress(done, 2 * len(widths), f"tracking lobes at alpha {widths[row]:.3g}")
        rows[row] = list(target_slices(model(float(widths[row])), mu))
        guided = [_guided(target, guides) for target in rows[row]]
        bank = kernels_of(widths[row])
        if row == start:
            first = int(_FIRST_ELEVATION * len(mu))
            projector = Projector(guided[first], bank)
            angles: Array = np.zeros((0, 1))
            for _ in range(lobes):
                angles = added_lobe(projector, angles)
            states = tracked(guided, bank, Lookups(angles, np.ones_like(angles)), first, non_negative=False)
        else:
            neighbour = tilts[row - 1 if row > start else row + 1]
            states = [
                settled(target, bank, _lookups(target, each), non_negative=False)
                for target, each in zip(guided, neighbour, strict=True)
            ]
        found = [
            tilts_of(target, state.lookups.angles)[:, 0] for target, state in zip(guided, states, strict=True)
        ]
        reach = refinement.reach * widths[row]
        tilts[row] = np.clip(found, -reach, reach)
    return tilts, rows


def _ggx(alpha: float) -> BrdfFunction:
    """GGX times each of `POWERS`."""
    return _above(lambda pair: ggx_by_powers(pair, alpha))


def _gaussian(alpha: float) -> BrdfFunction:
    """Ward's model, and Beckmann's facets of two Fresnel terms."""
    ward, beckmann = Ward(alpha=alpha, ks=1.0), CookTorrance(alpha=alpha, fresnel=Schlick(f0=1.0))

    def functions(pair: Geometry) -> Array:
        facets = beckmann.above_horizon(pair)[:, :1]
        rise = powers_of(pair.h_dot_l)[:, [POWERS.index(5)]]
        return np.concatenate([ward.glossy(pair)[:, :1], facets, facets * rise], axis=1)

    return _above(functions)


def _above(model: Callable[[Geometry], Array]) -> BrdfFunction:
    """A model of several channels above the horizon, called like a `Brdf`."""

    def brdf(light_dir: Array, view_dir: Array) -> Array:
        light_dir, view_dir = np.broadcast_arrays(light_dir, view_dir)
        above = (light_dir[..., 2] > 0.0) & (view_dir[..., 2] > 0.0)
        values = model(Geometry(light_dir[above], view_dir[above]))
        found = np.zeros((*light_dir.shape[:-1], values.shape[1]))
        found[above] = values
        return found

    return brdf


def kernels_of(alpha: float) -> KernelBank:
    """The kernels of `KERNELS` that lobes of alpha, above 0, need."""
    return KernelBank(tuple(kappa for kappa in KERNELS.concentrations if kappa <= (_SHARPNESS / alpha) ** 2))


def smoothed(tilts: Array, rows: Array, columns: Array, price: float) -> Array:
    """Tilts that are nearer to lines over both axes.

    Parameters
    ----------
    tilts : ndarray, shape (A, S, J)
    rows, columns : ndarray, shapes (A,) and (S,)
        Positions of the samples.
    price : float
        Of the squared distance of tilts from the line between their neighbours', in units of their own
        squared change.
    """
    along, across = lines(rows), lines(columns)
    penalty = np.kron(along.T @ along, np.eye(len(columns))) + np.kron(np.eye(len(rows)), across.T @ across)
    flat = tilts.reshape(len(penalty), -1)
    smooth: Array = np.linalg.solve(np.eye(len(penalty)) + price * penalty, flat).reshape(tilts.shape)
    return smooth


def _guided(target: TargetSlice, guides: Array) -> TargetSlice:
    """The guides as a target, each of unit power."""
    power = target.weight @ (target.lobe @ guides) ** 2
    return _mixed(target, guides / np.sqrt(power))


def _mixed(target: TargetSlice, coefficients: Array) -> TargetSlice:
    """Sums of the channels as a target."""
    lobe = target.lobe @ coefficients
    power = float(np.sum(target.weight @ lobe**2))
    return replace(target, lobe=lobe, albedo=target.weight @ lobe, power=power)


def _lookups(target: TargetSlice, tilts: Array) -> Lookups:
    angles = (target.theta - tilts * np.sin(target.theta))[:, None]
    return Lookups(angles, np.ones_like(angles))


def _kept(
    rows: dict[int, list[TargetSlice]],
    tilts: Array,
    widths: Array,
    guides: Array,
    refinement: Refinement,
) -> NDArray[np.bool_]:
    """Which kernels count at each width, shape (A, K)."""
    kept = np.stack([np.arange(len(KERNELS)) < len(kernels_of(width)) for width in widths])
    if refinement.thrift == 0.0:
        return kept
    equations: list[list[Equations]] = []
    for row, width in enumerate(widths):
        bank, used = kernels_of(width), np.tile(kept[row], tilts.shape[2])
        equations.append([])
        for target, each in zip(rows[row], tilts[row], strict=True):
            projector, lookups = Projector(_guided(target, guides), bank), _lookups(target, each)
            system, right = own = projector.equations(lookups)
            error = 1.0 + UNIFORM_LIGHT - np.sum(right * np.linalg.solve(system, right))
            system, right = _with_natural_light(own, projector, lookups, refinement.natural)
            # Each elevation's error counts by itself: those of steep views are far larger than the others
            equations[row].append(_spread_out(system / error, right / error, used))
    errors = np.full(len(widths), float(tilts.shape[1]))
    return kept & thinned(equations, errors, refinement.thrift, len(KERNELS))


def _spread_out(system: Array, right: Array, used: NDArray[np.bool_]) -> Equations:
    """Equations of more unknowns, of which those that are not used are 0."""
    wider, of_all = np.eye(len(used)), np.zeros((len(used), right.shape[1]))
    wider[np.ix_(used, used)], of_all[used] = system, right
    return wider, of_all


def _with_natural_light(own: Equations, projector: Projector, lookups: Lookups, natural: float) -> Equations:
    """The equations of a projector, with those of natural light."""
    if natural == 0.0:
        return own
    system, right = own
    more, of_more = natural_equations(projector.target, projector.bank, lookups, natural)
    return system + more, right + of_more


def _solved(
    target: TargetSlice,
    bank: KernelBank,
    tilts: Array,
    guides: Array,
    kept: NDArray[np.bool_],
    natural: float,
) -> Array:
    """Weights of kernels, shape (J, K, C), for given axes; no guide is amplified too much.

    kept: shape (K,), those that count; the others are 0.
    """
    lookups, projector = _lookups(target, tilts), Projector(target, bank)
    own = projector.equations(lookups)
    system, right = _with_natural_light(own, projector, lookups, natural)
    stiffness, ridge = 1.0, np.zeros_like(system)
    while True:
        found = solution((system + (stiffness - 1.0) * ridge, right), kept)
        weights = projector.weights(found.reshape(len(tilts), len(bank), -1))
        loudest = max(
            amplification(bank, State(lookups, weights @ guide, np.nan), _mixed(target, guide))
            for guide in guides.T[:, :, None]
        )
        if loudest <= MOST_AMPLIFICATION or stiffness > _STIFFEST:
            return weights
        if stiffness == 1.0:  # ridges are in proportion to it
            ridge = Projector(target, bank, 2.0).equations(lookups)[0] - own[0]
        stiffness *= _STIFFER
