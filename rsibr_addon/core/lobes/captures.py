"""Lobes fitted to captured views: to pictures of a material in light that is known, without its BRDF.

Each part of the radiance, diffuse and glossy, is fitted in two steps.

1. Its *likeness* is a sum of a few known reflectances, of widths that fit. Few numbers say it, so that few
   views tell them, even one; and it gives the lobes' axes. As few views see a sun at grazing, what it says of
   that stays: so more lobes than the families have are fitted to each width that was found.
2. The *correction* is to the weights of all kernels about these axes, at all elevations, by least squares. A
   price is on its power and on how much it changes from one elevation to the next: the highest at which views
   that were left out are predicted nearly as well as at any.

Normal equations are kept for each view, so that those of all others are a difference.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from ..conventions import Array, Indices
from ..errors import RangeError
from ..geometry.directions import dot
from ..kinds.radiance_views.views import RadianceViews
from ..maps.sphere_map import texel_angle
from ..progress import Progress, Steps
from .bank import KernelBank
from .captured_light import CapturedLight
from .captured_texels import CapturedTexels, Equations, captured_texels, equations_of, seen_functions
from .family import Family
from .fit import Fit, joined
from .likeness import Member, factors, likeness
from .next_views import Weighed, compare_with_new
from .tridiagonal import Tridiagonal

METHOD = "captured"
"""`Fit.method` of these fits."""

PRICES = 10.0 ** np.arange(1.0, -6.0, -1.0)
"""Prices of a correction's power: of that of the likeness's lobes, in units of that of the captures."""

EVENNESS = 30.0
"""Price of a correction's change between neighbouring elevations, relative to that of its power."""

TOLERATED = 1.02
"""Greatest error of views left out, over the least."""

FOLDS = 12
"""Most groups of views that are left out in turn."""

FEWEST_VIEWS = 3
"""Views with which one that is left out tells how well a new one is predicted."""

TEXELS, SEARCHED = 24000, 2000
"""Texels that the correction, and that the search for a likeness takes."""

NEGLIGIBLE = 1e-6
"""Share of the captured power below which a part of the radiance is left out."""

_SECTORS = 4
_THINNEST = 0.25
_FAINTEST = 1e-3
_RANK = 1e-9


@dataclass(frozen=True)
class CapturedFit:
    """A fit to captures, and what it found.

    Attributes
    ----------
    fit : Fit
        Its `left_out` is None with fewer than `FEWEST_VIEWS`.
    widths : tuple of float
        alpha of the glossy likeness's members; empty without glossy light.
    weighed : tuple of Weighed
        Of the diffuse and of the glossy part, of those that are not black.
    untested : float or None
        Share of new views that may be worse than `left_out` says: see `compare_with_new`. None where that is.
    """

    fit: Fit
    widths: tuple[float, ...]
    weighed: tuple[Weighed, ...]
    untested: float | None


