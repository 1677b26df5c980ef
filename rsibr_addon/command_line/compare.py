"""The command `rsibr compare`."""

import argparse
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

from ..core.counted import counted
from ..files.kinds.registry import STORED
from . import options
from .console import Console
from .file_arguments import add_map_set, add_output

if TYPE_CHECKING:
    from ..tasks.compare.comparison import Comparison


def _owners() -> dict[str, Any]:
    """Kind of map sets -> how it is compared, of those that are."""
    return {kind: stored.comparison for kind, stored in STORED.items() if stored.comparison}


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare what `run` reads."""
    add_map_set(parser)
    options.add_options_of(parser, _owners())
    add_output(parser, "FOLDER", "for the report, its pictures and comparison.json")


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

    telling = truth_of(arguments.map_set).telling
    settings = options.given_of(arguments, _owners(), kind_of(arguments.map_set))
    comparison = console.steps(compare(arguments.map_set, settings, arguments.output, arguments.force))
    page = arguments.output / "index.html"
    for line in (*lines(comparison, telling(comparison.settings).name), str(page)):
        console.say(line)
    return {"page": str(page), "comparison": comparison.to_json()}


def lines(comparison: "Comparison", against: str) -> Iterator[str]:
    """A comparison in words: the errors first, as the names of ways to draw are long."""
    noise = f", whose own noise is {comparison.reference_noise:.4f}" if comparison.reference_noise else ""
    count = len(comparison.view_dirs)
    yield f"Relative RMSE against {against}{noise}, {counted(count, 'view')}:"
    yield "all views  median   worst  way of drawing"
    for error in comparison.errors:
        yield f"{error.pooled:9.4f}{error.median:8.4f}{error.worst:8.4f}  {error.way.name}"
