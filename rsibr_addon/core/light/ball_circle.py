"""The outline of a ball in a photograph, found."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..conventions import Array
from ..errors import RangeError
from ..ties import TIE, first_greatest, greatest_first

ComplexArray = NDArray[np.complexfloating[Any]]

SMALLEST, LARGEST = 0.25, 0.75
"""Least and greatest radius of a ball, as shares of the photograph's shorter side."""

COARSE = 96
"""Longer side of the smallest picture, in which all circles are tried."""

FINEST = 2048
"""Longer side of the largest picture: half a pixel of it is enough."""

KEPT = 6
"""Circles that are followed into larger pictures: reflections near the outline are nearly circles, too."""

POINTS = 128
"""Points on a circle at which edges are compared."""

FAINT = 0.02
"""[white] Step between pixels two apart that counts half as an edge."""

CLEAR = 0.32
"""Least score of a ball; noise, blurred or not, reaches 0.26."""


@dataclass(frozen=True)
class Circle:
    """A circle in a photograph.

    Attributes
    ----------
    x, y : float
        Its middle, in pixels from the bottom-left corner of the photograph.
    radius : float
        [pixels], above 0.

    Raises
    ------
    RangeError
        The radius is not above 0, or something is not finite.
    """

    x: float
    y: float
    radius: float

    def __post_init__(self) -> None:
        if not (np.all(np.isfinite((self.x, self.y, self.radius))) and self.radius > 0.0):
            raise RangeError("A circle is x, y and a radius above 0, in pixels.")


def find_circle(photograph: Array) -> tuple[Circle, float]:
    """Find the outline of a ball.

    Parameters
    ----------
    photograph : ndarray, shape (height, width, 3)
        Encoded, in [0, 1]; it may cut the ball off a little.

    Returns
    -------
    circle : Circle
    score : float
        At most 1: see Notes.

    Raises
    ------
    RangeError
        There is no ball, or none that fills a good part of the photograph.

    Notes
    -----
    The score is the mean over a circle of cos 2 phi, where phi is the angle between the brightness's gradient
    and the radius; faint gradients count less. It is taken for all circles of a grid in a small picture, then
    for neighbours of the few best in larger pictures. Edges along the circle give 1, edges across it -1,
    random ones 0. The brightness of the ball and of what is behind it makes no difference, nor does it matter
    which is brighter. [Daugman1993]'s operator for irises is alike, but for brightness, not directions. A
    smaller circle is more likely to meet edges by chance, so the mean is weighted with the root of the
    diameter over the photograph's shorter side.
    """
    grey: Array = photograph.astype(np.float64).mean(axis=-1)
    shrunk = 1.0
    while max(grey.shape) > FINEST:
        grey, shrunk = _halved(grey), 2.0 * shrunk
    pyramid: list[Array] = [grey]
    while max(pyramid[-1].shape) > COARSE:
        pyramid.append(_halved(pyramid[-1]))
    edges = _radial_edges(pyramid[-1])
    found = _searched(edges)
    # The smallest picture cannot tell the outline from the reflections beside it, so a circle of each radius
    # goes on to the next
    for picture in pyramid[-2::-1]:
        edges = _radial_edges(picture)
        found = _best(edges, np.array([_climbed(edges, circle) for circle in 2.0 * found]))
    circle = _climbed(edges, _best(edges, found)[0], 0.25)
    score = float(_scores(edges, circle[None])[0])
    if score < CLEAR:
        raise RangeError(
            "No ball was found: let it fill most of the photograph, in focus, or give its circle."
        )
    return Circle(*(float(number) for number in shrunk * circle)), score


def _halved(picture: Array) -> Array:
    height, width = (size // 2 for size in picture.shape)
    halved: Array = picture[: 2 * height, : 2 * width].reshape(height, 2, width, 2).mean(axis=(1, 3))
    return halved


def _radial_edges(picture: Array) -> ComplexArray:
    """The gradient's direction, doubled, as a complex number, shorter where it is faint."""
    up, right = np.gradient(picture)
    gradient = 2.0 * (right + 1j * up)
    edges: ComplexArray = gradient**2 / (np.abs(gradient) ** 2 + FAINT**2)
    return edges


def _scores(edges: ComplexArray, circles: Array) -> Array:
    """Score of each circle (x, y, radius), shape (n, 3); parts beyond the picture count 0."""
    height, width = edges.shape
    angle = 2.0 * np.pi * np.arange(POINTS) / POINTS
    direction = np.exp(1j * angle)
    # Straight above and beside a pixel's corner lie borders between pixels
    column = np.floor(circles[:, :1] + circles[:, 2:] * direction.real + TIE).astype(np.intp)
    row = np.floor(circles[:, 1:2] + circles[:, 2:] * direction.imag + TIE).astype(np.intp)
    within = (column >= 0) & (column < width) & (row >= 0) & (row < height)
    found = edges[np.where(within, row, 0), np.where(within, column, 0)]
    along = (found * np.conj(direction**2)).real * within
    filled = np.minimum(2.0 * circles[:, 2] / min(edges.shape), 1.0)
    scores: Array = along.mean(axis=-1) * np.sqrt(filled)
    return scores


def _searched(edges: ComplexArray) -> Array:
    """For every radius, the best circle of those around every corner of a pixel; shape (radii, 3)."""
    height, width = edges.shape
    x, y = np.meshgrid(np.arange(0.0, width + 1.0), np.arange(0.0, height + 1.0))
    best = []
    for radius in np.arange(SMALLEST * min(edges.shape), LARGEST * min(edges.shape), 1.0):
        circles = np.stack([x, y, np.full_like(x, radius)], axis=-1).reshape(-1, 3)
        best.append(circles[first_greatest(_scores(edges, circles))])
    return np.array(best)


def _best(edges: ComplexArray, circles: Array) -> Array:
    """The circles of the highest scores, the highest first, that are not nearly the same."""
    kept: list[Array] = []
    for circle in circles[greatest_first(_scores(edges, circles))]:
        if len(kept) < KEPT and all(np.abs(circle - other).max() > 2.0 for other in kept):
            kept.append(circle)
    return np.array(kept)


def _climbed(edges: ComplexArray, start: Array, step: float = 1.0) -> Array:
    """The best circle uphill from `start`, in steps of a given number of pixels."""
    offsets = step * np.stack(np.meshgrid(*3 * [np.arange(-2.0, 3.0)]), axis=-1).reshape(-1, 3)
    offsets = offsets[np.argsort(np.abs(offsets).sum(axis=-1), kind="stable")]
    best = start
    while True:
        circles = best + offsets
        nearest = circles[first_greatest(_scores(edges, circles))]
        if np.array_equal(nearest, best):
            return best
        best = nearest
