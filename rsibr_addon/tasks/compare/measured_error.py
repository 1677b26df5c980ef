"""Errors that a comparison measured of a map set that has not changed since."""

from pathlib import Path
from typing import Any

from ...core.errors import InputFileError, SchemaError
from ...core.schema import LARGEST_TEXT, loads
from ...files.kinds.registry import STORED
from ...files.output_paths import comparison_beside
from ...files.read_once import read_once
from ...files.reading import opened
from ..methods.kinds import KINDS
from ..report.facts import map_set_content, map_set_header
from .comparison import RESULT, Comparison, WayError


def measured_facts(map_set: Path, look: Any = None) -> dict[str, str]:
    """The errors that `comparison_beside` a map set tells.

    Parameters
    ----------
    map_set : Path
    look : object, optional
        Look of the map set's kind, if only that way to draw counts.

    Returns
    -------
    dict
        In words: what -> which; empty where nothing was measured.

    Raises
    ------
    MapSetError
        There is no such map set.
    """
    kind = map_set_header(map_set)["kind"]
    truth, settings = KINDS[kind].truth, STORED[kind].comparison
    if truth is None or settings is None:
        return {}
    try:
        comparison = _comparison(comparison_beside(map_set) / RESULT, settings, truth.way)
    except InputFileError as error:
        return {"Measured": str(error)}
    if comparison is None:
        return {}
    if comparison.content != map_set_content(map_set):
        return {"Measured": "before the file changed: compare again"}
    errors = [error for error in comparison.errors if look is None or truth.is_look(error.way, look)]
    if not errors:
        return {}
    named = len(errors) > 1
    return {
        **{f"Measured{f': {error.way.name}' if named else ''}": _words(error) for error in errors},
        "Against": f"{truth.telling(comparison.settings).name}, {len(comparison.view_dirs)} views",
    }


@read_once
def _comparison(path: Path, settings: type, way: type) -> Comparison | None:
    """The comparison in a folder; None if there is none.

    Raises
    ------
    InputFileError
        It cannot be read, or is none of this version.
    """
    if not path.exists():
        return None
    with opened(path) as stream:
        text = stream.read(LARGEST_TEXT + 1)
    try:
        return Comparison.from_json(loads(text), settings, way)
    except SchemaError as error:
        raise InputFileError(f"{path} is no comparison of this version ({error}): compare again.") from error


def _words(error: WayError) -> str:
    return f"{100.0 * error.pooled:.2g} %, at worst {100.0 * error.worst:.2g} %"
