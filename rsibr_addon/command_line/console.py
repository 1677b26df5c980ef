"""What a command tells while it works and at its end; standard output belongs to the result alone."""

import json
import time
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any, TypeVar

from ..core.errors import RsibrWarning
from ..core.progress import Progress, Steps
from .endings import done, orderly
from .streams import CLEAR_LINE, Outlet

Result = TypeVar("Result")

BAR_WIDTH = 24

QUIET_SECONDS = 1.0
"""Shortest time between two lines for a farm, which keeps them all; an end is told at once."""

BEAT_SECONDS = 60.0
"""Longest time between two lines for a farm, which takes what is silent for minutes for dead."""


class Console:
    """Shows progress and warnings on standard error, and collects what the result will say.

    Parameters
    ----------
    progress : {"auto", "bar", "json", "lines", "openjd", "none"}
        A bar; one JSON object a line; a line of text for each step, and at least one in `BEAT_SECONDS`, or
        the same as OpenJD has it; or nothing. "auto" is a bar on a terminal and else nothing.
    told : Outlet
        Standard error.

    Attributes
    ----------
    lines : list of str
        The result for people.
    warnings : list of str
        Each warning once.
    """

    def __init__(self, progress: str, told: Outlet) -> None:
        self.told = told
        self.progress = progress
        if progress == "auto":
            self.progress = "bar" if told.isatty() else "none"
        self.lines: list[str] = []
        self.warnings: list[str] = []
        self._beat = (-BEAT_SECONDS, Progress(-1, 0, ""))

    def say(self, line: str) -> None:
        """Add a line to the result for people."""
        self.lines.append(line)

    def tell(self, sentence: str) -> None:
        """Show what is good to know before long work to whoever watches its bar."""
        if self.progress == "bar":
            self.told.write(f"rsibr: {sentence}\n")

    def fail(self, sentence: str) -> None:
        """Show why a command failed."""
        self.told.write(f"rsibr: error: {sentence}\n")
        if self.progress == "openjd":
            self.told.write(f"openjd_fail: {sentence}\n")

    def steps(self, steps: Steps[Result]) -> Result:
        """Run long work to its end, showing where it is, and return its result.

        However it ends, the work's own cleaning up is done before this returns or raises. A signal that asks
        the process to end does so after the step at hand, or soon.
        """
        with orderly() as asked:
            try:
                while not asked.is_set():
                    self._show(next(steps))
            except StopIteration as end:
                done()
                result: Result = end.value
            finally:
                steps.close()
                self._clear()
        return result

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
            self.told.write(f"rsibr: warning: {sentence}\n")

    def _show(self, progress: Progress) -> None:
        if self.progress == "bar":
            filled = BAR_WIDTH * progress.done // max(progress.total, 1)
            bar = "#" * filled + "." * (BAR_WIDTH - filled)
            line = f"[{bar}] {progress.done}/{progress.total} {progress.what}"
            # Back to the line's begin, so that the next output overwrites the bar
            self.told.control(CLEAR_LINE)
            self.told.write(line[: self.told.columns - 1])
            self.told.control("\r")
        elif self.progress == "json":
            self.told.write(json.dumps({"progress": vars(progress)}) + "\n")
        elif self.progress in ("lines", "openjd"):
            self._tell_farm(progress)

    def _tell_farm(self, progress: Progress) -> None:
        """Write what is new, or the same after a while."""
        since, last = self._beat
        now, total = time.monotonic(), max(progress.total, 1)
        wait = QUIET_SECONDS if progress != last else BEAT_SECONDS
        is_end = progress.done >= total and progress != last
        if now - since < wait and not is_end:
            return
        self._beat = (now, progress)
        what = progress.what or "done"
        line = f"{progress.done} of {total}: {what}\n"
        if self.progress == "openjd":
            line = f"openjd_progress: {100.0 * progress.done / total:.1f}\nopenjd_status: {what}\n"
        self.told.write(line)

    def _clear(self) -> None:
        if self.progress == "bar":
            self.told.control(CLEAR_LINE)
