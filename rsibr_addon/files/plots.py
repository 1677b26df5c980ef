"""Plots as SVG and as pixels: curves over an axis, and lobes over the angle from the normal."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from html import escape

import numpy as np

from ..core.conventions import Array
from ..core.pictures.line_drawing import line_coverage

COLORS = ("#1b1b1b", "#d1495b", "#2e6fba", "#3a8f5c", "#c98a1b", "#7b4fa3", "#3aa6a6")

_WIDTH, _HEIGHT, _LEFT, _BOTTOM, _TOP = 480.0, 320.0, 56.0, 44.0, 44.0
_RADIUS = 190.0
_POLAR_SIZE = 2.0 * _RADIUS + 40.0, 1.4 * _RADIUS + 60.0
_CENTRE = np.array([_POLAR_SIZE[0] / 2.0, 40.0 + _RADIUS])
_LINES = 5
_GRID_COLOR = "#dddddd"
_PIXEL_LINE = 3.0
"""Width of a curve in pixels: pictures are shown at half their size."""


@dataclass(frozen=True)
class Curve:
    """One line of a plot.

    Attributes
    ----------
    name : str
        Name in the legend.
    x : ndarray, shape (N,)
        Positions, ascending; in a polar plot angles from the normal, positive to the right [rad].
    y : ndarray, shape (N,)
        Values; in a polar plot radii, with negative ones on the other side of the centre.
    dashed : bool
    """

    name: str
    x: Array
    y: Array
    dashed: bool = False


def line_plot(
    title: str, x_name: str, x_range: tuple[float, float], y_name: str, curves: Sequence[Curve]
) -> str:
    """Curves over an axis; both axes are linear, the vertical one starts at 0.

    Parameters
    ----------
    title, x_name, y_name : str
    x_range : tuple of two floats
        Ends of the horizontal axis.
    curves : sequence of Curve
        At least one.

    Returns
    -------
    str
        An SVG document.
    """
    first, last = x_range
    most = _round_above(max(float(curve.y.max()) for curve in curves))
    wide, high = _WIDTH - _LEFT - 16.0, _HEIGHT - _TOP - _BOTTOM

    def place(x: Array, y: Array) -> Array:
        across, up = (x - first) / (last - first), y / most
        return np.stack([_LEFT + wide * across, _TOP + high * (1.0 - up)], axis=-1)

    parts = [_title(_WIDTH, title)]
    for share in np.linspace(0.0, 1.0, _LINES + 1).tolist():
        x, y = _LEFT + wide * share, _TOP + high * (1.0 - share)
        parts.append(f'<path d="M{_LEFT:.1f} {y:.1f}h{wide:.1f}" class="grid"/>')
        parts.append(_text(_LEFT - 6.0, y + 4.0, f"{most * share:.3g}", "end"))
        parts.append(_text(x, _TOP + high + 16.0, f"{first + (last - first) * share:.3g}", "middle"))
    parts.append(_text(_LEFT + wide / 2.0, _HEIGHT - 8.0, x_name, "middle"))
    parts.append(_text(8.0, _TOP - 4.0, y_name, "start"))
    parts += _drawn([place(curve.x, curve.y) for curve in curves], curves)
    parts += _legend(curves, _WIDTH - 150.0, _TOP + 8.0)
    return _document(_WIDTH, _HEIGHT, parts)


def polar_plot(title: str, curves: Sequence[Curve]) -> str:
    """Lobes over the angle from the normal, which points up.

    Parameters
    ----------
    title : str
    curves : sequence of Curve
        At least one, with angles from -pi to pi; the longest radius fills the plot.

    Returns
    -------
    str
        An SVG document.
    """
    most, lines = _polar_lines(curves)
    width, height = _POLAR_SIZE
    parts = [_title(width, title)]
    parts += [f'<path d="{_path(line)}" class="grid"/>' for line in _polar_grid()]
    parts.append(f'<path d="M20 {_CENTRE[1]:.1f}h{2 * _RADIUS:.1f}" class="axis"/>')
    parts.append(_text(_CENTRE[0] + _RADIUS, _CENTRE[1] + 14.0, f"{most:.3g} / sr", "end"))
    parts += _drawn(lines, curves)
    parts += _legend(curves, 20.0, _CENTRE[1] + 30.0)
    return _document(width, height, parts)


def polar_picture(curves: Sequence[Curve]) -> Array:
    """The same as pixels, without words.

    Parameters
    ----------
    curves : sequence of Curve
        As `polar_plot` takes them.

    Returns
    -------
    ndarray, shape (height, width, 3)
        sRGB in [0, 1], on white; row 0 is the bottom row.
    """
    picture = _grid_picture()
    _, lines = _polar_lines(curves)
    for index, (line, curve) in enumerate(zip(lines, curves, strict=True)):
        picture = _over(picture, line, COLORS[index % len(COLORS)], _PIXEL_LINE, curve.dashed)
    return picture


@cache
def _grid_picture() -> Array:
    width, height = (round(side) for side in _POLAR_SIZE)
    picture: Array = np.ones((height, width, 3))
    for line in _polar_grid():
        picture = _over(picture, line, _GRID_COLOR, 0.5 * _PIXEL_LINE)
    return picture


def _over(picture: Array, line: Array, color: str, width: float, dashed: bool = False) -> Array:
    """A picture with a line drawn over it."""
    ink = np.frombuffer(bytes.fromhex(color[1:]), np.uint8) / 255.0
    covered = line_coverage(line, picture.shape[:2], width, dashed)[..., None]
    return (1.0 - covered) * picture + covered * ink


def _polar_lines(curves: Sequence[Curve]) -> tuple[float, list[Array]]:
    """The longest radius, which fills the plot, and the curves' points."""
    most = max(float(np.abs(curve.y).max()) for curve in curves)
    return most, [_CENTRE + _RADIUS / most * curve.y[:, None] * _rays(curve.x) for curve in curves]


