"""The command `rsibr export`."""

import argparse
from pathlib import Path
from typing import Any

from ..core.errors import OutputFileError
from ..core.options import Options
from ..core.progress import Steps
from ..files.kinds.registry import look_types
from ..settings.page import MeshPageOptions
from ..tasks.export.engines.engines import ENGINES
from ..tasks.export.formats import FORMATS
from . import options
from .console import Console
from .file_arguments import add_map_set_or_light, add_output, map_set_or_light

PAGE, PAGE_ENDING = "page", ".html"
"""Name of the options of web pages, and the ending of their files' names."""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare what `run` reads."""
    add_map_set_or_light(parser, "which engines take, as they take the light of map sets")
    uses = "; ".join(f"{name}, {each.use}" for name, each in ENGINES.items())
    parser.add_argument(
        "--for",
        dest="engine",
        metavar="ENGINE",
        choices=list(ENGINES),
        help=f"engine to write for, exactly what it loads, and what to do there: {uses} (default: none)",
    )
    options.add_options_of(parser, _owners())
    endings = dict.fromkeys([*_own_endings(), *_engine_endings()])
    names = "|".join(f"OUT{ending}" for ending in endings)
    add_output(
        parser,
        names,
        "the first file; its name tells the format, HTML is a web page that needs no other file",
    )


def run(arguments: argparse.Namespace, console: Console) -> dict[str, Any]:
    """Export.

    Returns
    -------
    dict
        "textures", the paths of the files that were written.

    Raises
    ------
    RsibrError
        See `tasks.export.export`, `tasks.export.engines.export` and `tasks.export.page.page`.
    """
    from ..tasks.export.engines.export import export_for_engine
    from ..tasks.export.export import export, format_of

    source, output, engine = map_set_or_light(arguments), arguments.output, arguments.engine
    if not engine and output.suffix.lower() == PAGE_ENDING:
        textures = console.steps(_page(source, arguments))
    else:
        if not engine and output.suffix.lower() not in _own_endings():
            raise OutputFileError(
                f"{output} does not end in {' or '.join(_own_endings())}, nor, with --for ENGINE, in "
                f"{' or '.join(_engine_endings())}: give a name that does."
            )
        settings = options.given_of(arguments, _owners(), engine or format_of(output))
        if engine:
            steps = export_for_engine(source, output, engine, settings, arguments.force)
        else:
            steps = export(source, output, settings, arguments.force)
        textures = console.steps(steps)
    for texture in textures:
        console.say(f"{texture}")
    return {"textures": [str(texture) for texture in textures]}


def _own_endings() -> list[str]:
    """Endings of names that are taken without an engine."""
    return [*(each.suffix for each in FORMATS.values()), PAGE_ENDING]


def _engine_endings() -> list[str]:
    """Endings of names that engines take."""
    return list(dict.fromkeys(ending for each in ENGINES.values() for ending in each.endings))


def _page(source: Path, arguments: argparse.Namespace) -> Steps[list[Path]]:
    """Export a web page."""
    from ..tasks.export.page.named import named_meshes
    from ..tasks.export.page.page import export_page
    from ..tasks.methods.kinds import kind_of

    kind = kind_of(source)
    settings = options.given_of(arguments, _owners(), PAGE, beside=kind)
    look = options.given_of(arguments, _owners(), kind, beside=PAGE)
    shown, look = named_meshes(settings.mesh, kind, look)
    return export_page(source, arguments.output, settings, shown, look, arguments.force)


def _owners() -> dict[str, type[Options]]:
    """A format, an engine, a page, or a kind that a page shows -> its options."""
    formats = {name: each.settings for name, each in FORMATS.items()}
    engines = {name: each.settings for name, each in ENGINES.items()}
    return formats | engines | {PAGE: MeshPageOptions} | look_types()
