"""A command in a process of its own, under the eyes of another that stays light.

Whatever holds the working process (Blender that starts, a shader that is compiled, a crash), the guard ends
it in time, removes its temporary files and tells what happened.
"""

import contextlib
import ctypes
import gc
import math
import os
import signal
import sys
import tempfile
from collections.abc import Callable, Iterator, Sequence
from itertools import pairwise
from pathlib import Path
from typing import NoReturn

from ..files.memory import address_limit, keep_freed_memory
from ..files.staging import clear_strays, remove_own, staging_folder
from . import endings

PATIENCE_SECONDS = 0.6
"""How long a process that was asked to end may take before it is killed; it needs a little less."""

PR_SET_PDEATHSIG = 1
"""Command of Linux's prctl: send this process a signal when its parent ends."""


def guarded(work: Callable[[], int], argv: Sequence[str]) -> int:
    """Do work in a child process, and see to its end.

    Call it before any heavy import and before any thread starts.

    Parameters
    ----------
    work : callable
        Returns an exit code.
    argv : sequence of str
        The command's arguments.

    Returns
    -------
    int
        The exit code: the work's, 128 and the number of the signal that ended it, or `endings.TRY_AGAIN`
        after a crash.
    """
    asking = endings.heeded()
    signal.signal(signal.SIGCHLD, lambda number, frame: None)  # of an ignored one there would be no word
    before = signal.pthread_sigmask(signal.SIG_BLOCK, asking | {signal.SIGCHLD, signal.SIGALRM})
    reader, writer = os.pipe()
    with _temporary_folder():
        gc.freeze()  # else the child's first collection would write to, and so copy, all that both share
        child = os.fork()
        if not child:
            signal.pthread_sigmask(signal.SIG_SETMASK, before)
            _work(work, writer)
        code = _watch(child, asking)
    os.close(writer)
    number = -code if code < 0 else code - 128
    if code < 0 or number in endings.SIGNALS:
        for folder in _output_folders(argv):
            clear_strays(folder)
    if number in endings.SIGNALS:
        endings.tell(endings.interrupted(argv), argv, 1, 2)
        return 128 + number
    if code < 0:
        endings.tell(_crash(number), argv, 1, 2)
        return endings.TRY_AGAIN
    if not _came_to_its_end(reader):
        endings.tell(f"A library ended the process{_remedy()}", argv, 1, 2)
        return endings.TRY_AGAIN
    return code


@contextlib.contextmanager
def _temporary_folder() -> Iterator[None]:
    """Have all temporary files, Blender's too, in a folder that goes with the guard, or with the next one."""
    with contextlib.ExitStack() as stack:
        # Without a folder, whatever needs a temporary file will say so
        with contextlib.suppress(OSError):
            folder = stack.enter_context(staging_folder(Path(tempfile.gettempdir())))
            os.environ["TMPDIR"] = tempfile.tempdir = str(folder)
        yield


def _work(work: Callable[[], int], writer: int) -> NoReturn:
    """Do the work, tell that it came to its end, and exit.

    Blender's own exit takes time and does nothing needed.
    """
    if sys.platform == "linux":
        ctypes.CDLL(None).prctl(PR_SET_PDEATHSIG, signal.SIGKILL)
    endings.listen(_end)
    keep_freed_memory()
    try:
        code = work()
    except BaseException:
        sys.excepthook(*sys.exc_info())
        code = 1
    os.write(writer, b".")
    os._exit(code)


def _came_to_its_end(reader: int) -> bool:
    """Whether the work did: OpenBLAS, for one, calls C's exit where it gets no memory."""
    os.set_blocking(reader, False)  # what Blender started may hold the other end
    with contextlib.suppress(BlockingIOError):
        return os.read(reader, 1) != b""
    return False


def _end(number: int) -> NoReturn:
    remove_own()
    os._exit(128 + number)


def _watch(child: int, asking: set[signal.Signals]) -> int:
    """Pass signals on to a child, and kill it if it does not end by them; its exit code, as Popen has it."""
    asked = 0
    while True:
        number = signal.sigwait(asking | {signal.SIGCHLD, signal.SIGALRM})
        if number == signal.SIGCHLD:
            ended, status = os.waitpid(child, os.WNOHANG)
            if ended:
                code = os.waitstatus_to_exitcode(status)
                return -asked if asked and code < 0 else code
        elif number == signal.SIGALRM:
            os.kill(child, signal.SIGKILL)
        else:
            asked = asked or number
            os.kill(child, number)
            signal.setitimer(signal.ITIMER_REAL, PATIENCE_SECONDS)


def _output_folders(argv: Sequence[str]) -> list[Path]:
    """Where a command that was ended may have left what it was about to write."""
    apart = [text for word, text in pairwise(argv) if word in ("-o", "--output")]
    joined = [word.removeprefix("--output=") for word in argv if word.startswith("--output=")]
    return [Path(text).parent for text in (*apart, *joined)]


def _crash(number: int) -> str:
    name = signal.Signals(number).name
    if number == signal.SIGKILL:
        return f"The system ended the process ({name}), as it does when memory is short: ask for less."
    return f"The process crashed ({name}){_remedy()}"


def _remedy() -> str:
    """How the sentence on an end that none of ours made goes on."""
    heard = "--verbose shows what was said."
    limit = address_limit()
    if limit == math.inf:
        return f": {heard}"
    return (
        ", as happens where addresses are short: raise their limit of "
        f"{limit / 1e9:.1f} GB (ulimit -v); {heard}"
    )
