"""A process of a batch: it does job after job, which come on its standard input, one a line.

It says on its standard output what it does, as JSON lines. It ends when its input does: with whoever
started it, even if that was killed.
"""

import base64
import json
import os
import queue
import sys
import threading
import time
from contextlib import closing
from pathlib import Path
from typing import Any, NoReturn

from ..core.errors import RsibrError
from ..core.schema import loads
from ..core.warned import recorded_warnings
from ..files.memory import keep_freed_memory
from ..files.staging import remove_own
from ..job import BakeJob, read_job
from .main import may_pass, sentence_of
from .streams import Outlet, others_hushed


def serve() -> NoReturn:
    """Do jobs until the input ends."""
    from ..core.lobes.kept_fits import fits_kept
    from ..files.environments import environment_kept

    keep_freed_memory()
    told = Outlet(os.dup(1))
    jobs: queue.SimpleQueue[str] = queue.SimpleQueue()

    def hear() -> None:
        for line in sys.stdin:
            jobs.put(line)
        remove_own()
        os._exit(1)

    threading.Thread(target=hear, daemon=True).start()
    with others_hushed(None, os.devnull), environment_kept(), fits_kept():
        while True:
            asked = loads(jobs.get())
            told.write(json.dumps({"result": _result(asked, told)}) + "\n")


def _result(asked: dict[str, Any], told: Outlet) -> dict[str, Any]:
    """What has become of a job, with its times and, if that is wanted, its picture."""
    started, processor = time.monotonic(), time.process_time()
    with recorded_warnings() as warnings:
        try:
            job = read_job(json.dumps(asked["job"]), "The job")
            assert isinstance(job, BakeJob)
            _open(asked["opened"])
            result = _baked(job, told, known_whole=not asked["picture"])
            times = {"seconds": time.monotonic() - started, "processor": time.process_time() - processor}
            if asked["picture"] or not result["found"]:
                result |= {"picture": _picture(job), "errors": _errors(job)}
        except (RsibrError, OSError, MemoryError, ModuleNotFoundError) as error:
            return {"ok": False, "error": sentence_of(error, "rsibr batch"), "try_again": may_pass(error)}
    return result | times | {"warnings": list(dict.fromkeys(warnings))}


def _open(opened: dict[str, str] | None) -> None:
    """Open the file of Blender that a job means, once for all jobs that follow and mean the same."""
    if opened is None:
        return
    from ..host.blend_files import is_open, open_blend
    from ..host.materials import ORIGINAL
    from ..host.preferences import enable_extension

    if not is_open(Path(opened["file"])):
        enable_extension()
        open_blend(Path(opened["file"]))
        os.environ[ORIGINAL] = opened["original"]


def _baked(job: BakeJob[Any], told: Outlet, known_whole: bool) -> dict[str, Any]:
    from ..tasks.methods.bake import bake

    with closing(bake(job, known_whole)) as steps:
        try:
            while True:
                told.write(json.dumps({"progress": vars(next(steps))}) + "\n")
        except StopIteration as end:
            return {"ok": True, "told": end.value.told, "found": "found" in end.value.figures}


def _errors(job: BakeJob[Any]) -> dict[str, float]:
    """The errors that a job's map set states; none of a job that makes none."""
    from ..files.kinds.registry import STORED
    from ..files.map_set import read_map_set_header
    from ..files.map_set_facts import largest_errors

    return largest_errors(read_map_set_header(job.output)) if job.settings.KIND in STORED else {}


def _picture(job: BakeJob[Any]) -> str:
    """A picture of what a job has made, as PNG in base 64."""
    from ..tasks.batch.pictures import png_of_output

    return base64.b64encode(png_of_output(Path(job.output), job.settings.KIND)).decode("ascii")
