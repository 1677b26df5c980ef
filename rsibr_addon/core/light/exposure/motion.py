"""Movement of a hand-held camera from one photograph to the next."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...conventions import Array, Indices
from ...resample import bilinear
from ...ties import first_greatest

ComplexArray = NDArray[np.complexfloating[Any]]
"""Points or vectors x + i y of the plane."""

NOISE = 0.03
"""[white] Step between pixels two apart that counts half as an edge."""

FINEST = 1536
"""Longer side of the pictures in which movements are looked for; larger ones are shrunk."""

TILE, SPACING = 96, 72
"""[pixels] Side of the tiles that show the movement of each part of a picture, and their distance."""

ROUNDS = 3
"""Rounds of search for the tiles' movement, each from the result of the last."""

FEWEST = 4
"""Fewest tiles with edges in both pictures from which a rotation is accepted."""

CLEAR = 0.2
"""Least coefficient of correlation at which a tile counts; noise in a tile of `TILE` makes some 0.05."""

OUTLIER = 0.5
"""[pixels] Distance of a tile's movement from the common one at which the tile counts half."""


@dataclass(frozen=True)
class Motion:
    """A similarity of the plane: the point p of one picture is turn * p + shift of another.

    Attributes
    ----------
    turn, shift : complex
        Points are x + i y in pixels from the middle of the picture. `turn` turns and scales.
    """

    turn: complex = 1.0
    shift: complex = 0.0

    def after(self, first: "Motion") -> "Motion":
        """The movement `first`, then this one."""
        return Motion(self.turn * first.turn, self.turn * first.shift + self.shift)

    def of(self, points: ComplexArray) -> ComplexArray:
        """Images of points."""
        return self.turn * points + self.shift

    def inverse(self) -> "Motion":
        """The movement back."""
        return Motion(1.0 / self.turn, -self.shift / self.turn)

    def scaled(self, factor: float) -> "Motion":
        """The same movement where pixels are smaller by `factor`."""
        return Motion(self.turn, self.shift * factor)

    def most(self, width: int, height: int) -> float:
        """Largest movement of a picture's corners [pixels]."""
        corners = np.array([1.0 + 1.0j, 1.0 - 1.0j]) * 0.5
        corners = corners.real * width + 1j * corners.imag * height
        away = (self.turn - 1.0) * np.concatenate([corners, -corners]) + self.shift
        return float(np.abs(away).max())


def pixel_points(width: int, height: int) -> ComplexArray:
    """The middles of a picture's pixels as points: see `Motion`; shape (height, width)."""
    x, y = np.arange(width) + 0.5 - 0.5 * width, np.arange(height) + 0.5 - 0.5 * height
    points: ComplexArray = x + 1j * y[:, None]
    return points


def looked_up(image: Array, points: ComplexArray) -> Array:
    """Colours of a picture at given points.

    Parameters
    ----------
    image : ndarray, shape (height, width, channels)
    points : ndarray of complex, shape (...,)
        See `Motion`.

    Returns
    -------
    ndarray, shape (..., channels), float64
        Interpolated bilinearly; beyond the edge, the edge is repeated.
    """
    height, width = image.shape[:2]
    return bilinear(image, _uv(points, width, height), _clamp)


def covers(points: ComplexArray, width: int, height: int) -> NDArray[np.bool]:
    """Whether points lie within a picture of that size; shape of `points`."""
    return np.all(np.abs(_uv(points, width, height) - 0.5) <= 0.5, axis=-1)


