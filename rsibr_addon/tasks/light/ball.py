"""An environment from photographs of a mirrored ball."""

import math
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ...core.conventions import Array
from ...core.errors import InputFileError, RangeError
from ...core.light.ball_circle import Circle, find_circle
from ...core.light.ball_photograph import BallSide, cut_ball, distance_from_view, environment_from_balls
from ...core.maps.representation import representation
from ...core.progress import Progress, Steps
from ...files.orientation import Orientation
from ...files.photographs import orientation_of
from ...files.radiance_pictures import check_radiance_target, holds_radiance, write_radiance
from .brackets import BracketSettings, merged, read_photographs
from .light_pictures import read_light


@dataclass(frozen=True)
class SideSettings:
    """The photographs of a ball from one side.

    Attributes
    ----------
    bracket : BracketSettings
        One photograph or several exposures; these need not be of one size.
    circle : tuple of 3 floats or None
        x, y and radius of the ball's outline in pixels from the top left corner of the photographs as
        they are stored, however they are to be turned; None to find it in each.
    turn : float
        See `core.light.ball_photograph.BallSide` [rad].
    """

    bracket: BracketSettings
    circle: tuple[float, float, float] | None = None
    turn: float = 0.0


@dataclass(frozen=True)
class BallSettings:
    """All photographs of a ball, and how they were taken.

    Attributes
    ----------
    sides : tuple of SideSettings
    size : int
        Width of the environment in texels, even.
    distance : float or None
        Of the cameras in radii of the ball; None for a distant one, or one that `field_of_view` tells.
    field_of_view : float or None
        Angle that the longer side of the photographs shows, if they are not cropped [rad].
    elevation : float
        How far the cameras looked down [rad].
    camera_angle : float
        See `core.light.ball_photograph.environment_from_balls` [rad].

    Raises
    ------
    RangeError
        A number is out of its range.
    """

    sides: tuple[SideSettings, ...]
    size: int
    distance: float | None = None
    field_of_view: float | None = None
    elevation: float = 0.0
    camera_angle: float = math.radians(15.0)

    def __post_init__(self) -> None:
        representation("equirect").shape(self.size)
        if self.distance is not None:
            representation("mirror_ball", distance=self.distance)
        if not -0.5 * math.pi < self.elevation < 0.5 * math.pi:
            raise RangeError("A camera looks down by less than 90 degrees: check its elevation.")
        if not 0.0 <= self.camera_angle < math.pi:
            raise RangeError("A camera's reflection takes up from 0 to 180 degrees: check its angle.")


@dataclass(frozen=True, eq=False)
class BallReport:
    """What was found in the photographs.

    Attributes
    ----------
    circles : tuple of (Path, (float, float, float))
        x, y and radius of the outline in each, as in `SideSettings`.
    gains : tuple of float
        Of each side: see `environment_from_balls`.
    """

    circles: tuple[tuple[Path, tuple[float, float, float]], ...]
    gains: tuple[float, ...]


def illuminate_from_ball(settings: BallSettings, output: Path, force: bool = False) -> Steps[BallReport]:
    """Unwrap photographs of a ball into an environment.

    Parameters
    ----------
    settings : BallSettings
    output : Path
        NAME.exr or NAME.hdr.
    force : bool
        Whether an existing file is replaced.

    Yields
    ------
    Progress

    Returns
    -------
    BallReport

    Raises
    ------
    InputFileError
        A photograph is missing or unreadable, no ball is found in it, or the exposures cannot be merged.
    RangeError
        The sides share nothing to compare their exposures by.
    OutputFileError
        See `write_radiance`.

    Warns
    -----
    RsibrWarning
        See `brackets.merged`, `brackets.read_photographs` and `read_light`.
    """
    check_radiance_target(output, force)
    sides, circles = [], []
    for side in settings.sides:
        picture, found = yield from _picture(side)
        distance = settings.distance or np.inf
        if settings.field_of_view is not None:
            longer = max(found[0].width, found[0].height)
            distance = distance_from_view(found[0].circle, longer, settings.field_of_view)
        sides.append(BallSide(picture, side.turn, settings.elevation, distance))
        circles += [outline.from_top_left() for outline in found]
    yield Progress(1, 2, f"unwrapping into {output.name}")
    radiance, gains = environment_from_balls(sides, settings.size, settings.camera_angle)
    write_radiance(output, radiance, force)
    return BallReport(tuple(circles), tuple(float(gain) for gain in gains))


@dataclass(frozen=True)
class _Outline:
    """A ball found in a photograph of some size."""

    path: Path
    circle: Circle
    width: int
    height: int
    orientation: Orientation

    def from_top_left(self) -> tuple[Path, tuple[float, float, float]]:
        point = self.circle.x, self.height - self.circle.y
        x, y = self.orientation.stored_point(*point, self.width, self.height)
        return self.path, (x, y, self.circle.radius)


def _picture(side: SideSettings) -> Steps[tuple[Array, list[_Outline]]]:
    """Radiance in the square around the ball, and the outlines."""
    if len(side.bracket.photographs) == 1:
        paths, times = list(side.bracket.photographs), [1.0]
        yield Progress(0, 2, f"reading {paths[0].name}")
        pictures, encoding = [read_light(paths[0])], None
    else:
        paths, times = side.bracket.in_order()
        pictures, encoding = yield from read_photographs(paths)
    outlines = []
    for path, picture in zip(paths, pictures, strict=True):
        yield Progress(0, 2, f"looking for the ball in {path.name}")
        height, width = picture.shape[:2]
        orientation = Orientation() if holds_radiance(path) else orientation_of(path)
        circle = _circle(path, picture, side, orientation)
        outlines.append(_Outline(path, circle, width, height, orientation))
    circles = [outline.circle for outline in outlines]
    size = max(round(2.0 * circle.radius) for circle in circles)
    squares = [cut_ball(picture, circle, size) for picture, circle in zip(pictures, circles, strict=True)]
    if encoding is None:
        return squares[0], outlines
    return merged(side.bracket, squares, times, encoding).radiance, outlines


def _circle(path: Path, picture: Array, side: SideSettings, orientation: Orientation) -> Circle:
    """The outline: the one given, or found."""
    height, width = picture.shape[:2]
    try:
        if side.circle is None:
            # Spread around the middle brightness, so that edges show in radiance as in dark exposures
            return find_circle(picture / (picture + max(float(np.median(picture)), 1e-3)))[0]
        x, y, radius = side.circle
        x, y = orientation.upright_point(x, y, width, height)
        circle = Circle(x, height - y, radius)
    except RangeError as error:
        raise InputFileError(f"{path}: {error}") from error
    if not (0.0 <= x <= width and 0.0 <= y <= height and radius <= max(width, height)):
        size = f"{height}x{width}" if orientation.transposed else f"{width}x{height}"
        circle_text = ",".join(f"{number:g}" for number in side.circle)
        raise InputFileError(
            f"{path} is stored as {size}, but the circle {circle_text} is not in it: give "
            f"its middle from the top left corner, and its radius, in pixels."
        )
    return circle
