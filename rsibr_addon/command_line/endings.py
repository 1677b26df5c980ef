"""Ctrl-C and the other signals that ask a process to end: soon, in order, and told in one sentence.

Python runs a signal's handler in the main thread, which may be deep in a render. So the handlers do nothing,
and a thread hears of the signal. Work in steps may clean up after the step at hand, if that ends soon; then,
and at once where no steps run, the thread ends the process.
"""

import contextlib
import json
import signal
import socket
import threading
from collections.abc import Callable, Iterator, Sequence
from typing import NoReturn

SIGNALS = frozenset(
    getattr(signal, name) for name in ("SIGINT", "SIGTERM", "SIGHUP") if hasattr(signal, name)
)
"""What asks a process to end, where the system has it."""

GRACE_SECONDS = 0.4
"""How long the step at hand may take to end."""

AGAIN = "Interrupted: give the same command again."
GOES_ON = "Interrupted: give the same command again, and it goes on from the views that are finished."
BATCH_GOES_ON = "Interrupted: give the same command again, and it goes on with the bakes that are not done."
MAY_GO_ON = "Interrupted: give the same command again; a capture goes on from the views that are finished."

TRY_AGAIN = 75
"""Exit code of what failed and may succeed another time, BSD's EX_TEMPFAIL; 1 is wrong for good."""

_asked = threading.Event()
_done = threading.Event()
_working = threading.Lock()


def heeded() -> set[signal.Signals]:
    """The signals that end this process: it may have been started with some ignored (by nohup, or with &)."""
    return {number for number in SIGNALS if signal.getsignal(number) is not signal.SIG_IGN}


def listen(end: Callable[[int], NoReturn]) -> None:
    """Have the process ended when a signal asks for it.

    Parameters
    ----------
    end : callable
        Takes the signal's number, does what is to be done before, and exits.
    """
    hearing, waking = socket.socketpair()  # Windows can wake nothing else
    waking.setblocking(False)
    for number in heeded():
        signal.signal(number, lambda number, frame: None)
    signal.set_wakeup_fd(waking.detach(), warn_on_full_buffer=False)

    def hear() -> None:
        while (number := hearing.recv(1)[0]) not in SIGNALS:
            pass
        _asked.set()
        _working.acquire(timeout=GRACE_SECONDS)
        if not _done.is_set():
            end(number)

    threading.Thread(target=hear, daemon=True).start()


@contextlib.contextmanager
def orderly() -> Iterator[threading.Event]:
    """Within, the process is given a moment before it is ended.

    Yields
    ------
    threading.Event
        It has been asked to end: the body should clean up and be done.
    """
    with _working:
        yield _asked
    if _asked.is_set() and not _done.is_set():
        threading.Event().wait()  # for the end, which the thread that heard is about to bring


def interrupted(argv: Sequence[str]) -> str:
    """Tell of an interruption what its command does when it is given again.

    Parameters
    ----------
    argv : sequence of str
        The command's arguments.
    """
    command, first = (*argv[:2], "", "")[:2]
    if command == "capture" or (command, first) == ("bake", "radiance-views"):
        return GOES_ON
    if command == "batch":
        return BATCH_GOES_ON
    is_job = command == "job" or (command == "bake" and first.endswith(".json"))
    return MAY_GO_ON if is_job else AGAIN


def done() -> None:
    """Say that the work is done: a signal comes too late then, and the result will be told."""
    _done.set()


def failed(sentence: str, try_again: bool) -> str:
    """The result of a command that has not begun, or cannot tell its own, as JSON."""
    return json.dumps({"ok": False, "error": sentence, "try_again": try_again, "warnings": []})


def tell(sentence: str, argv: Sequence[str], out: int, err: int) -> None:
    """Tell why a command ends that cannot tell it itself.

    Parameters
    ----------
    sentence : str
    argv : sequence of str
        The command's arguments: with ``--json`` its result is due on standard output.
    out, err : int
        File descriptors of standard output and error.
    """
    from .streams import CLEAR_LINE, Outlet

    told = Outlet(err)
    if told.isatty():
        told.control(CLEAR_LINE)  # a bar may stand there
    told.write(f"rsibr: error: {sentence}\n")
    if "--json" in argv:
        Outlet(out).write(f"{failed(sentence, try_again=True)}\n")
