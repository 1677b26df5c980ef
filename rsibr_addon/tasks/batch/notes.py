"""What a batch keeps of each bake beside its page: times, warnings and a picture, for later runs."""

import hashlib
import json
import os
from pathlib import Path
from typing import TypedDict

from ...core.errors import SchemaError
from ...core.schema import decode, loads
from ...files.atomic import written_aside
from ...files.read_once import file_stamp
from .description import BatchBake


class Note(TypedDict):
    """What is kept of a bake that is done.

    Attributes
    ----------
    stamp : str
        Time and size of the map set that it tells of: see `stamp_of`.
    told : str
        What that is, in words.
    seconds, processor : float
        Duration and processor time; zeros where another made it.
    warnings : list of str
    picture : str
        PNG in base 64.
    """

    stamp: str
    told: str
    seconds: float
    processor: float
    warnings: list[str]
    picture: str


def batch_folder(path: Path) -> Path:
    """The folder of a batch's page and notes: NAME-batch beside NAME.json."""
    return path.with_name(f"{path.stem}-batch")


def read_note(folder: Path, bake: BatchBake) -> Note | None:
    """The note of a bake; None where there is none, or the map set has changed since."""
    try:
        note: Note = decode(Note, loads(_path(folder, bake).read_bytes()))
    except (OSError, SchemaError):
        return None
    return note if note["stamp"] == stamp_of(bake) else None


def stamp_of(bake: BatchBake) -> str:
    """Time and size of a bake's map set, which change when it is made again; empty where there is none."""
    return " ".join(map(str, file_stamp(Path(bake.job.output)) or ()))


def write_note(folder: Path, bake: BatchBake, note: Note) -> None:
    """Keep a note.

    Raises
    ------
    OutputFileError
    """
    with written_aside(_path(folder, bake), force=True) as aside:
        aside.write_text(json.dumps(note), encoding="utf-8")


def _path(folder: Path, bake: BatchBake) -> Path:
    output = os.path.relpath(bake.job.output, folder.parent)
    return folder / f"{hashlib.sha256(os.fsencode(output)).hexdigest()[:16]}.json"
