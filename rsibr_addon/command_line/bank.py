"""Filter an environment into a bank of kernels: materials are then chosen in the preview, without a bake."""

import argparse
from typing import Any

from . import options
from .report import Report


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare what `run` reads."""
    options.add_environment(parser)
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
        default=128,
        help="width of a map's sheets in texels; larger ones hold sharper lobes (default: %(default)s)",
    )
    options.add_output(parser, "NAME.rsibr.exr", "the map set to write")


def run(arguments: argparse.Namespace, report: Report) -> dict[str, Any]:
    """Bake.

    Returns
    -------
    dict
        "map_set", the path of the file; "kernels", how many; "sharpest", the last one's concentration.

    Raises
    ------
    RsibrError
        See `tasks.methods.kernel_bank`.
    """
    from ..tasks.methods.kernel_bank import BankSettings, bake_environment

    settings = BankSettings(arguments.layout, arguments.size)
    output = arguments.output
    target = output, arguments.force, arguments.clamp
    baked = report.steps(bake_environment(arguments.environment, settings, *target))
    kernels, sharpest, size = len(baked.filtered.bank), baked.filtered.sharpest, settings.size
    report.say(
        f"{output}: {kernels} kernels, the sharpest of concentration {sharpest:g}, {size}x{size} texels"
    )
    return {"map_set": str(output), "kernels": kernels, "sharpest": sharpest}