def fit_captures(
    views: RadianceViews,
    light: CapturedLight,
    families: Mapping[Family, Callable[[float], Steps[Family]]],
    brdf: str,
    count: int | None = None,
) -> Steps[CapturedFit]:
    """Fit lobes to captured views.

    Parameters
    ----------
    views : RadianceViews
    light : CapturedLight
        The environment of the captures, filtered with the first kernels of the families.
    families : mapping of Family to callable
        Kinds of glossy reflection, of the same kernels and elevations; and what fits lobes to one width of
        each that are closer.
    brdf : str
        The text of the material.
    count : int, optional
        Use so many of the views, the first, only.

    Raises
    ------
    RangeError
        There are fewer views, or they are black.
    """
    count = count or len(views.diffuse)
    if count > len(views.diffuse):
        raise RangeError(
            f"There are only {len(views.diffuse)} views, not {count}: use fewer or capture more."
        )
    texels = captured_texels(views, count, TEXELS, light.suns.direction)
    power = texels.power(texels.diffuse + texels.glossy)
    if not 0.0 < power < np.inf:
        raise RangeError("The captured views are black or not finite: capture the material in light.")
    few = captured_texels(views, count, SEARCHED, light.suns.direction)
    thinnest, folds = _THINNEST * texel_angle(views.size), _folds(texels, count)
    fits: list[Fit] = []
    weighed: list[Weighed] = []
    errors: Array = np.zeros_like(texels.glossy)
    widths: tuple[float, ...] = ()
    mu = next(iter(families)).mu
    bank = light.filtered.bank
    lambert = lambert_family(mu, bank)
    for number, (part, kinds) in enumerate({"diffuse": [lambert], "glossy": list(families)}.items()):
        radiance = getattr(texels, part)
        if texels.power(radiance) <= NEGLIGIBLE * power:
            errors += radiance
            continue
        yield Progress(2 * number, 5, f"finding what {part} light is like")
        members = likeness(few, getattr(few, part), light, kinds, thinnest)
        if part == "glossy":
            members = yield from _closer(members, families)
        yield Progress(2 * number + 1, 5, f"fitting lobes to {part} light")
        tilts = np.concatenate([each.tilts for each in members], axis=1)
        weights = _side_by_side([each.weights(bank) for each in members])
        seen = seen_functions(texels, light, mu, tilts, weights)
        equations = equations_of(texels, light, mu, tilts)
        corrector = _Corrector(equations, bank, weights, seen, texels, radiance, folds)
        fitted, left = corrector.best()
        fits.append(_fit(mu, bank, tilts, fitted, brdf))
        errors += left
        weighed.append(Weighed(mu, tilts, corrector.precision(), texels.power(left)))
        if part == "glossy":
            widths = tuple(each.alpha for each in members)
    fit = joined(fits, brdf)
    if count < FEWEST_VIEWS:
        return CapturedFit(fit, widths, tuple(weighed), None)
    yield Progress(4, 5, "comparing views left out with new ones")
    comparison = compare_with_new(views.sphere.vertices[:count], views.size, light, weighed)
    counts = comparison.like_new[texels.view][:, None]
    left_out = texels.power(counts * errors) / texels.power(counts * (texels.diffuse + texels.glossy))
    stated = replace(fit, left_out=float(np.sqrt(left_out)))
    return CapturedFit(stated, widths, tuple(weighed), comparison.share)


def _closer(
    members: Sequence[Member], families: Mapping[Family, Callable[[float], Steps[Family]]]
) -> Steps[list[Member]]:
    """The same widths, the narrowest with lobes that are closer."""
    *others, narrowest = members
    family = yield from families[narrowest.family](narrowest.alpha)
    return [*others, Member(family, narrowest.alpha)]


def lambert_family(mu: Array, bank: KernelBank) -> Family:
    """Diffuse reflection as a family of one width: one lobe, about the normal.

    Parameters
    ----------
    mu : ndarray, shape (S,)
    bank : KernelBank

    Returns
    -------
    Family
        Of two functions: a white Lambert surface, and that times n.v, which is as below a coat that transmits
        less at grazing. Both are exact under uniform light.
    """
    nodes, weight = np.polynomial.legendre.leggauss(512)
    kernels = bank.values(0.5 * (1.0 - nodes))
    system = kernels.T @ (weight[:, None] * kernels)
    system += _RANK * np.trace(system) * np.eye(len(bank))
    ones = np.ones((len(bank), 1))
    bordered = np.block([[system, ones], [ones.T, np.zeros((1, 1))]])
    cosine = weight * np.maximum(nodes, 0.0) / np.pi
    profile = np.linalg.solve(bordered, np.append(cosine @ kernels, 1.0))[:-1]
    weights = profile[:, None] * np.stack([np.ones_like(mu), mu], axis=-1)[:, None]
    tilt = np.arccos(mu) / np.sqrt(1.0 - mu**2)
    return Family(np.ones(1), mu, bank, tilt[None, :, None], weights[None, :, None])


