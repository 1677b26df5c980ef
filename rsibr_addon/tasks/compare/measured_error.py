"""What a comparison has found of a map set, for as long as it is the same."""

from pathlib import Path
from typing import Any

from ...core.errors import InputFileError, SchemaError
from ...core.schema import LARGEST_TEXT, loads
from ...files.output_paths import comparison_beside
from ...files.reading import opened
from ..report.facts import map_set_content, read_once
from .comparison import RESULT, Comparison, ComparisonSettings, StackWay, WayError


def measured_facts(map_set: Path, look: Any = None) -> dict[str, str]:
    """The errors that `comparison_beside` a map set tells.

    Parameters
    ----------
    map_set : Path
    look : object, optional
        Has the attributes `mode` and `warping`, if it is of radiance views: tells of drawing so alone.

    Returns
    -------
    dict
        In words: what -> which; empty where nothing was measured.

    Raises
    ------
    MapSetError
        There is no such map set.
    """
    try:
        comparison = _comparison(comparison_beside(map_set) / RESULT)
    except InputFileError as error:
        return {"Measured": str(error)}
    if comparison is None:
        return {}
    if comparison.content != map_set_content(map_set):
        return {"Measured": "before the file changed: compare again"}
    errors = [error for error in comparison.errors if look is None or _is_of(error, look)]
    if not errors:
        return {}
    reference = "Cycles" if isinstance(comparison.settings, ComparisonSettings) else "the model itself"
    named = len(errors) > 1
    return {
        **{f"Measured{f': {error.way.name}' if named else ''}": _words(error) for error in errors},
        "Against": f"{reference}, {len(comparison.view_dirs)} views",
    }


@read_once
def _comparison(path: Path) -> Comparison | None:
    """What a comparison has written; None where there is none.

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
        return Comparison.from_json(loads(text))
    except SchemaError as error:
        raise InputFileError(f"{path} is no comparison of this version ({error}): compare again.") from error


def _is_of(error: WayError, look: Any) -> bool:
    """Whether it is of a way that is drawn so; there is but one way to draw a lobe stack."""
    way = error.way
    return isinstance(way, StackWay) or (way.mode, way.warping) == (look.mode, look.warping)


def _words(error: WayError) -> str:
    return f"{100.0 * error.pooled:.2g} %, at worst {100.0 * error.worst:.2g} %"
