"""What a command tells while it works and at its end; standard output belongs to the result alone."""

import ctypes
import json
import os
import shutil
import signal
import sys
import threading
import warnings
from collections.abc import Iterator
from contextlib import contextmanager, redirect_stdout
from typing import Any, TextIO

from ..core.errors import RsibrWarning
from ..core.progress import Progress, Steps

BAR_WIDTH = 24
CLEAR_LINE = "\r\x1b[2K"


class Report:
    """Shows progress and warnings on standard error, and collects what the result will say.

    Parameters
    ----------
    progress : {"auto", "bar", "json", "none"}
        A bar, one JSON object a line, or nothing; "auto" is a bar on a terminal and else nothing.

    Attributes
    ----------
    lines : list of str
        The result for people.
    warnings : list of str
        Each warning once.
    """

    def __init__(self, progress: str) -> None:
        self.progress = progress
        if progress == "auto":
            self.progress = "bar" if sys.stderr.isatty() else "none"
        self.lines: list[str] = []
        self.warnings: list[str] = []

    def say(self, line: str) -> None:
        """Add a line to the result for people."""
        self.lines.append(line)

    def steps[Result](self, steps: Steps[Result]) -> Result:
        """Run long work to its end, showing where it is, and return its result.

        Ctrl-C ends it after the step at hand. However it ends, the work's own cleaning up is done
        before this returns or raises.

        Raises
        ------
        KeyboardInterrupt
            Ctrl-C came, and there was more to do.
        """
        try:
            with _noting_interrupts() as interrupted:
                while True:
                    self._show(next(steps))
                    if interrupted.is_set():
                        raise KeyboardInterrupt
        except StopIteration as end:
            result: Result = end.value
            return result
        finally:
            steps.close()
            self._clear()

    @contextmanager
    def hearing_warnings(self) -> Iterator[None]:
        """Within, each `RsibrWarning` is shown and kept; other warnings go where they went."""
        with warnings.catch_warnings():
            warnings.simplefilter("always", RsibrWarning)
            show_other = warnings.showwarning

            def show(message: Warning | str, category: type[Warning], *details: Any, **more: Any) -> None:
                if issubclass(category, RsibrWarning):
                    self._warn(str(message))
                else:
                    show_other(message, category, *details, **more)

            warnings.showwarning = show
            yield

    def _warn(self, sentence: str) -> None:
        if sentence not in self.warnings:
            self.warnings.append(sentence)
            self._clear()
            print(f"rsibr: warning: {sentence}", file=sys.stderr, flush=True)

    def _show(self, progress: Progress) -> None:
        if self.progress == "bar":
            filled = BAR_WIDTH * progress.done // max(progress.total, 1)
            bar = "#" * filled + "." * (BAR_WIDTH - filled)
            line = f"[{bar}] {progress.done}/{progress.total} {progress.what}"
            columns = shutil.get_terminal_size().columns
            # Back at the line's begin, so that what Blender logs meanwhile writes over the bar
            print(CLEAR_LINE + line[: columns - 1], end="\r", file=sys.stderr, flush=True)
        elif self.progress == "json":
            print(json.dumps({"progress": vars(progress)}), file=sys.stderr, flush=True)

    def _clear(self) -> None:
        if self.progress == "bar":
            print(CLEAR_LINE, end="", file=sys.stderr, flush=True)


@contextmanager
def _noting_interrupts() -> Iterator[threading.Event]:
    """Within, Ctrl-C only sets the event: raised amid a render, Blender would swallow it and go on."""
    interrupted = threading.Event()
    before = signal.getsignal(signal.SIGINT)
    if before is signal.SIG_IGN:  # as of a job in the background, which Ctrl-C is not meant for
        yield interrupted
        return
    signal.signal(signal.SIGINT, lambda number, frame: interrupted.set())
    try:
        yield interrupted
    finally:
        # None stands for a handler of Blender's own, which Python cannot put back
        signal.signal(signal.SIGINT, signal.SIG_DFL if before is None else before)


@contextmanager
def result_stream() -> Iterator[TextIO]:
    """Standard output for the result alone; within, what others write to it goes to standard error.

    Blender and its libraries write beneath Python, to C's stream or to the file descriptor.
    """
    sys.stdout.flush()
    kept = os.dup(1)
    os.dup2(2, 1)
    try:
        with redirect_stdout(sys.stderr), os.fdopen(kept, "w", encoding="utf-8", closefd=False) as stream:
            yield stream
    finally:
        ctypes.CDLL("ucrtbase" if sys.platform == "win32" else None).fflush(None)
        os.dup2(kept, 1)
        os.close(kept)