def _folds(texels: CapturedTexels, count: int) -> Indices:
    """The group of each texel: views; of less than `FEWEST_VIEWS`, sectors of each sphere."""
    if count >= FEWEST_VIEWS:
        return texels.view % FOLDS
    normal, view_dir = texels.normal[texels.first], texels.view_dir[texels.first]
    side = np.cross(view_dir, np.eye(3)[np.argmin(np.abs(view_dir), axis=1)])
    turn = np.arctan2(dot(normal, np.cross(side, view_dir)), dot(normal, side)) / (2.0 * np.pi) % 1.0
    sectors: Indices = np.minimum((_SECTORS * turn).astype(np.intp), _SECTORS - 1)
    return sectors


def _side_by_side(weights: Sequence[Array]) -> Array:
    """Weights of all members' lobes for all their functions, shape (S, J, K, P): 0 for others' lobes."""
    slices, _, kernels, _ = weights[0].shape
    lobes, functions = (sum(each.shape[axis] for each in weights) for axis in (1, 3))
    every = np.zeros((slices, lobes, kernels, functions))
    lobe = function = 0
    for each in weights:
        _, own, _, count = each.shape
        every[:, lobe : lobe + own, :, function : function + count] = each
        lobe, function = lobe + own, function + count
    return every


def _fit(mu: Array, bank: KernelBank, tilts: Array, weights: Array, brdf: str) -> Fit:
    slices, lobes = tilts.shape
    return Fit(
        brdf=brdf,
        method=METHOD,
        mu=mu,
        bank=bank,
        weights=np.moveaxis(weights.reshape(slices, lobes, len(bank), 3), 1, 0),
        scale=np.ones((lobes, slices, 3)),
        offsets=np.stack([tilts.T, np.zeros_like(tilts.T)], axis=-1)[:, :, None],
        taps=np.ones((lobes, slices, 1)),
    )


