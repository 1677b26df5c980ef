"""What all kinds of `illuminate` ask for."""

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

from .options import add_output, positive

if TYPE_CHECKING:  # for the help alone, neither numpy nor Blender is to be loaded
    from ..tasks.light.brackets import BracketSettings


def add_environment_output(parser: argparse.ArgumentParser) -> None:
    """Declare where the map goes and how large it is: `output`, `size` and `force`."""
    add_output(parser, "OUT.exr|OUT.hdr", "the latitude-longitude map to write")
    parser.add_argument(
        "--size",
        metavar="N",
        type=positive,
        default=1024,
        help="its width in texels, even; it is half as high (default: %(default)s)",
    )


def add_bracket(parser: argparse.ArgumentParser, description: str) -> None:
    """Declare a bracket: `photographs`, `times`, `times_file`, `curve` and `align`."""
    parser.add_argument("photographs", metavar="PHOTO", nargs="+", type=Path, help=description)
    times = parser.add_mutually_exclusive_group()
    times.add_argument(
        "--times",
        metavar="T,T,...",
        type=exposure_times,
        help="exposure times in seconds, 1/125 or 0.5, one for each (default: what the files' Exif tells)",
    )
    times.add_argument("--times-file", metavar="FILE", type=Path, help="a text file with the exposure times")
    parser.add_argument(
        "--curve",
        choices=["recovered", "srgb", "linear"],
        default="recovered",
        help="how the camera encodes light: found from the photographs, or known (default: %(default)s); "
        "OpenEXR and Radiance HDR are linear",
    )
    parser.add_argument(
        "--no-align", dest="align", action="store_false", help="the camera stood still: do not align"
    )


def bracket_settings(arguments: argparse.Namespace) -> "BracketSettings":
    """The bracket that `add_bracket` declared.

    Raises
    ------
    InputFileError, RangeError
        See `read_times` and `BracketSettings`.
    """
    from ..files.exposure_times import read_times
    from ..tasks.light.brackets import BracketSettings, Curve

    times = arguments.times
    if arguments.times_file is not None:
        times = read_times(arguments.times_file)
    return BracketSettings(tuple(arguments.photographs), times, Curve(arguments.curve), arguments.align)


def exposure_times(text: str) -> tuple[float, ...]:
    """Exposure times, T,T,...: 1/125 or 0.5."""
    from ..files.exposure_times import exposure_time

    try:
        return tuple(exposure_time(part) for part in text.split(","))
    except ValueError:
        raise argparse.ArgumentTypeError(f"'{text}' is not T,T,..., exposure times") from None
