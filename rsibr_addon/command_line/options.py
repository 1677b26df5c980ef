"""What several commands ask for, and what the text of an argument means."""

import argparse
import math
from pathlib import Path


def positive(text: str) -> int:
    """A whole number from 1."""
    value = int(text) if text.isascii() and text.isdigit() else 0
    if value < 1:
        raise argparse.ArgumentTypeError(f"'{text}' is not a whole number from 1")
    return value


def whole(text: str) -> int:
    """A whole number from 0."""
    if not (text.isascii() and text.isdigit()):
        raise argparse.ArgumentTypeError(f"'{text}' is not a whole number from 0")
    return int(text)


def position(text: str) -> tuple[float, float, float]:
    """Three finite numbers, X,Y,Z."""
    try:
        x, y, z = (float(number) for number in text.split(","))
    except ValueError:
        raise argparse.ArgumentTypeError(f"'{text}' is not X,Y,Z, three numbers") from None
    if not math.isfinite(math.hypot(x, y, z)):
        raise argparse.ArgumentTypeError(f"'{text}' points nowhere")
    return x, y, z


def whole_numbers(text: str) -> tuple[int, ...]:
    """Whole numbers from 0, between commas."""
    return tuple(whole(number) for number in text.split(","))


def direction(text: str) -> tuple[float, float, float]:
    """Three numbers, X,Y,Z, not all 0."""
    vector = position(text)
    if not any(vector):
        raise argparse.ArgumentTypeError(f"'{text}' points nowhere")
    return vector


def colour(text: str) -> tuple[float, float, float]:
    """Three numbers, R,G,B, or one for all of them."""
    try:
        numbers = [float(number) for number in text.split(",")]
        red, green, blue = numbers if len(numbers) > 1 else 3 * numbers
    except ValueError:
        raise argparse.ArgumentTypeError(f"'{text}' is neither a number nor R,G,B, three numbers") from None
    return red, green, blue


def radiance(text: str) -> float:
    """A radiance that 32-bit floats hold, above 0."""
    try:
        value = float(text)
    except ValueError:
        value = 0.0
    if not 1e-30 <= value <= 1e30:
        raise argparse.ArgumentTypeError(f"'{text}' is not a radiance, a number from 1e-30 to 1e30")
    return value


def degrees(text: str) -> float:
    """An angle in degrees, above 0 and below 180."""
    try:
        value = float(text)
    except ValueError:
        value = 0.0
    if not 0.0 < value < 180.0:
        raise argparse.ArgumentTypeError(f"'{text}' is not an angle between 0 and 180 degrees")
    return value


def add_environment(parser: argparse.ArgumentParser) -> None:
    """Declare `environment`, None for the world of the open file, and `clamp`."""
    parser.add_argument(
        "--environment",
        metavar="FILE",
        help="latitude-longitude picture (EXR or HDR), or the bare name of one of Blender's own, as forest "
        "(default: the world of the open file)",
    )
    add_clamp(parser)


def add_clamp(parser: argparse.ArgumentParser) -> None:
    """Declare `clamp`, the greatest radiance that is kept of what is read; None for all."""
    parser.add_argument(
        "--clamp",
        metavar="VALUE",
        type=radiance,
        help="take radiance above VALUE, and what is infinite, as VALUE, and say how many values that are "
        "(default: take what is infinite as the greatest value that is not)",
    )


def add_map_set(parser: argparse.ArgumentParser) -> None:
    """Declare `map_set`, the file to work on."""
    parser.add_argument("map_set", metavar="NAME.rsibr.exr", type=Path, help="a map set")


def add_scene(parser: argparse.ArgumentParser, size: int) -> None:
    """Declare what is drawn and how large: `mesh`, `perspective` and `size`, by default as given."""
    parser.add_argument(
        "--mesh",
        metavar="MESH",
        default="sphere",
        help="sphere, monkey or FILE.obj; fitted into the unit sphere, which fills the frame",
    )
    parser.add_argument(
        "--perspective", metavar="DEG", type=degrees, help="angle of view (default: orthographic)"
    )
    parser.add_argument(
        "--size",
        metavar="N",
        type=positive,
        default=size,
        help="width and height of a picture in pixels (default: %(default)s)",
    )


def add_rendering(parser: argparse.ArgumentParser, samples: int) -> None:
    """Declare how well Cycles renders, `samples`, by default as given, and `seed`."""
    parser.add_argument(
        "--samples",
        metavar="N",
        type=positive,
        default=samples,
        help="of Cycles for a pixel (default: %(default)s)",
    )
    parser.add_argument(
        "--seed", metavar="N", type=whole, default=0, help="of everything random (default: %(default)s)"
    )


def add_output(parser: argparse.ArgumentParser, metavar: str, description: str) -> None:
    """Declare where the result goes, `output`, and whether it replaces what is there, `force`."""
    parser.add_argument("-o", "--output", metavar=metavar, type=Path, required=True, help=description)
    parser.add_argument("--force", action="store_true", help="replace what exists")


def radians_or_none(angle: float | None) -> float | None:
    """An angle in degrees in radians; None, for an orthographic camera, stays."""
    return None if angle is None else math.radians(angle)