class _Corrector:
    """Factors of a likeness, and least squares for what it leaves.

    Parameters
    ----------
    equations : Equations
        Of all its axes.
    bank : KernelBank
    functions : ndarray, shape (S, J, K, P)
        Weights of the likeness's functions.
    seen : ndarray, shape (N, P, 3)
        What the texels see of them.
    texels : CapturedTexels
    radiance : ndarray, shape (N, 3)
        Part of the captured radiance.
    folds : ndarray of int, shape (N,)
        Group of each texel.
    """

    def __init__(
        self,
        equations: Equations,
        bank: KernelBank,
        functions: Array,
        seen: Array,
        texels: CapturedTexels,
        radiance: Array,
        folds: Indices,
    ) -> None:
        self._equations, self._folds, self._radiance = equations, folds, radiance
        self._functions = functions.reshape(len(functions), -1, functions.shape[-1])
        self._factors = factors(seen, radiance)
        self._without = np.stack(
            [factors(seen[folds != fold], radiance[folds != fold]) for fold in range(folds.max() + 1)]
        )
        self._root = np.sqrt(texels.stands_for)
        # What each texel is left with where its fold had no part in the factors
        self._rest = radiance - np.einsum("npc,npc->nc", seen, self._without[folds])
        known = np.concatenate([radiance[:, None], seen, self._rest[:, None]], axis=1)
        self._systems, rights = self._normal_equations(known)
        self._rights, self._own = rights[..., :-1], rights[..., -1:]
        self._alike = self._functions @ self._factors
        slices, size, _ = self._functions.shape
        # Scalar products of all kernels, and what weights cost by elevation
        self._power = np.kron(np.eye(size // len(bank)), bank.products(np.zeros(()))[0])
        steps = np.diff(np.eye(slices), axis=0)
        self._along = (np.eye(slices) + EVENNESS * steps.T @ steps) / slices
        self._price = self._prices(np.sum((self._root[:, None] * radiance) ** 2, axis=0))

    def best(self) -> tuple[Array, Array]:
        """All weights, shape (S, M, 3), and the errors of texels when they are left out, shape (N, 3)."""
        total, rights = self._systems.sum(), self._rights.sum(axis=0)
        without = Tridiagonal(total.diagonal[None], total.above[None]) - self._systems
        left = np.stack(
            [_rest_of(rights - own, chosen) for own, chosen in zip(self._rights, self._without, strict=True)]
        )
        # The highest price is that of no correction
        least = alike = np.sum((self._root[:, None] * self._rest) ** 2)
        tried: list[tuple[float, Array, float]] = [(np.inf, np.zeros_like(left), alike)]
        for price in PRICES:
            x = (without + self._price * price).solve(left)
            tried.append((price, x, alike + np.sum(x * (self._systems @ x - 2.0 * self._own))))
            least = min(least, tried[-1][2])
            if tried[-1][2] > TOLERATED**2 * least:
                break  # lower prices fit noise
        price, unknowns, _ = next(each for each in tried if each[2] <= TOLERATED**2 * least)
        correction = np.zeros_like(left[0])
        if np.isfinite(price):
            correction = (total + self._price * price).solve(_rest_of(rights, self._factors))
        rest = self._rest.copy()
        for fold, those in enumerate(unknowns):
            chosen = self._folds == fold
            rest[chosen] -= self._equations.radiance(chosen, np.moveaxis(those[..., 0], 0, -1))
        return self._alike + np.moveaxis(correction[..., 0], 0, -1), rest

    def precision(self) -> Tridiagonal:
        """See `Weighed`: at each elevation, weights vary in proportion to the likeness's lobes there."""
        own = np.einsum("smc,mn,snc->s", self._alike, self._power, self._alike)
        size = np.sqrt(np.maximum(own, _FAINTEST**2 * own.max()))
        return _priced(self._along / (size[:, None] * size), self._power)

    def _prices(self, captured: Array) -> Tridiagonal:
        """The price of a correction that costs 1, of captured power in each channel."""
        own = np.einsum("smc,mn,snc->c", self._alike, self._power, self._alike) / len(self._alike)
        unit = captured / np.maximum(own, _FAINTEST * own.max())
        return _priced(unit[:, None, None] * self._along, self._power)

    def _normal_equations(self, known: Array) -> tuple[Tridiagonal, Array]:
        """For each fold and channel the matrix and, of shape (F, 3, S, M, Q), right sides of (N, Q, 3)."""
        slices, size, _ = self._functions.shape
        count, below_of = int(self._folds.max()) + 1, self._equations.below
        diagonal = np.zeros((count, 3, slices, size, size))
        above = np.zeros((count, 3, slices - 1, size, size))
        rights = np.zeros((count, 3, slices, size, known.shape[1]))
        for fold in range(count):
            for below in range(slices - 1):
                chosen = (self._folds == fold) & (below_of == below)
                root = self._root[chosen][:, None, None]
                rows = root * self._equations.rows[chosen].reshape(-1, 2 * size, 3).astype(np.float64)
                sides = root * known[chosen]
                for channel in range(3):
                    of_channel = np.ascontiguousarray(rows[..., channel])
                    product = of_channel.T @ of_channel
                    diagonal[fold, channel, below] += product[:size, :size]
                    diagonal[fold, channel, below + 1] += product[size:, size:]
                    above[fold, channel, below] += product[:size, size:]
                    right = of_channel.T @ sides[..., channel]
                    rights[fold, channel, below : below + 2] += right.reshape(2, size, -1)
        return Tridiagonal(diagonal, above), rights


def _priced(along: Array, power: Array) -> Tridiagonal:
    """What weights cost, by elevation, shape (..., S, S), and by kernel, shape (M, M)."""
    own, next_to = (np.diagonal(along, offset, -2, -1)[..., None, None] for offset in (0, 1))
    return Tridiagonal(own * power, next_to * power)


def _rest_of(rights: Array, found: Array) -> Array:
    """Right sides of what a likeness leaves, shape (3, S, M, 1).

    Parameters
    ----------
    rights : ndarray, shape (3, S, M, 1 + P)
        Those of the radiance, and of each function.
    found : ndarray, shape (P, 3)
        Factors of the functions.
    """
    rest: Array = rights[..., :1] - np.einsum("csmp,pc->csm", rights[..., 1:], found)[..., None]
    return rest
