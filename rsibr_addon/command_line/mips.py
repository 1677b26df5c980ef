"""Filter an environment into a mip chain for glossy and diffuse reflections."""

import argparse
from typing import Any

from . import options
from .report import Report


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare what `run` reads."""
    options.add_environment(parser)
    parser.add_argument(
        "--filter",
        choices=["box", "bordered", "ggx"],
        default="ggx",
        help="means within each face, as graphics hardware makes them; weighted means across the faces' "
        "borders; or GGX lobes, as engines use them (default: %(default)s)",
    )
    parser.add_argument(
        "--size",
        metavar="N",
        type=options.positive,
        default=256,
        help="of the first mip's faces in texels, a power of 2 (default: %(default)s)",
    )
    parser.add_argument(
        "--roughness",
        metavar="RULE|R0,R1,...",
        type=_roughness,
        default="linear",
        help="of each mip of the filter ggx: linear, mip / last; quadratic, 1 - sqrt(1 - mip / last), as "
        "Filament's; or ascending numbers from 0 to 1, as many as there shall be mips (default: %(default)s)",
    )
    options.add_output(parser, "NAME.rsibr.exr", "the map set to write")


def run(arguments: argparse.Namespace, report: Report) -> dict[str, Any]:
    """Bake.

    Returns
    -------
    dict
        "map_set", the path of the file.

    Raises
    ------
    RsibrError
        See `tasks.methods.mip_chain`.
    """
    from ..tasks.methods.mip_chain import MipSettings, bake_mips

    settings = MipSettings(arguments.filter, arguments.size, arguments.roughness)
    target = arguments.output, arguments.force
    path = report.steps(bake_mips(arguments.environment, settings, *target, arguments.clamp))
    report.say(f"{path}: {settings.filter} mips from {settings.size}x{settings.size}")
    return {"map_set": str(path)}


def _roughness(text: str) -> str | tuple[float, ...]:
    """Numbers, or the name of a rule."""
    try:
        return tuple(float(number) for number in text.split(","))
    except ValueError:
        return text
