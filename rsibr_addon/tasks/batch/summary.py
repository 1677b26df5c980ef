"""What has become of each bake of a batch, and what error it states."""

import json
from collections.abc import Mapping, Sequence
from os.path import relpath
from pathlib import Path
from typing import TypedDict

from ...files.atomic import write_changed
from .bakes import BatchBake
from .notes import Failure, Note

SUMMARY = "summary.json"
"""Name of the file that tells programs, beside the page."""


class Outcome(TypedDict):
    """A bake and what has become of it.

    Attributes
    ----------
    map_set : str
        Path of its output, relative to the folder of the page.
    environment, material, method : str
        Names for people; the material's is empty where light alone is baked.
    state : str
        "done" or "failed".
    errors : dict of str to float
        The errors that the map set states, by the names that its description gives them: of several of a
        name, the largest.
    warnings : list of str
    error : str
        Why it failed; empty where it is done.
    try_again : bool
        Whether another try may help.
    """

    map_set: str
    environment: str
    material: str
    method: str
    state: str
    errors: dict[str, float]
    warnings: list[str]
    error: str
    try_again: bool


def outcomes_of(
    folder: Path, bakes: Sequence[BatchBake], notes: Sequence[Note | None], failures: Mapping[str, Failure]
) -> list[Outcome]:
    """What has become of each bake.

    Parameters
    ----------
    folder : Path
        That of the page.
    bakes : sequence of BatchBake
    notes : sequence of Note or None
        Of each bake.
    failures : mapping of str to Failure
        By output.
    """
    outcomes = []
    for bake, note in zip(bakes, notes, strict=True):
        failure = failures.get(bake.job.output)
        outcome = Outcome(
            map_set=Path(relpath(bake.job.output, folder)).as_posix(),
            environment=bake.environment,
            material=bake.material,
            method=bake.job.settings.LABEL,
            state="failed" if failure else "done",
            errors=note["errors"] if note else {},
            warnings=note["warnings"] if note else [],
            error=failure["error"] if failure else "",
            try_again=failure["try_again"] if failure else False,
        )
        outcomes.append(outcome)
    return outcomes


def write_summary(path: Path, outcomes: Sequence[Outcome]) -> None:
    """Write them as JSON: an object with the list "bakes".

    Parameters
    ----------
    path : Path
        Replaced if it exists.

    Raises
    ------
    OutputFileError
    """
    write_changed(path, json.dumps({"bakes": outcomes}, indent=1) + "\n")


def worst_of(outcomes: Sequence[Outcome]) -> list[tuple[str, str, Outcome]]:
    """For each method and name of an error the bake that states the largest.

    Returns
    -------
    list of tuple
        Method, name and bake, in the order in which they are met.
    """
    worst: dict[tuple[str, str], Outcome] = {}
    for outcome in outcomes:
        for name, error in outcome["errors"].items():
            known = worst.setdefault((outcome["method"], name), outcome)
            if error > known["errors"][name]:
                worst[outcome["method"], name] = outcome
    return [(method, name, outcome) for (method, name), outcome in worst.items()]
