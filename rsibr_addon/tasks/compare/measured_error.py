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
from .comparison import RESULT, Comparison
from .truth import Truth


def measured_facts(map_set: Path) -> dict[str, str]:
    """The errors that `comparison_beside` a map set tells, of every way to draw.

    Returns
    -------
    dict
        In words: what -> which; empty where nothing was measured.

    Raises
    ------
    MapSetError
        There is no such map set.
    """
    measured = _measured(map_set)
    if isinstance(measured, str):
        return {"Measured": measured} if measured else {}
    truth, comparison = measured
    named = len(comparison.errors) > 1
    return {
        **{
            f"Measured{f': {error.way.name}' if named else ''}": (
                f"{_percent(error.pooled)}, at worst {_percent(error.worst)}"
            )
            for error in comparison.errors
        },
        "Against": f"{truth.telling(comparison.settings).name}, {len(comparison.view_dirs)} views",
    }


def measured_sentence(map_set: Path, look: Any) -> str:
    """How far off a preview is, in a sentence for artists.

    Parameters
    ----------
    map_set : Path
    look : object
        How it is drawn: a look of the map set's kind.

    Returns
    -------
    str
        Empty where nothing was measured.

    Raises
    ------
    MapSetError
        There is no such map set.
    """
    measured = _measured(map_set)
    if isinstance(measured, str):
        return measured
    truth, comparison = measured
    name, views = truth.telling(comparison.settings).name, len(comparison.view_dirs)
    sentences = (
        f"On the whole {_percent(error.pooled)} off {name}, "
        f"{_percent(error.worst)} in the worst of {views} views."
        for error in comparison.errors
        if truth.is_look(error.way, look)
    )
    return next(sentences, "")


def _measured(map_set: Path) -> tuple[Truth, Comparison] | str:
    """A map set's truth and comparison, or why there is none to tell of; empty where nothing was measured.

    Raises
    ------
    MapSetError
        There is no such map set.
    """
    truth = KINDS[map_set_header(map_set)["kind"]].truth
    if truth is None:
        return ""
    try:
        comparison = _comparison_of(map_set, truth)
    except InputFileError as error:
        return str(error)
    return "" if comparison is None else (truth, comparison)


def _comparison_of(map_set: Path, truth: Truth) -> Comparison | None:
    """The comparison of a map set with its truth; None if there is none.

    Raises
    ------
    InputFileError
        It cannot be read, or is of what the file held before.
    """
    settings = STORED[map_set_header(map_set)["kind"]].comparison
    if settings is None:
        return None
    comparison = _comparison(comparison_beside(map_set) / RESULT, settings, truth.way)
    if comparison is not None and comparison.content != map_set_content(map_set):
        raise InputFileError(f"{map_set.name} has changed since it was compared: compare again.")
    return comparison


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


def _percent(error: float) -> str:
    return f"{100.0 * error:.2g} %"
