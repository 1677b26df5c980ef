"""What all kinds of `illuminate` ask for."""

import argparse

from .options import add_output, positive


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
