"""What a batch keeps of each bake beside its page: times, warnings and a picture, for later runs."""

import hashlib
import json
import os
from pathlib import Path
from typing import TypedDict

from ...core.errors import SchemaError
from ...core.schema import Decoded, decode, loads
from ...files.atomic import written_aside
from ...files.read_once import file_stamp
from .bakes import BatchBake


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
    errors : dict of str to float
        What its description states: the largest of each name.
    warnings : list of str
    picture : str
        PNG in base 64.
    """

    stamp: str
    told: str
    seconds: float
    processor: float
    errors: dict[str, float]
    warnings: list[str]
    picture: str


class Failure(TypedDict):
    """What is kept of a bake that failed, until it is done.

    Attributes
    ----------
    error : str
    try_again : bool
        Whether another try may help.
    """

    error: str
    try_again: bool


def batch_folder(path: Path, outputs: Path) -> Path:
    """The folder of the page and the notes of a batch NAME.json: NAME-batch among its outputs."""
    return outputs / f"{path.stem}-batch"


def read_note(folder: Path, bake: BatchBake) -> Note | None:
    """The note of a bake; None where there is none, or the map set has changed since."""
    note = _read(Note, folder, bake)
    return note if note and note["stamp"] == stamp_of(bake) else None


def read_failure(folder: Path, bake: BatchBake) -> Failure | None:
    """Why a bake failed last; None where it did not, or was not done."""
    return _read(Failure, folder, bake)


def _read(kept: type[Decoded], folder: Path, bake: BatchBake) -> Decoded | None:
    try:
        return decode(kept, loads(_path(folder, bake).read_bytes()))
    except (OSError, SchemaError):
        return None


def stamp_of(bake: BatchBake) -> str:
    """Time and size of a bake's map set, which change when it is made again; empty where there is none."""
    return " ".join(map(str, file_stamp(Path(bake.job.output)) or ()))


def write_note(folder: Path, bake: BatchBake, note: Note | Failure) -> None:
    """Keep what has become of a bake, in place of what was known before.

    Raises
    ------
    OutputFileError
    """
    with written_aside(_path(folder, bake), force=True) as aside:
        aside.write_text(json.dumps(note), encoding="utf-8")


def _path(folder: Path, bake: BatchBake) -> Path:
    output = os.path.relpath(bake.job.output, folder.parent)
    return folder / f"{hashlib.sha256(os.fsencode(output)).hexdigest()[:16]}.json"
