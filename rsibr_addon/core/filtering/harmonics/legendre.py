"""Associated Legendre functions, normalised on the sphere, of all orders and without underflow."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from ...conventions import Array, Indices

MAX_DEGREE = 3000
"""Largest degree: up to it, every value that matters is within a double's range (docs/prefiltering.md,
section 4)."""

_SCALE = 2.0**900
_PANEL_ROWS = 64
_PANEL_VALUES = 2**18


@dataclass(frozen=True)
class Panel:
    """Legendre functions of a few orders over consecutive degrees: factors times values.

    Attributes
    ----------
    first_order : int
        Even; orders are m = first_order, first_order + 1, ..., an even number of them. The last may
        lie beyond the largest degree: its factors are 0.
    first_row : int
        Even; row n of order m belongs to degree l = m + first_row + n.
    first_point : int
        Points before this one, nearer to the poles, are left out: there all values are negligible.
    values : ndarray, shape (rows, orders, points), float64
        mu_lm times 2^900; valid until the next panel is asked for.
    factors : ndarray, shape (rows, orders), float64
        g_lm over 2^900; 0 beyond the largest degree.
    """

    first_order: int
    first_row: int
    first_point: int
    values: Array
    factors: Array


def first_point(order: int, degree: int, sine: Array) -> int:
    """First point at which an order matters.

    Parameters
    ----------
    order, degree : int
    sine : ndarray, shape (points,)
        Sine of the colatitude, ascending.

    Returns
    -------
    int
        Index. At points before it |lambda_lm| is below 1e-16 for all l up to `degree`: m far exceeds the
        turning point l sin(theta) (docs/prefiltering.md, section 4).
    """
    margin = max(100.0, 0.01 * degree)
    return int(np.searchsorted(sine, (order - margin) / max(degree, 1)))


def legendre_panels(degree: int, cosine: Array, sine: Array) -> Iterator[Panel]:
    """lambda_lm(theta) for all m <= l <= degree, in panels that fit a processor's cache.

    Parameters
    ----------
    degree : int
        At most `MAX_DEGREE`.
    cosine, sine : ndarray, shape (points,), float64
        Cosines and sines of the colatitudes; `sine` ascending.

    Yields
    ------
    Panel
        Blocks of orders ascend; within a block, rows ascend from 0.

    Notes
    -----
    lambda_lm has no Condon-Shortley phase; lambda_lm(theta) exp(i m phi) is orthonormal.
    """
    orders = degree + 1 + (degree + 1) % 2
    norms = _sectoral_norms(orders)
    block = 2 * max(1, _PANEL_VALUES // (2 * _PANEL_ROWS * len(cosine)))
    for first_order in range(0, orders, block):
        m = np.arange(first_order, min(first_order + block, orders))
        start = first_point(first_order, degree, sine)
        # Scaled as a root, then squared: sine**m may underflow where its multiple does not.
        root = np.sqrt(_SCALE) * sine[start:] ** (0.5 * m[:, None])
        seed = norms[m, None] * root * root
        yield from _block_panels(degree, m, start, seed, cosine[start:])


def _block_panels(degree: int, m: Indices, start: int, seed: Array, cosine: Array) -> Iterator[Panel]:
    """Equation 10: mu_l = g_{l-1}^2 cos(theta) mu_{l-1} - mu_{l-2}, from mu_m = lambda_mm."""
    rows = degree + 1 - int(m[0])
    g = _ratios(m, rows)
    values = np.empty((min(rows, _PANEL_ROWS), *seed.shape))
    before, last = np.zeros_like(seed), np.zeros_like(seed)
    for first_row in range(0, rows, _PANEL_ROWS):
        part = slice(first_row, min(first_row + _PANEL_ROWS, rows))
        panel = values[: part.stop - first_row]
        # Each row begins as the factor of the one before; the factor of row 0 meets a zero.
        np.multiply(g[np.maximum(np.arange(part.start, part.stop) - 1, 0), :, None] ** 2, cosine, out=panel)
        for row, current in enumerate(panel, first_row):
            current *= last
            current -= before
            if row == 0:
                current[:] = seed
            before, last = last, current
        known = m + np.arange(part.start, part.stop)[:, None] <= degree
        yield Panel(int(m[0]), first_row, start, panel, np.where(known, g[part] / _SCALE, 0.0))
        before, last = before.copy(), last.copy()


def _sectoral_norms(orders: int) -> Array:
    """lambda_mm over sin(theta)^m, shape (orders,)."""
    m = np.arange(1, orders)
    squares = np.concatenate([[0.25 / np.pi], (2.0 * m + 1.0) / (2.0 * m)])
    norms: Array = np.sqrt(np.cumprod(squares))
    return norms


def _ratios(m: Indices, rows: int) -> Array:
    """g_lm = lambda_lm / mu_lm for l = m + row, shape (rows, orders): equation 11.

    g_m = 1 and g_l g_{l-1} = A_l, where A_l^2 = (4 l^2 - 1) / (l^2 - m^2). Every second g is a product of all
    before it; those between are quotients. So rounding never adds up in g_l g_{l-1}.
    """
    row = np.arange(rows)[:, None]
    l = m + row
    a = np.sqrt((4.0 * l**2 - 1.0) / np.maximum(row * (l + m), 1), where=row > 0, out=np.ones(l.shape))
    ratios = np.empty(l.shape)
    ratios[0] = 1.0
    ratios[2::2] = np.cumprod(a[2::2] / a[1:-1:2], axis=0)
    ratios[1::2] = a[1::2] / ratios[: rows - 1 : 2]
    return ratios
