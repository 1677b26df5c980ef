"""An environment from photographs of a mirrored ball."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import chain
from pathlib import Path

import numpy as np

from ...core.conventions import Array
from ...core.environment import usable_radiance
from ...core.errors import InputFileError, RangeError
from ...core.light.ball_circle import Circle, find_circle
from ...core.light.ball_photograph import (
    BallSide,
    cut_ball,
    distance_from_view,
    environment_from_balls,
    without_reflectance,
)
from ...core.light.scale import colour_within
from ...core.progress import Progress, Steps
from ...files.orientation import Orientation
from ...files.photographs import orientation_of
from ...files.radiance_pictures import check_radiance_target, holds_radiance
from ...settings.photographs import BallBrackets, BallSettings, BracketKnowledge
from .brackets import in_order, known_times, merged, read_photographs
from .light_pictures import read_light
from .scaling import write_scaled

Where = tuple[float, float, float] | None
"""x, y and radius of the ball's outline in pixels from the top left corner of a photograph as it is stored;
None to find it."""

BRACKETS = BallBrackets()
"""Nothing is known of the exposures but what the files tell."""


@dataclass(frozen=True, eq=False)
class BallReport:
    """What was found in the photographs.

    Attributes
    ----------
    circles : tuple of (Path, (float, float, float))
        x, y and radius of the outline in each, in pixels from its top left corner as it is stored.
    gains : tuple of float
        Gains of each side: see `environment_from_balls`.
    """

    circles: tuple[tuple[Path, tuple[float, float, float]], ...]
    gains: tuple[float, ...]


def illuminate_from_ball(
    photographs: Sequence[Sequence[Path]],
    settings: BallSettings,
    output: Path,
    force: bool = False,
    brackets: BallBrackets = BRACKETS,
) -> Steps[BallReport]:
    """Unwrap photographs of a ball into an environment.

    Parameters
    ----------
    photographs : sequence of sequences of Path
        From one side or from two, of each one photograph or several exposures; these need not be of one size.
    brackets : BallBrackets
        What is known of the exposures.

    Raises
    ------
    InputFileError
        A photograph is missing or unreadable, no ball or no card is found in it, or the exposures cannot be
        merged.
    RangeError
        The sides share nothing to compare their exposures by, or there are not as many times as photographs.

    Warns
    -----
    RsibrWarning
        See `brackets.merged`, `brackets.read_photographs` and `read_light`.
    """
    check_radiance_target(output, force, chain.from_iterable(photographs))
    card = None if settings.card is None else _card(photographs[0], settings.card, settings.clamp)
    sides, circles = [], []
    second = replace(brackets, times=brackets.second_times, times_file=None)
    told = ((brackets, settings.circle, 0.0), (second, settings.second_circle, settings.turn))
    for paths, (bracket, circle, turn) in zip(photographs, told, strict=False):
        picture, found = yield from ball_picture(paths, circle, bracket, settings.clamp)
        distance = settings.distance or np.inf
        if settings.field_of_view is not None:
            longer = max(found[0].width, found[0].height)
            distance = distance_from_view(found[0].circle, longer, math.radians(settings.field_of_view))
        picture = without_reflectance(picture, distance, settings.reflectance)
        sides.append(BallSide(picture, math.radians(turn), math.radians(settings.elevation), distance))
        circles += [outline.from_top_left() for outline in found]
    yield Progress(1, 2, f"unwrapping into {output.name}")
    radiance, gains = environment_from_balls(sides, settings.size, math.radians(settings.camera))
    cut_off = any(len(paths) == 1 and not holds_radiance(paths[0]) for paths in photographs)
    write_scaled(output, radiance, settings, force, card, cut_off)
    return BallReport(tuple(circles), tuple(float(gain) for gain in gains))


@dataclass(frozen=True)
class Outline:
    """A ball found in a photograph.

    Attributes
    ----------
    path : Path
        The photograph.
    circle : Circle
        In the upright photograph.
    width, height : int
        Of the upright photograph, in pixels.
    orientation : Orientation
        How it is stored.
    """

    path: Path
    circle: Circle
    width: int
    height: int
    orientation: Orientation

    def from_top_left(self) -> tuple[Path, tuple[float, float, float]]:
        """Its photograph, and where it is there: see `Where`."""
        point = self.circle.x, self.height - self.circle.y
        x, y = self.orientation.stored_point(*point, self.width, self.height)
        return self.path, (x, y, self.circle.radius)


def ball_picture(
    photographs: Sequence[Path],
    circle: Where,
    bracket: BracketKnowledge = BRACKETS,
    clamp: float | None = None,
) -> Steps[tuple[Array, list[Outline]]]:
    """Cut a ball out of its photographs.

    Parameters
    ----------
    photographs : sequence of Path
        One, or several exposures from one side.
    circle : (float, float, float) or None
        The outline in each: see `Where`.
    bracket : BracketKnowledge
        What is known of the exposures.
    clamp : float, optional
        Greatest radiance; what is brighter becomes this.

    Returns
    -------
    picture : ndarray, shape (size, size, 3)
        Radiance in the square that touches the outline, row 0 at the bottom.
    outlines : list of Outline
        One for each photograph.

    Raises
    ------
    InputFileError, RangeError
        See `illuminate_from_ball`.
    """
    if len(photographs) == 1:
        known_times(photographs, bracket)  # refuses as many as a bracket has
        paths, times = list(photographs), [1.0]
        yield Progress(0, 2, f"reading {paths[0].name}")
        pictures, encoding = [read_light(paths[0], clamp)], None
    else:
        paths, times = in_order(photographs, bracket)
        pictures, encoding = yield from read_photographs(paths)
    outlines = []
    for path, picture in zip(paths, pictures, strict=True):
        yield Progress(0, 2, f"looking for the ball in {path.name}")
        height, width = picture.shape[:2]
        orientation = Orientation() if holds_radiance(path) else orientation_of(path)
        outline = _circle(path, picture, circle, orientation)
        outlines.append(Outline(path, outline, width, height, orientation))
    circles = [outline.circle for outline in outlines]
    size = max(round(2.0 * circle.radius) for circle in circles)
    squares = [cut_ball(picture, circle, size) for picture, circle in zip(pictures, circles, strict=True)]
    if encoding is None:
        return squares[0], outlines
    radiance = merged(paths[0], bracket, squares, times, encoding).radiance
    return usable_radiance(radiance, paths[0].name, clamp), outlines


def _card(photographs: Sequence[Path], given: tuple[float, float, float], clamp: float | None) -> Array:
    """The colour of the card beside a ball."""
    path = photographs[0]
    if len(photographs) > 1:
        raise InputFileError(
            f"{path} is one of several exposures, in which a card has no radiance yet: merge them by rsibr "
            f"illuminate brackets, and give what that makes."
        )
    picture, (x, y, radius) = read_light(path, clamp), given
    height, width = picture.shape[:2]
    orientation = Orientation() if holds_radiance(path) else orientation_of(path)
    try:
        return colour_within(picture, *orientation.upright_point(x, y, width, height), radius)
    except RangeError as error:
        raise InputFileError(f"{path}: {error}") from error


def _circle(path: Path, picture: Array, given: Where, orientation: Orientation) -> Circle:
    """The outline: the one given, or found."""
    height, width = picture.shape[:2]
    try:
        if given is None:
            # Spread around the middle brightness, so that edges show in radiance as in dark exposures
            return find_circle(picture / (picture + max(float(np.median(picture)), 1e-3)))[0]
        x, y, radius = given
        x, y = orientation.upright_point(x, y, width, height)
        circle = Circle(x, height - y, radius)
    except RangeError as error:
        raise InputFileError(f"{path}: {error}") from error
    if not (0.0 <= x <= width and 0.0 <= y <= height and radius <= max(width, height)):
        size = f"{height}x{width}" if orientation.transposed else f"{width}x{height}"
        circle_text = ",".join(f"{number:g}" for number in given)
        raise InputFileError(
            f"{path} is stored as {size}, but the circle {circle_text} is not in it: give "
            f"its middle from the top left corner, and its radius, in pixels."
        )
    return circle
