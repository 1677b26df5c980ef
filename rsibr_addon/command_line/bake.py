"""Filter an environment with the lobes of a reflectance model into a stack of maps."""

import argparse
from pathlib import Path
from typing import Any

from . import options
from .report import Report

FITTING = ("method", "lobes", "slices", "taps", "error")
"""What `--brdf` takes and a fit has already."""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare what `run` reads; options of a fit that are not given are not in the namespace."""
    options.add_environment(parser)
    source = parser.add_mutually_exclusive_group(required=True)
    source.add_argument(
        "--brdf",
        metavar="SPEC",
        help="ggx:alpha=0.3,metal=copper or ward:alpha=0.04,ks=0.8 or merl:path=FILE ...",
    )
    source.add_argument("--fit", metavar="FIT.json", type=Path, help="instead, lobes that rsibr fit made")
    fitting = parser.add_argument_group("fit of a BRDF, see rsibr fit", argument_default=argparse.SUPPRESS)
    fitting.add_argument("--method", help="joint, greedy, single or single-2d (default: joint)")
    fitting.add_argument("--lobes", metavar="J", type=options.positive, help="for each layer (default: 3)")
    fitting.add_argument("--slices", metavar="K", type=options.positive, help="elevations (default: 16)")
    fitting.add_argument(
        "--taps",
        metavar="T",
        type=options.positive,
        help="lookups of each lobe's map (default: as many as pay)",
    )
    fitting.add_argument("--error", metavar="E", type=float, help="as few lobes as keep this error, 0.05 say")
    parser.add_argument(
        "--layout",
        choices=["dual_paraboloid", "octahedral"],
        default="dual_paraboloid",
        help="of the maps (default: %(default)s)",
    )
    parser.add_argument(
        "--size",
        metavar="N",
        type=options.positive,
        help="width of a map's sheets in texels (default: as the lobes need)",
    )
    parser.add_argument(
        "--half", action="store_true", help="store 16-bit floats: half the space, 11 significant bits"
    )
    options.add_output(parser, "NAME.rsibr.exr", "the map set to write")


def run(arguments: argparse.Namespace, report: Report) -> dict[str, Any]:
    """Bake.

    Returns
    -------
    dict
        "map_set", the path of the file; of its maps "lobes", "elevations" and "size"; "interpolation", the
        relative error that lookups are expected to cost.

    Raises
    ------
    RsibrError
        See `tasks.methods.lobe_stack`.
    """
    from ..core.errors import RangeError
    from ..tasks.methods.lobe_stack import StackSettings, bake_brdf, bake_fit
    from ..tasks.reflectance.fit_lobes import FitSettings

    given = {name: value for name, value in vars(arguments).items() if name in FITTING}
    settings = StackSettings(arguments.layout, arguments.size, arguments.half)
    target = settings, arguments.output, arguments.force, arguments.clamp
    if arguments.fit is None:
        steps = bake_brdf(arguments.environment, arguments.brdf, FitSettings(**given), *target)
    elif given:
        raise RangeError(f"A fit has its own {', '.join(given)}: leave the options out, or give a BRDF.")
    else:
        steps = bake_fit(arguments.environment, arguments.fit, *target)
    baked = report.steps(steps)
    lobes, maps = baked.fit.weights.shape[:2]
    size = baked.filtered.size
    report.say(f"{arguments.output}: lobes: {lobes}, maps of each: {maps}, {size}x{size} texels")
    return {
        "map_set": str(arguments.output),
        "lobes": lobes,
        "elevations": len(baked.fit.mu),
        "size": size,
        "interpolation": baked.interpolation,
    }
