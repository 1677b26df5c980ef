"""The sum of a few known reflectances that is most like what was captured."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np

from ..conventions import Array
from .bank import KernelBank
from .captured_light import CapturedLight
from .captured_texels import CapturedTexels, seen_functions
from .family import Family
from .nonnegative import nonnegative_inverse

WIDTHS = 2
"""Most members of a likeness."""

PAYS = 0.7
"""Greatest share of the squared error that one member more may leave to be kept."""

FUNCTIONS = 3
"""Functions of each family that a likeness takes: of GGX, Fresnel terms 1, (1 - cos)^2 and (1 - cos)^5.
Further powers differ too little to be told from captures.
"""

SUNS_TELL = 2.0**0.5
"""Factor by which images of suns may change the least width: errors then count as they are."""

_COARSE = 3
_GOLDEN, _STEPS = 0.5 * (5.0**0.5 - 1.0), 7
_RANK = 1e-9


@dataclass(frozen=True, eq=False)
class Member:
    """One width of a family of lobes."""

    family: Family
    alpha: float

    @property
    def tilts(self) -> Array:
        """Tilts of the J axes at the family's S elevations, shape (S, J)."""
        return self.family.at(self.family.tilts, self.alpha, self.family.mu)

    def weights(self, bank: KernelBank) -> Array:
        """Weights of a bank's kernels for each of the `FUNCTIONS` first functions, shape (S, J, K, C).

        The bank holds the first K kernels of the family; the last stands for those that are sharper.
        """
        every, count = self.family.at(self.family.weights, self.alpha, self.family.mu), len(bank)
        weights = every[:, :, :count, :FUNCTIONS].copy()
        weights[:, :, -1] += every[:, :, count:, :FUNCTIONS].sum(axis=2)
        return weights


def likeness(
    texels: CapturedTexels, radiance: Array, light: CapturedLight, families: Sequence[Family], thinnest: float
) -> list[Member]:
    """The members of families that are most like a captured radiance.

    Parameters
    ----------
    texels : CapturedTexels
    radiance : ndarray, shape (N, 3)
    light : CapturedLight
    families : sequence of Family
    thinnest : float
        Least alpha.

    Returns
    -------
    list of Member
        At least one, at most `WIDTHS`: one after another, while each `PAYS`. The best is sought among some
        widths of every family, then between their neighbours by golden section. The narrowest is the last;
        its width is sought once more, as `SUNS_TELL` says.
    """
    kept: dict[tuple[int, float], Array] = {}

    def seen(member: Member) -> Array:
        key = id(member.family), member.alpha
        if key not in kept:
            kept[key] = seen_functions(
                texels, light, member.family.mu, member.tilts, member.weights(light.filtered.bank)
            )
        return kept[key]

    def error(weight: Array, members: Sequence[Member]) -> float:
        every = np.concatenate([seen(member) for member in members], axis=1)
        rest = radiance - np.einsum("npc,pc->nc", every, factors(every, radiance))
        return float(np.sum((weight * rest) ** 2))

    relative = partial(error, relative_weight(radiance))
    found: list[Member] = []
    least = np.inf
    while len(found) < WIDTHS:
        with_one = partial(_with_one, relative, tuple(found))
        best = min((_best_width(family, thinnest, with_one) for family in families), key=with_one)
        left = with_one(best)
        if found and left > PAYS * least:
            break
        found, least = [*found, best], left
    *others, narrowest = sorted(found, key=lambda member: -member.alpha)
    with_one = partial(_with_one, partial(error, np.sqrt(texels.stands_for)[:, None]), others)
    family, alpha = narrowest.family, narrowest.alpha
    low = max(alpha / SUNS_TELL, min(thinnest, alpha))
    _, width = _by_golden_section(family, low, alpha * SUNS_TELL, with_one)
    return [*others, Member(family, width)]


def _with_one(error: Callable[[Sequence[Member]], float], found: Sequence[Member], one: Member) -> float:
    return error([*found, one])


def factors(seen: Array, radiance: Array) -> Array:
    """The factors, none negative, by which a sum of functions comes closest to a radiance.

    Errors count as `relative_weight` says.

    Parameters
    ----------
    seen : ndarray, shape (N, P, 3)
        Each function at the texels.
    radiance : ndarray, shape (N, 3)

    Returns
    -------
    ndarray, shape (P, 3)
    """
    found, weight = np.empty(seen.shape[1:]), relative_weight(radiance)
    for channel, wanted in enumerate((weight * radiance).T):
        columns = weight[:, channel, None] * seen[..., channel]
        norm = np.sqrt(np.sum(columns**2, axis=0)) + np.finfo(np.float64).tiny
        columns = columns / norm
        system = columns.T @ columns + _RANK * np.eye(len(norm))
        right = columns.T @ wanted
        found[:, channel] = nonnegative_inverse(system, right) @ right / norm
    return found


def relative_weight(radiance: Array) -> Array:
    """Weights of errors, shape (N, 3): those of the radiance itself are nearly relative.

    Otherwise the few texels that show a sun would decide all, and they tell little of the rest.
    """
    weight: Array = 1.0 / (np.abs(radiance) + np.abs(radiance).mean() + np.finfo(np.float64).tiny)
    return weight


def _best_width(family: Family, thinnest: float, error: Callable[[Member], float]) -> Member:
    widths = family.alpha[family.alpha >= min(thinnest, family.alpha[-1])]
    coarse = np.unique(np.append(widths[::-_COARSE], widths[0]))
    errors = [error(Member(family, float(alpha))) for alpha in coarse]
    best = int(np.argmin(errors))
    low, high = coarse[[max(best - 1, 0), min(best + 1, len(coarse) - 1)]]
    tried = [(errors[best], float(coarse[best])), _by_golden_section(family, low, high, error)]
    return Member(family, min(tried)[1])


def _by_golden_section(
    family: Family, low: float, high: float, error: Callable[[Member], float]
) -> tuple[float, float]:
    """The least error of a width between two others, and the width."""
    low, high = np.log([low, high])
    places = [high - _GOLDEN * (high - low), low + _GOLDEN * (high - low)]
    costs = [error(Member(family, float(np.exp(place)))) for place in places]
    for _ in range(_STEPS if low < high else 0):
        if costs[0] < costs[1]:
            high, places[1], costs[1] = places[1], places[0], costs[0]
            places[0] = high - _GOLDEN * (high - low)
            costs[0] = error(Member(family, float(np.exp(places[0]))))
        else:
            low, places[0], costs[0] = places[0], places[1], costs[1]
            places[1] = low + _GOLDEN * (high - low)
            costs[1] = error(Member(family, float(np.exp(places[1]))))
    return min((cost, float(np.exp(place))) for cost, place in zip(costs, places, strict=True))
