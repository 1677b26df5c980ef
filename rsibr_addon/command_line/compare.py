"""Measure how far previews are from what Cycles renders, or from a BRDF's exact reflection."""

import argparse
from typing import TYPE_CHECKING, Any

from . import options
from .report import Report

if TYPE_CHECKING:
    from ..tasks.compare.comparison import Comparison

MODES = ["paper", "texel", "fragment"]
WARPS = ["single", "split", "albedo"]
OWNERS = {
    "samples": "radiance_views",
    "modes": "radiance_views",
    "warpings": "radiance_views",
    "captured_views": "radiance_views",
    "material": "radiance_views",
    "rings": "lobe_stack",
    "brdf": "lobe_stack",
}
"""Name of an option's value -> the kind of map sets that has it."""


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
    options.add_output(parser, "FOLDER", "for the page, its pictures and comparison.json")


def run(arguments: argparse.Namespace, report: Report) -> dict[str, Any]:
    """Compare, and write the folder.

    Returns
    -------
    dict
        "page", the path of the HTML page; "comparison", what comparison.json holds.

    Raises
    ------
    RsibrError
        See `tasks.compare.views` and `tasks.compare.stack`.
    """
    from ..core.errors import RangeError
    from ..files.map_set import read_map_set_header

    kind = read_map_set_header(arguments.map_set)["kind"]
    for name, owner in OWNERS.items():
        if name in vars(arguments) and owner != kind:
            raise RangeError(f"The option for {name} is for {owner}, but this map set holds {kind}: omit it.")
    scene = {
        "views": arguments.views,
        "seed": arguments.seed,
        "mesh": arguments.mesh,
        "field_of_view": options.radians_or_none(arguments.perspective),
        "size": arguments.size,
    }
    compared = _compare_stack if kind == "lobe_stack" else _compare_views
    comparison, table = compared(arguments, scene, report)
    page = arguments.output / "index.html"
    report.say("Relative RMSE over all views:")
    report.say(table)
    report.say(f"{page}")
    return {"page": str(page), "comparison": comparison.to_json()}


def _compare_views(
    arguments: argparse.Namespace, scene: dict[str, Any], report: Report
) -> tuple["Comparison", str]:
    from ..core.kinds.radiance_views.shading import Mode, Warping
    from ..tasks.compare.comparison import ComparisonSettings, comparison_table
    from ..tasks.compare.views import compare

    given = vars(arguments)
    settings = ComparisonSettings(
        **scene,
        samples=given.get("samples", 64),
        modes=tuple(Mode(mode) for mode in given.get("modes", MODES)),
        warpings=tuple(Warping(warping) for warping in given.get("warpings", WARPS)),
        captured_views=tuple(given.get("captured_views", ())),
    )
    comparison = report.steps(
        compare(arguments.map_set, settings, arguments.output, arguments.force, given.get("material"))
    )
    return comparison, comparison_table([comparison])


def _compare_stack(
    arguments: argparse.Namespace, scene: dict[str, Any], report: Report
) -> tuple["Comparison", str]:
    from ..tasks.compare.comparison import StackComparisonSettings, stack_table
    from ..tasks.compare.stack import compare_stack

    given = vars(arguments)
    settings = StackComparisonSettings(**scene, rings=given.get("rings"))
    comparison = report.steps(
        compare_stack(arguments.map_set, settings, arguments.output, arguments.force, given.get("brdf"))
    )
    return comparison, stack_table([comparison])
