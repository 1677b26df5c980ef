"""Making map sets and baked inputs, by any method."""

import time
from contextlib import ExitStack
from pathlib import Path
from typing import Any

from ...core.errors import OutputFileError
from ...core.lazy_table import LazyTable
from ...core.progress import Progress, Steps
from ...files.apart import check_apart
from ...files.kinds.registry import STORED
from ...files.map_set import check_map_set_target
from ...files.map_set_header import Recipe
from ...files.pictures import split_layer
from ...files.work_folder import clear_parts, held_work_folder, work_folder_beside
from ...job import BakeJob
from ...settings.baked_inputs import ObjectInputsSettings
from ..light.environments import environment_file
from .method import Baked, Method
from .recipe import check_made_by, recipe_of

METHODS = LazyTable[Method](__package__, "METHOD", (*STORED, ObjectInputsSettings.KIND))
"""Kind of map sets, or that of baked inputs -> how it is made."""

WAIT_SECONDS = 0.3
"""Between two looks whether another process is done."""


def bake(job: BakeJob[Any], known_whole: bool = False) -> Steps[Baked]:
    """Do a job, unless its output is there and may be kept.

    Of two processes that make the same file one works. The other waits until it is done, or has died.

    Parameters
    ----------
    job : BakeJob
    known_whole : bool
        See `check_made_by`, of an output that is there before.

    Raises
    ------
    OutputFileError
        The output cannot be written; or it is what is baked from; or it exists and is neither replaced nor
        kept, or was made with other settings.
    RsibrError
        See `bake` of the job's method.

    Warns
    -----
    RsibrWarning
        Likewise.
    """
    method, output = METHODS[job.settings.KIND], Path(job.output)
    folder = work_folder_beside(output)
    # A process killed at its very end has written its output, and left its folder
    keeps = not job.force and (job.if_missing or folder.is_dir())
    if not (keeps and output.is_file()):
        check_map_set_target(output, job.force)
        check_apart(output, source_files(job))
    recipe = recipe_for(job)
    if keeps and output.is_file() and not folder.is_dir():
        return _found(output, recipe, known_whole)
    with ExitStack() as stack:
        yield from _hold(folder, output, stack)
        if keeps and output.is_file():
            found = _found(output, recipe)
            clear_parts(folder)
            return found
        try:
            baked: Baked = yield from method.bake(job, recipe)
        except OutputFileError:
            # Where the disk knows no locks, another process may have been first
            if keeps and output.is_file():
                return _found(output, recipe)
            raise
    return baked


def recipe_for(job: BakeJob[Any]) -> Recipe:
    """The recipe of a job, by its method.

    Raises
    ------
    InputFileError, SceneError, RangeError
        See `recipe_of` and `Method.sources`.
    """
    method = METHODS[job.settings.KIND]
    return method.recipe(job) if method.recipe else recipe_of(job, method.sources(job.settings))


def source_files(job: BakeJob[Any]) -> list[Path]:
    """The files that a job names, but for files of Blender; perhaps missing.

    Raises
    ------
    InputFileError
        There is no environment of a name.
    """
    files = [*METHODS[job.settings.KIND].sources(job.settings).named.values()]
    if job.light.environment is not None:
        files.append(split_layer(environment_file(job.light.environment))[0])
    return files


def _found(output: Path, recipe: Recipe, known_whole: bool = False) -> Baked:
    check_made_by(output, recipe, known_whole)
    known = ", made with these settings" if recipe["kind"] in STORED else ""
    return Baked(output, f"is there already{known}", {"found": True})


def _hold(folder: Path, output: Path, stack: ExitStack) -> Steps[None]:
    """Hold the folder of an output's work as long as `stack` is open; wait while another process does."""
    while True:
        try:
            stack.enter_context(held_work_folder(folder))
        except BlockingIOError:
            yield Progress(0, 1, f"waiting for another process that makes {output.name}")
            time.sleep(WAIT_SECONDS)
        else:
            return
