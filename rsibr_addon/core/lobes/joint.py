"""The joint fit: all profiles at once, with axes by variable projection, tracked over the elevations.

Fits grow lobe by lobe. A new lobe is tried at every angle, and by spreading the present lobes; the better
start is followed to its optimum at one elevation. Taps start there from several spreads, and the best result
is kept. From there the fit goes on to grazing and to normal incidence, each elevation starting from its
neighbour's tilts.

A fit is the same on every processor, although the last bits of sums are not: no step depends on rounding.
Taps have one scale, axes are tied to their start, and of equal results the first is taken.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..conventions import Array
from .bank import SHARP, SHARPEST, KernelBank, octaves
from .descent import descend
from .fit import Fit
from .projection import Lookups, Projection, Projector
from .smoothing import smoothed_lookups, smoothed_weights
from .target import TargetSlice

MOST_AMPLIFICATION, MOST_OF_ONE = 8.0, 2.0
"""Greatest `amplification` of several lobes, and of the taps of one; ridges grow until it is kept."""

_SHARPNESS, _THINNEST, _CORE, _ACROSS = 20.0, 3.0, 1.66, 2.0
_START = 0.25
_ANGLES = np.linspace(-0.5 * np.pi, 0.5 * np.pi, 33)
_TIE = 1.0
_SPREADS, _TIES = (0.5, 1.0, 2.0), (_TIE, 0.01)
_BETTER = 0.99
_STIFFER = 1.4


@dataclass(frozen=True)
class State:
    """The fit at one elevation.

    Attributes
    ----------
    lookups : Lookups
    weights : ndarray, shape (J, K, C)
        Weights of the kernels.
    error : float
        sqrt(integral of |fit - target|^2 / integral of |target|^2), with what ridges add to it.
    """

    lookups: Lookups
    weights: Array
    error: float


def bank_for(slices: Sequence[TargetSlice], sharpest: float = SHARPEST) -> KernelBank:
    """Kernels for targets in ascending order of elevation, none sharper than asked for.

    Down to a 20th of the last lobe's width, for its peak, or a third of the thinnest one's, but not beyond
    `SHARP`; and down to half the width of the thinnest core, for a peak on a broad base. A core that takes
    kernels beyond `SHARP` gets kernels half as wide: towards grazing it is thinner across than along.
    """
    thinnest, core = (min(getattr(target, width) for target in slices) for width in ("radius", "core"))
    whole = max(_SHARPNESS / slices[-1].radius, _THINNEST / thinnest) ** 2
    within = (_CORE / core) ** 2
    if within > SHARP:
        within *= _ACROSS**2
    return octaves(min(max(min(whole, SHARP), within), sharpest))


class JointFitter:
    """Fits lobes to one model, one lobe more at a time.

    Parameters
    ----------
    slices : sequence of TargetSlice
        In ascending order of elevation.
    brdf : str
        The text of the model.
    non_negative : bool
        Whether no kernel may have a negative weight.
    sharpest : float
        Concentration that no kernel exceeds, one of `octaves`.
    """

    def __init__(
        self,
        slices: Sequence[TargetSlice],
        brdf: str,
        non_negative: bool = False,
        sharpest: float = SHARPEST,
    ) -> None:
        self._slices, self._brdf = slices, brdf
        self._non_negative = non_negative
        self._bank = bank_for(slices, sharpest)
        self._first = int(_START * len(slices))
        self._projector = Projector(slices[self._first], self._bank, non_negative=non_negative)
        self._angles: Array = np.zeros((0, 1))

    @property
    def lobes(self) -> int:
        """Number of lobes, at first 0."""
        return len(self._angles)

    def grow(self) -> None:
        """Add a lobe, at the elevation where tracking begins."""
        self._angles = added_lobe(self._projector, self._angles)

    def smooth(self, fit: Fit, price: float) -> Fit:
        """The same lobes, with axes and profiles that change more evenly over the elevations.

        Parameters
        ----------
        fit : Fit
            Result of `fit`.
        price : float
            See `smoothing`.
        """
        tilts = fit.offsets[..., 0].swapaxes(0, 1)
        tracked = [
            Lookups(target.theta - each * np.sin(target.theta), taps)
            for target, each, taps in zip(self._slices, tilts, fit.taps.swapaxes(0, 1), strict=True)
        ]
        lookups = smoothed_lookups(self._slices, tracked, price)
        stiffness = np.ones(len(self._slices))
        while True:  # See `settled`
            projectors = [
                Projector(target, self._bank, each)
                for target, each in zip(self._slices, stiffness, strict=True)
            ]
            weights = smoothed_weights(projectors, lookups, price)
            states = [State(*both, np.nan) for both in zip(lookups, weights, strict=True)]
            quiet = [is_quiet(self._bank, *both) for both in zip(states, self._slices, strict=True)]
            if all(quiet):
                return _fit(self._slices, self._bank, states, self._brdf)
            stiffness[~np.array(quiet)] *= _STIFFER

    def fit(self, taps: int = 1) -> tuple[Fit, Array]:
        """Track the lobes, at least one, over all elevations.

        Parameters
        ----------
        taps : int
            Directions in which each lobe's map is looked up.

        Returns
        -------
        fit : Fit
        errors : ndarray, shape (S,)
            `State.error` of each elevation.
        """
        start = _best_taps(self._projector, self._angles, taps)
        states = tracked(self._slices, self._bank, start, self._first, self._non_negative)
        return _fit(self._slices, self._bank, states, self._brdf), np.array([state.error for state in states])


def amplification(bank: KernelBank, state: State, target: TargetSlice) -> float:
    """Norms of all lobes with their taps, added up, over the norm of their sum.

    Returns
    -------
    float
        Sum over lobes of sqrt(integral of lobe^2) * sum of |taps|, over sqrt(integral of target^2). A
        relative error of each map, such as 2^-11 of half floats, becomes at most so many times larger in the
        sum.
    """
    own = bank.products(np.zeros(()))[0]
    loudness = np.sqrt(np.einsum("jkc,kl,jlc->j", state.weights, own, state.weights))
    total = np.sum(loudness * np.abs(state.lookups.taps).sum(axis=1))
    return float(total / np.sqrt(target.power))


def is_quiet(bank: KernelBank, state: State, target: TargetSlice) -> bool:
    """Whether the fit at one elevation keeps the greatest amplification."""
    most = MOST_AMPLIFICATION if len(state.lookups.taps) > 1 else MOST_OF_ONE
    return amplification(bank, state, target) <= most


def added_lobe(projector: Projector, angles: Array) -> Array:
    """The best angles with one lobe more.

    Parameters
    ----------
    projector : Projector
    angles : ndarray, shape (J, 1)
        Angles of the present lobes from the normal [rad].

    Returns
    -------
    ndarray, shape (J + 1, 1)
    """
    candidates = [np.append(angles, [[angle]], axis=0) for angle in _ANGLES]
    starts = [min((Lookups(start, np.ones_like(start)) for start in candidates), key=projector.objective)]
    if len(angles):
        spread = _spread(angles.T, projector.target.radius).T
        starts.append(Lookups(spread, np.ones_like(spread)))
    return _first_of_the_best([descend(projector, start, with_taps=False) for start in starts]).angles


def _best_taps(projector: Projector, angles: Array, taps: int) -> Lookups:
    """Taps about given angles, shape (J, 1), from several distances between them.

    Taps are tied to their start, first strongly, then more loosely. Without ties they run through long
    valleys in steps whose direction rounding decides, and end in another place on every processor.
    """
    if taps == 1:
        return Lookups(angles, np.ones_like(angles))
    settled = []
    for spread in _SPREADS:
        apart = angles + spread * projector.target.radius * np.linspace(-0.5, 0.5, taps)
        lookups = Lookups(apart, np.full(apart.shape, 1.0 / taps))
        for tie in _TIES:
            lookups, projection = descend(projector, lookups, with_taps=True, tie=tie)
        settled.append((lookups, projection))
    return _first_of_the_best(settled)


def _first_of_the_best(settled: Sequence[tuple[Lookups, Projection]]) -> Lookups:
    """The first that is as good as the best or nearly so: among equals, rounding would choose."""
    best = settled[0]
    for each in settled[1:]:
        if each[1].objective < _BETTER * best[1].objective:
            best = each
    return best[0]


def _spread(angles: Array, width: float) -> Array:
    """Angles in rows, each row with one more of the same distribution; single ones part by `width`."""
    count = angles.shape[1]
    if count == 1:
        return angles + width * np.array([-0.5, 0.5])
    ordered = np.sort(angles, axis=1)
    position = (np.arange(count + 1) + 0.5) / (count + 1) * count - 0.5
    below = np.clip(np.floor(position).astype(np.intp), 0, count - 2)
    share = position - below
    spread: Array = (1.0 - share) * ordered[:, below] + share * ordered[:, below + 1]
    return spread


def tracked(
    slices: Sequence[TargetSlice], bank: KernelBank, start: Lookups, first: int, non_negative: bool
) -> list[State]:
    """The fit at every elevation, each from its neighbour's tilts.

    Parameters
    ----------
    slices : sequence of TargetSlice
        In ascending order of elevation.
    bank : KernelBank
    start : Lookups
        Where the fit begins, at the elevation of number `first`.
    first : int
    non_negative : bool
        Whether no kernel may have a negative weight.

    Returns
    -------
    list of State
        One for each elevation.
    """
    states: dict[int, State] = {}
    for order in (range(first, len(slices)), range(first - 1, -1, -1)):
        neighbour = first
        for index in order:
            lookups = states[neighbour].lookups if states else start
            tilts = tilts_of(slices[neighbour], lookups.angles)
            angles = slices[index].theta - tilts * np.sin(slices[index].theta)
            states[index] = settled(slices[index], bank, Lookups(angles, lookups.taps), non_negative)
            neighbour = index
    return [states[index] for index in range(len(slices))]


def settled(target: TargetSlice, bank: KernelBank, lookups: Lookups, non_negative: bool) -> State:
    """The nearest optimum that keeps the greatest amplification.

    Parameters
    ----------
    target : TargetSlice
    bank : KernelBank
    lookups : Lookups
        Where to start, and what axes and taps are tied to.
    non_negative : bool
        Whether no kernel may have a negative weight.
    """
    stiffness, with_taps = 1.0, lookups.taps.shape[1] > 1
    while True:
        projector = Projector(target, bank, stiffness, non_negative)
        lookups, projection = descend(projector, lookups, with_taps, _TIE)
        state = State(lookups, projection.weights, float(np.sqrt(max(projection.objective, 0.0))))
        if is_quiet(bank, state, target):
            return state
        stiffness = _quiet_stiffness(projector, lookups, stiffness)


def _quiet_stiffness(projector: Projector, lookups: Lookups, stiffness: float) -> float:
    """How stiff ridges must be for quiet profiles about the same axes: a solution each, no descent."""
    while True:  # Ridges that grow bring every weight, and so the amplification, to 0
        stiffness *= _STIFFER
        stiffer = Projector(projector.target, projector.bank, stiffness, projector.non_negative)
        state = State(lookups, stiffer.profiles(lookups), np.nan)
        if is_quiet(projector.bank, state, projector.target):
            return stiffness


def tilts_of(target: TargetSlice, angles: Array) -> Array:
    """Offsets of axes from the mirror direction.

    Parameters
    ----------
    target : TargetSlice
    angles : ndarray, any shape
        The axes' angles from the normal, towards the mirror direction [rad].

    Returns
    -------
    ndarray, shape of `angles`
        As `fit.lobe_axes` counts them.
    """
    tilts: Array = (target.theta - angles) / np.sin(target.theta)
    return tilts


def _fit(slices: Sequence[TargetSlice], bank: KernelBank, states: Sequence[State], brdf: str) -> Fit:
    weights = np.stack([state.weights for state in states], axis=1)
    taps = np.stack([state.lookups.taps for state in states], axis=1)
    tilts = [tilts_of(target, state.lookups.angles) for target, state in zip(slices, states, strict=True)]
    offsets = np.stack([np.stack(tilts, axis=1), np.zeros_like(taps)], axis=-1)
    # One sign at all elevations, or interpolation between them would cancel lobes
    sign = np.where(taps.sum(axis=(1, 2), keepdims=True) < 0.0, -1.0, 1.0)
    total = sign * np.abs(taps).sum(axis=2, keepdims=True)
    return Fit(
        brdf=brdf,
        method="joint",
        mu=np.array([target.mu for target in slices]),
        bank=bank,
        weights=weights * total[..., None],
        scale=np.ones((*taps.shape[:2], 3)),
        offsets=offsets,
        taps=taps / total,
    )
