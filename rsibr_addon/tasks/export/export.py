"""Map sets as files for other programs."""

from pathlib import Path
from typing import Any

from ...core.errors import OutputFileError
from ...core.progress import Progress, Steps
from ...files.map_set import read_map_set
from ...files.outputs import together
from .formats import FORMATS


def format_of(output: Path) -> str:
    """The format that a name asks for: one of `FORMATS`.

    Raises
    ------
    OutputFileError
        Its suffix is that of none.
    """
    for name, each in FORMATS.items():
        if output.suffix.lower() == each.suffix:
            return name
    known = " or ".join(each.suffix for each in FORMATS.values())
    raise OutputFileError(f"{output} does not end in {known}: give a name that does.")


def export(map_set: Path, output: Path, settings: Any = None, force: bool = False) -> Steps[list[Path]]:
    """Write a map set's maps for other programs, into one file or several; all files appear, or none.

    Parameters
    ----------
    output : Path
        Its suffix tells the format.
    settings : object, optional
        Settings of the format, see `Format.settings`; by default its own.

    Raises
    ------
    MapSetError
        See `files.map_set.read_map_set`.
    RangeError
        The format cannot hold the map set with these settings.
    OutputFileError
        The name is of no format.

    Notes
    -----
    docs/export.md says what the files hold.
    """
    chosen = FORMATS[format_of(output)]
    yield Progress(0, 2, f"reading {map_set.name}")
    held = read_map_set(map_set)
    yield Progress(1, 2, f"writing {output.name}")
    with together():
        return chosen.write(map_set, held, output, settings or chosen.settings(), force)
