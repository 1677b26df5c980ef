"""A batch as a list of jobs, whose files lie in its folder: so it means the same wherever the folder is."""

import json
from collections.abc import Iterator, Sequence
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Any, Literal

from ...core.errors import InputFileError, SchemaError
from ...core.schema import decode
from ...job import BakeJob, read_job
from .bakes import BatchBake, Opened

HERE = "{folder}"
"""What stands for the list's folder within its texts."""


@dataclass(frozen=True)
class _Entry:
    environment: str
    material: str
    job: dict[str, Any]
    opened: Opened | None = None


@dataclass(frozen=True)
class _BakeList:
    format: Literal[2]
    bakes: tuple[_Entry, ...]


def is_bake_list(plain: Any) -> bool:
    """Whether JSON values are a list of jobs."""
    return isinstance(plain, dict) and "bakes" in plain


def bake_list_text(bakes: Sequence[BatchBake]) -> str:
    """Bakes as JSON, which `bakes_of_list` takes back.

    Parameters
    ----------
    bakes : sequence of BatchBake
        Their outputs are relative; paths of files in the list's folder begin with `HERE`.
    """
    entries = [
        {
            "environment": bake.environment,
            "material": bake.material,
            "job": json.loads(bake.job.to_json()),
            "opened": asdict(bake.opened) if bake.opened else None,
        }
        for bake in bakes
    ]
    return json.dumps({"format": 2, "bakes": entries}, indent=1)


def bakes_of_list(plain: Any, folder: Path, outputs: Path) -> Iterator[BatchBake]:
    """The bakes of a list.

    Parameters
    ----------
    plain : object
        JSON values.
    folder : Path
        The list's.
    outputs : Path
        Where outputs go.

    Raises
    ------
    SchemaError
        They are no list of jobs.
    """
    for entry in decode(_BakeList, _here(plain, str(folder))).bakes:
        try:
            job = read_job(json.dumps(entry.job), f"{entry.material} in {entry.environment}")
        except InputFileError as error:
            raise SchemaError(str(error)) from error
        if not isinstance(job, BakeJob):
            raise SchemaError(f"{entry.material} in {entry.environment} is no bake")
        placed = replace(job, output=str(outputs / job.output))
        yield BatchBake(entry.environment, entry.material, placed, entry.opened)


def _here(plain: Any, folder: str) -> Any:
    """JSON values with the folder's path in their texts."""
    match plain:
        case dict():
            return {name: _here(value, folder) for name, value in plain.items()}
        case list():
            return [_here(value, folder) for value in plain]
        case str():
            return plain.replace(HERE, folder)
    return plain
