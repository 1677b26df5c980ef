"""Measure how far previews are from what Cycles renders, or from a BRDF's exact reflection."""

import argparse
from typing import Any

from . import options
from .report import Report

MODES = ["paper", "texel", "fragment"]
WARPS = ["single", "split", "albedo"]


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare what `run` reads; options of one kind that are not given are not in the namespace."""
    options.add_map_set(parser)
    parser.add_argument(
        "--views",
        metavar="N",
        type=options.positive,
        default=30,
        help="how many random views to compare (default: %(default)s)",
    )
    options.add_scene(parser, size=128)
    parser.add_argument(
        "--seed",
        metavar="N",
        type=options.whole,
        default=0,
        help="of everything random (default: %(default)s)",
    )
    views = parser.add_argument_group("radiance views, against Cycles", argument_default=argparse.SUPPRESS)
    views.add_argument(
        "--samples", metavar="N", type=options.positive, help="of Cycles for a pixel (default: 64)"
    )
    views.add_argument(
        "--mode",
        dest="modes",
        choices=MODES,
        action="append",
        help="compare this mode only; may be repeated",
    )
    views.add_argument(
        "--warp",
        dest="warpings",
        choices=WARPS,
        action="append",
        help="compare this warp only; may be repeated",
    )
    views.add_argument(
        "--captured-views",
        type=int,
        choices=[12, 42, 162],
        action="append",
        help="draw from so many of the captured views only; may be repeated (default: from all)",
    )
    views.add_argument(
        "--material",
        metavar="PRESET|FILE.blend:NAME",
        help="the material that was captured, where it is in a file (default: what the map set names)",
    )
    stacks = parser.add_argument_group("lobe stacks, against their BRDF", argument_default=argparse.SUPPRESS)
    stacks.add_argument(
        "--rings",
        metavar="N",
        type=options.positive,
        help="rings of a sphere on which reflection is integrated exactly (default: as the maps are fine)",
    )
    stacks.add_argument(
        "--brdf",
        metavar="SPEC",
        help="the model that was baked, where it is in a file, as rsibr bake takes it (default: what the map "
        "set names)",
    )
    options.add_output(parser, "FOLDER", "for the report, its pictures and comparison.json")


def run(arguments: argparse.Namespace, report: Report) -> dict[str, Any]:
    """Compare, and write the folder.

    Returns
    -------
    dict
        "page", the path of the report, an HTML file; "comparison", what comparison.json holds.

    Raises
    ------
    RsibrError
        See `tasks.compare.compare`.
    """
    from dataclasses import fields

    from ..core.errors import RangeError
    from ..core.schema import decode
    from ..tasks.compare.compare import compare, truth_of
    from ..tasks.methods.kinds import KINDS

    truth = truth_of(arguments.map_set)
    owners = {
        each.name: kind for kind, row in KINDS.items() if row.truth for each in fields(row.truth.settings)
    }
    given = {name: value for name, value in vars(arguments).items() if name in owners}
    for name in given:
        if name not in truth.settings.__dataclass_fields__:
            raise RangeError(
                f"The option for {name} is for {owners[name]}, which this map set is not: omit it."
            )
    field_of_view = options.radians_or_none(arguments.perspective)
    settings = decode(truth.settings, given | {"field_of_view": field_of_view})
    comparison = report.steps(compare(arguments.map_set, settings, arguments.output, arguments.force))
    page = arguments.output / "index.html"
    report.say("Relative RMSE over all views:")
    report.say(truth.table([comparison]))
    report.say(f"{page}")
    return {"page": str(page), "comparison": comparison.to_json()}
