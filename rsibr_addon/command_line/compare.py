"""The command `rsibr compare`."""

import argparse
from typing import Any

from ..files.kinds.registry import STORED
from . import options
from .console import Console


def _owners() -> dict[str, Any]:
    """Kind of map sets -> how it is compared, of those that are."""
    return {kind: stored.comparison for kind, stored in STORED.items() if stored.comparison}


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare what `run` reads."""
    options.add_map_set(parser)
    options.add_options_of(parser, _owners())
    options.add_output(parser, "FOLDER", "for the report, its pictures and comparison.json")


def run(arguments: argparse.Namespace, console: Console) -> dict[str, Any]:
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
    from ..tasks.compare.compare import compare, truth_of
    from ..tasks.methods.kinds import kind_of

    truth = truth_of(arguments.map_set)
    settings = options.given_of(arguments, _owners(), kind_of(arguments.map_set))
    comparison = console.steps(compare(arguments.map_set, settings, arguments.output, arguments.force))
    page = arguments.output / "index.html"
    console.say("Relative RMSE over all views:")
    console.say(truth.table([comparison]))
    console.say(f"{page}")
    return {"page": str(page), "comparison": comparison.to_json()}
