"""The command `rsibr export`."""

import argparse
from pathlib import Path
from typing import Any

from ..core.options import Options
from ..tasks.export.engines.engines import ENGINES
from ..tasks.export.formats import FORMATS
from . import options
from .console import Console


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare what `run` reads."""
    parser.add_argument(
        "map_set",
        metavar="NAME.rsibr.exr|PICTURE",
        type=Path,
        help="a map set; for an engine a mip chain, or a picture of an environment, OpenEXR or Radiance HDR",
    )
    uses = "; ".join(f"{name}, {each.use}" for name, each in ENGINES.items())
    parser.add_argument(
        "--for",
        dest="engine",
        metavar="ENGINE",
        choices=list(ENGINES),
        help=f"engine to write for, exactly what it loads, and what to do there: {uses} (default: none)",
    )
    options.add_options_of(parser, _owners())
    suffixes = [each.suffix for each in FORMATS.values()]
    endings = dict.fromkeys([*suffixes, *(name for each in ENGINES.values() for name in each.endings)])
    names = "|".join(f"OUT{ending}" for ending in endings)
    options.add_output(parser, names, "the first file; its name tells the format")


def run(arguments: argparse.Namespace, console: Console) -> dict[str, Any]:
    """Export.

    Returns
    -------
    dict
        "textures", the paths of the files that were written.

    Raises
    ------
    RsibrError
        See `tasks.export.export` and `tasks.export.engines.export`.
    """
    from ..tasks.export.engines.export import export_for_engine
    from ..tasks.export.export import export, format_of

    source, output, engine = arguments.map_set, arguments.output, arguments.engine
    settings = options.given_of(arguments, _owners(), engine or format_of(output))
    if engine:
        steps = export_for_engine(source, output, engine, settings, arguments.force)
    else:
        steps = export(source, output, settings, arguments.force)
    textures = console.steps(steps)
    for texture in textures:
        console.say(f"{texture}")
    return {"textures": [str(texture) for texture in textures]}


def _owners() -> dict[str, type[Options]]:
    """A format or an engine -> its options."""
    formats = {name: each.settings for name, each in FORMATS.items()}
    return formats | {name: each.settings for name, each in ENGINES.items()}