def motion_between(first: Array, second: Array) -> Motion:
    """Movement of a camera between two photographs of any exposures.

    Parameters
    ----------
    first, second : ndarray, shape (height, width)
        Encoded, in [0, 1], of one size.

    Returns
    -------
    Motion
        From the first's points to the second's.

    Notes
    -----
    Orientation correlation [Fitch2002]: an edge has the same direction at any exposure at which it shows, so
    unit vectors along the gradients are correlated by Fourier transform. They are shorter where there may be
    only noise. Unlike the bitmaps of [Ward2003] this needs no median, which in a dark photograph is noise,
    and no pyramid; and it finds fractions of a pixel. First whole pictures are compared, then tiles, from
    whose movements rotation and scale follow by least squares. Tiles that disagree, because they show things
    that moved, lose their weight.
    """
    factor = max(1, -(-max(first.shape) // FINEST))
    first, second = _shrunk(first, factor), _shrunk(second, factor)
    height, width = first.shape
    points, field = pixel_points(width, height), _orientation(first)
    step, _ = _peak(field, _orientation(second))
    motion = Motion(1.0, step)
    for _ in range(ROUNDS):
        there = motion.of(points)
        # Nothing is known beyond the edge
        moved = looked_up(second[..., None], there)[..., 0] * covers(there, width, height)
        found = _tile_steps(points, field, _orientation(moved))
        if len(found) < FEWEST:
            break
        motion = motion.after(_fitted(np.array(found)))
    return motion.scaled(factor)


def _tile_steps(
    points: ComplexArray, first: ComplexArray, second: ComplexArray
) -> list[tuple[complex, complex]]:
    """Middles of the tiles with edges in both fields, and their places in the second."""
    height, width = first.shape
    steps = []
    for row in range(0, height - TILE + 1, SPACING):
        for column in range(0, width - TILE + 1, SPACING):
            tile = slice(row, row + TILE), slice(column, column + TILE)
            step, coefficient = _peak(first[tile], second[tile])
            if coefficient > CLEAR and max(abs(step.real), abs(step.imag)) < TILE / 4:
                middle = complex(points[tile].mean())
                steps.append((middle, middle + step))
    return steps


def _fitted(pairs: ComplexArray) -> Motion:
    """The similarity that best takes points, shape (n, 2), to their partners, without outliers."""
    here, there = pairs.T
    motion = Motion()
    for _ in range(10):
        weight = 1.0 / (1.0 + np.abs((there - motion.of(here)) / OUTLIER) ** 2)
        mean_here, mean_there = np.average(here, weights=weight), np.average(there, weights=weight)
        arm = here - mean_here
        turn = np.sum(weight * np.conj(arm) * (there - mean_there)) / np.sum(weight * np.abs(arm) ** 2)
        motion = Motion(complex(turn), complex(mean_there - turn * mean_here))
    return motion


def _peak(first: ComplexArray, second: ComplexArray) -> tuple[complex, float]:
    """Shift from one field to the other at their highest correlation, and its coefficient."""
    window = _window(*first.shape)
    fields = [field * window for field in (first, second)]
    most = float(np.linalg.norm(fields[0]) * np.linalg.norm(fields[1]))
    if not most > 0.0:
        return 0.0j, 0.0
    spectra = [np.fft.fft2(field) for field in fields]
    correlation = _rounded(np.fft.ifft2(np.conj(spectra[0]) * spectra[1]).real)
    height, width = correlation.shape
    row, column = divmod(first_greatest(correlation), width)
    x = column + _vertex(correlation[row, [column - 1, column, (column + 1) % width]])
    y = row + _vertex(correlation[[row - 1, row, (row + 1) % height], column])
    shift = complex((x + width / 2) % width - width / 2, (y + height / 2) % height - height / 2)
    return shift, float(correlation[row, column]) / most


def _rounded(correlation: Array) -> Array:
    """Blur by a pixel: unit vectors correlate to a cusp, and a parabola would misplace it between pixels."""
    for axis in (0, 1, 0, 1):
        beside = np.roll(correlation, 1, axis) + np.roll(correlation, -1, axis)
        correlation = 0.5 * correlation + 0.25 * beside
    return correlation


def _vertex(three: Array) -> float:
    """Top of a parabola through three neighbours, relative to the middle one, which is the highest."""
    bend = 2.0 * three[1] - three[0] - three[2]
    return 0.5 * float((three[2] - three[0]) / bend) if bend > 0.0 else 0.0


def _window(height: int, width: int) -> Array:
    """Fades out to the edges, which move with the frame and not with the scene."""
    rows = np.sin(np.pi * (np.arange(height) + 0.5) / height)
    columns = np.sin(np.pi * (np.arange(width) + 0.5) / width)
    window: Array = rows[:, None] * columns
    return window


def _orientation(picture: Array) -> ComplexArray:
    """Direction of the gradient as a unit vector; shorter where it may be noise."""
    up, right = np.gradient(picture)
    gradient = 2.0 * (right + 1j * up)
    field: ComplexArray = gradient / np.hypot(np.abs(gradient), NOISE)
    return field


def _shrunk(picture: Array, factor: int) -> Array:
    """Means over squares of `factor` pixels; incomplete squares at the top and right are cut off."""
    height, width = (size // factor for size in picture.shape)
    squares = picture[: height * factor, : width * factor].reshape(height, factor, width, factor)
    means: Array = squares.mean(axis=(1, 3))
    return means


def _uv(points: ComplexArray, width: int, height: int) -> Array:
    return np.stack([points.real / width + 0.5, points.imag / height + 0.5], axis=-1)


def _clamp(columns: Indices, rows: Indices, width: int, height: int) -> tuple[Indices, Indices]:
    return np.clip(columns, 0, width - 1), np.clip(rows, 0, height - 1)