def _polar_grid() -> list[Array]:
    """Half circles and rays."""
    arc = _rays(np.linspace(-0.5 * np.pi, 0.5 * np.pi, 61))
    circles = [_CENTRE + share * _RADIUS * arc for share in (0.25, 0.5, 0.75, 1.0)]
    ends = _CENTRE + _RADIUS * _rays(np.radians([-90.0, -60.0, -30.0, 0.0, 30.0, 60.0, 90.0]))
    return circles + [np.stack([_CENTRE, end]) for end in ends]


def _rays(angle: Array) -> Array:
    """Unit vectors by their angles from the normal, which points up."""
    return np.stack([np.sin(angle), -np.cos(angle)], axis=-1)


def _path(points: Array) -> str:
    return "M" + "L".join(f"{x:.1f} {y:.1f}" for x, y in points)


def _drawn(lines: Sequence[Array], curves: Sequence[Curve]) -> list[str]:
    parts = []
    for index, (line, curve) in enumerate(zip(lines, curves, strict=True)):
        points = " ".join(f"{x:.1f},{y:.1f}" for x, y in line)
        dashes = ' stroke-dasharray="5 3"' if curve.dashed else ""
        color = COLORS[index % len(COLORS)]
        parts.append(f'<polyline points="{points}" fill="none" stroke="{color}" stroke-width="1.6"{dashes}/>')
    return parts


def _legend(curves: Sequence[Curve], x: float, y: float) -> list[str]:
    parts = []
    for index, curve in enumerate(curves):
        row = y + 15.0 * index
        dashes = ' stroke-dasharray="5 3"' if curve.dashed else ""
        color = COLORS[index % len(COLORS)]
        parts.append(f'<path d="M{x:.1f} {row:.1f}h22" stroke="{color}" stroke-width="2"{dashes}/>')
        parts.append(_text(x + 28.0, row + 4.0, curve.name, "start"))
    return parts


def _title(width: float, title: str) -> str:
    """The title, as large as fits: a letter is about half as wide as high."""
    return _text(width / 2.0, 18.0, title, "middle", min(14, int(1.8 * width / max(len(title), 1))))


def _text(x: float, y: float, words: str, anchor: str, size: int = 11) -> str:
    text = escape(words, quote=False)
    return f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}" font-size="{size}">{text}</text>'


def _round_above(value: float) -> float:
    """The next of 1, 2, 2.5, 5 times a power of ten."""
    power = 10.0 ** np.floor(np.log10(max(value, 1e-12)))
    return next(float(step * power) for step in (1.0, 2.0, 2.5, 5.0, 10.0) if value <= step * power * 1.0001)


def _document(width: float, height: float, parts: Sequence[str]) -> str:
    head = (
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{width:.0f}" height="{height:.0f}" '
        f'font-family="sans-serif" viewBox="0 0 {width:.0f} {height:.0f}">\n'
        f"<style>.grid{{stroke:{_GRID_COLOR};fill:none}}.axis{{stroke:#888}}text{{fill:#333}}</style>\n"
        f'<rect width="{width:.0f}" height="{height:.0f}" fill="white"/>\n'
    )
    return head + "\n".join(parts) + "\n</svg>\n"
