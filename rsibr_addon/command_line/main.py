"""The command line: `rsibr ...` beside the bpy module, `blender --command rsibr ...` within Blender.

Results go to standard output (with ``--json`` one JSON object, its last line); progress, warnings and errors
to standard error, and nothing that Blender says, unless ``--verbose``. Exit codes: 0 done, 1 failed for good,
2 usage, 75 failed but may succeed another time; 128 and its number after a signal that asked for the end.

What is imported here is light: a signal is heeded before Python reads the rest.
"""

import argparse
import contextlib
import json
import os
import shutil
import signal
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path
from typing import Any, NoReturn

from ..core.errors import MemoryShortageError, NotNowError, RenderError, RsibrError
from ..files.locks import held
from ..files.outputs import MAY_PASS
from ..files.staging import remove_own
from . import endings
from .streams import Outlet, open_closed_streams, others_hushed, own_streams

BLENDERS_MODULES = frozenset({"bpy", "bmesh", "gpu", "gpu_extras", "mathutils"})
"""What comes with Blender alone."""


def console() -> int:
    """Run with the arguments of the process: the entry point of `rsibr`."""
    open_closed_streams()
    argv = sys.argv[1:]
    if sys.platform == "win32":
        return run_alone(argv)
    from .guard import guarded

    return guarded(lambda: run(argv), argv)


def run_alone(argv: Sequence[str], temporary: str | None = None) -> int:
    """Run where no guard can be: in a Blender that others started, and on Windows.

    Parameters
    ----------
    argv : sequence of str
        See `run`.
    temporary : str or None
        A folder for temporary files, which goes when a signal ends the process.

    Returns
    -------
    int
        See `run`.
    """
    out, err = os.dup(1), os.dup(2)

    def end(number: int) -> NoReturn:
        remove_own()
        if temporary:
            shutil.rmtree(temporary, ignore_errors=True)
        endings.tell(endings.interrupted(argv), argv, out, err)
        os._exit(128 + number)

    endings.listen(end)
    if hasattr(signal, "SIGPIPE"):
        signal.signal(signal.SIGPIPE, signal.SIG_IGN)  # Python's own way, which Blender undoes
    tempfile.tempdir = temporary
    with contextlib.ExitStack() as stack:
        if temporary:
            # The next command then knows the folder as RSIBR's, and removes it if this process is killed
            with contextlib.suppress(OSError):
                stack.enter_context(held(Path(temporary)))
        return run(argv)


def run(argv: Sequence[str]) -> int:
    """Run one command.

    Parameters
    ----------
    argv : sequence of str
        The arguments after `rsibr`.

    Returns
    -------
    int
        0 done, 1 failed for good, 2 wrong usage, `endings.TRY_AGAIN` failed for now.
    """
    from .commands import parsed
    from .parser import UsageError

    with own_streams() as (out, told):
        try:
            arguments = parsed(argv)
        except SystemExit:  # argparse has printed the help
            return 0
        except UsageError as error:
            told.write(f"{error.usage}: error: {error}\n")
            if "--json" in argv:
                out.write(f"{endings.failed(str(error), try_again=False)}\n")
            return 2
        result, lines = _done(arguments, told)
        for line in [json.dumps(result)] if arguments.json else lines:
            out.write(f"{line}\n")
        if out.full:
            told.write(f"rsibr: warning: Standard output took no result ({out.error}): see its device.\n")
    if result["ok"]:
        return 0
    return endings.TRY_AGAIN if result["try_again"] else 1


def _done(arguments: argparse.Namespace, told: Outlet) -> tuple[dict[str, Any], list[str]]:
    """Run a command; its result for programs, and its lines for people."""
    from .console import Console

    console = Console(arguments.progress, told)
    with console.hearing_warnings():
        try:
            with others_hushed(told if arguments.verbose else None, arguments.log):
                result = {"ok": True, **arguments.run(arguments, console)}
        except (RsibrError, OSError, MemoryError, ModuleNotFoundError) as error:
            if isinstance(error, ModuleNotFoundError) and error.name not in BLENDERS_MODULES:
                raise
            sentence = sentence_of(error, arguments.command)
            result = {"ok": False, "error": sentence, "try_again": may_pass(error)}
            console.fail(sentence)
    return result | {"warnings": console.warnings}, console.lines if result["ok"] else []


def may_pass(error: Exception) -> bool:
    """Whether the same work may succeed another time, as its error tells of the machine alone."""
    if isinstance(error, OSError):
        return error.errno in MAY_PASS
    return isinstance(error, NotNowError | RenderError | MemoryShortageError | MemoryError)


def sentence_of(error: Exception, command: str) -> str:
    """What to tell of an error, naming the file where the system knows it."""
    if isinstance(error, ModuleNotFoundError):
        return (
            f"{command} needs Blender for this: pip install '.[blender]' in RSIBR's source on Python 3.13, "
            f"or run it as blender --command {command}."
        )
    if isinstance(error, MemoryError):
        return "The memory of this machine is used up: choose a smaller size, or close other programs."
    if isinstance(error, OSError) and error.filename is not None:
        return f"{error.filename} cannot be used ({error.strerror}): check what is there, or give another."
    return str(error)
