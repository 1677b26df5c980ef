"""Bakes in Blenders of their own, one after another, so that the artist's Blender never waits."""

import contextlib
import math
import os
import subprocess
import sys
import threading
import time
from collections import deque
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from enum import StrEnum
from pathlib import Path
from typing import Generic, NotRequired, TextIO, TypedDict, TypeVar

from ...core.errors import SchemaError
from ...core.progress import Progress
from ...core.schema import decode, loads

STARTING, START_SECONDS = 0.25, 2.0
"""Share of a bake that starting Blender is taken for, and after how long most of it is over."""

LAST_LINES = 20
"""How many lines of Blender's output are kept: they tell why it ended without a message of ours."""

GRACE_SECONDS = 1.0
"""Until a Blender that was asked to end is killed: more than it takes to do so by itself."""

NICENESS = 10
"""How much nicer a bake is than the artist's Blender, which comes first."""

LEAST_URGENT = 19
"""The highest niceness there is."""


MOST_ELSEWHERE = 4
"""Bakes that other machines do at once: each has a Blender here that waits for it."""


class State(StrEnum):
    """What has become of a bake."""

    WAITING = "waiting"
    RUNNING = "running"
    DONE = "done"
    FAILED = "failed"
    CANCELLED = "cancelled"


@dataclass(frozen=True)
class Farm:
    """A manager of Flamenco, which the artist has allowed to be asked.

    Attributes
    ----------
    url : str
        Its address.
    shared : str
        The shared folder, as it is called here; empty for the one that the manager says.
    """

    url: str
    shared: str = ""

    @property
    def words(self) -> list[str]:
        """The options of `rsibr submit` that say this."""
        return ["--flamenco", self.url, *(("--shared", self.shared) if self.shared else ()), "--wait"]


def blender_command(
    blender: str, extension: str, opened: tuple[Path, str] | None, job: Path, farm: Farm | None = None
) -> list[str]:
    """What starts a job in a background Blender.

    Parameters
    ----------
    blender : str
        The program.
    extension : str
        The package that Blender knows us by; it may not be enabled in the preferences that are saved.
    opened : (Path, str) or None
        The file that is opened first and its scene's name, where the job's world or material are its own.
    job : Path
        The job's JSON.
    farm : Farm or None
        Has other machines do the job.
    """
    words = ["bake", str(job)] if farm is None else ["submit", str(job), *farm.words]
    return [
        # First of all, as it forbids only what is opened after it
        *(blender, "--background", "--disable-autoexec"),
        *(() if opened is None else (str(opened[0]), "--scene", opened[1])),
        *(() if farm is None else ("--online-mode",)),
        *("--addons", extension, "--command", "rsibr"),
        *(*words, "--json", "--progress", "json"),
    ]


@dataclass(frozen=True)
class _Step:
    progress: Progress


class _Result(TypedDict):
    ok: bool
    error: NotRequired[str]
    warnings: NotRequired[list[str]]


@dataclass
class Bake:
    """One bake of the queue.

    Attributes
    ----------
    title : str
        What is made, for people.
    output : Path
        The map set that it writes.
    command : sequence of str
        Starts a process that speaks as `rsibr --json --progress json` does.
    variables : mapping of str to str
        Environment variables of the process, beside those of this one.
    state : State
    progress : Progress or None
        None before there is any.
    message : str
        Why a bake failed, in one sentence.
    warnings : list of str
    elsewhere : bool
        Whether other machines do it, so that it waits for no bake here, and outlives this queue.
    """

    title: str
    output: Path
    command: Sequence[str]
    variables: Mapping[str, str] = field(default_factory=dict)
    state: State = State.WAITING
    progress: Progress | None = None
    message: str = ""
    warnings: list[str] = field(default_factory=list)
    elsewhere: bool = False
    _process: subprocess.Popen[str] | None = field(default=None, repr=False)
    _readers: list[threading.Thread] = field(default_factory=list, repr=False)
    _said: deque[str] = field(default_factory=lambda: deque(maxlen=LAST_LINES), repr=False)
    _result: str = field(default="", repr=False)
    _first_step: tuple[float, int] | None = field(default=None, repr=False)
    _since: float = field(default=0.0, repr=False)

    @property
    def fraction(self) -> float:
        """How much is done, in [0, 1]; starting Blender is a part of it."""
        if self.progress is None:
            waited = time.monotonic() - self._since if self.state is State.RUNNING else 0.0
            return STARTING * (1.0 - math.exp(-waited / START_SECONDS))
        return STARTING + (1.0 - STARTING) * self.progress.done / max(self.progress.total, 1)

    @property
    def seconds_left(self) -> float | None:
        """Seconds left, by the steps so far; None before one is done."""
        if self.progress is None or self._first_step is None:
            return None
        since, first = self._first_step
        done = self.progress.done - first
        if done < 1:
            return None
        return (time.monotonic() - since) / done * (self.progress.total - self.progress.done)

    @property
    def ended(self) -> bool:
        """Whether nothing more will happen."""
        return self.state not in (State.WAITING, State.RUNNING)

    def start(self) -> None:
        """Start its process; a bake that cannot start has failed."""
        self._since = time.monotonic()
        try:
            self._process = subprocess.Popen(
                self.command,
                env={**os.environ, **self.variables},
                stdin=subprocess.DEVNULL,
                stdout=subprocess.PIPE,
                stderr=subprocess.PIPE,
                text=True,
                encoding="utf-8",
                errors="replace",
                # Ctrl-C in the artist's terminal is not meant for it.
                start_new_session=sys.platform != "win32",
                creationflags=getattr(subprocess, "BELOW_NORMAL_PRIORITY_CLASS", 0),
            )
        except OSError as error:
            self.state = State.FAILED
            self.message = f"{self.command[0]} cannot be started ({error.strerror}): reinstall Blender."
            return
        self.state = State.RUNNING
        if sys.platform != "win32":
            with contextlib.suppress(ProcessLookupError):
                niceness = os.getpriority(os.PRIO_PROCESS, self._process.pid) + NICENESS
                os.setpriority(os.PRIO_PROCESS, self._process.pid, min(niceness, LEAST_URGENT))
        self._readers = [
            threading.Thread(target=read, args=(stream,), daemon=True)
            for read, stream in (
                (self._read_progress, self._process.stderr),
                (self._read_result, self._process.stdout),
            )
        ]
        for reader in self._readers:
            reader.start()

    def update(self) -> None:
        """Notice that its process has ended."""
        if self.state is not State.RUNNING or self._process is None or self._process.poll() is None:
            return
        for reader in self._readers:
            reader.join()
        result = self._parsed_result()
        self.warnings = result.get("warnings", [])
        if result["ok"]:
            self.state = State.DONE
        else:
            self.state = State.FAILED
            self.message = result.get("error") or (
                f"The background Blender ended with code {self._process.returncode} and no result: "
                f"{self._said[-1] if self._said else 'it said nothing'}"
            )

    def cancel(self) -> None:
        """End its process. Finished views stay, and the same bake goes on from there."""
        if self._process is not None and self._process.poll() is None:
            self._process.terminate()
            try:
                self._process.wait(GRACE_SECONDS)
            except subprocess.TimeoutExpired:
                self._process.kill()
                self._process.wait()
        if not self.ended:
            self.state = State.CANCELLED

    def leave(self) -> None:
        """End its process alone, and not what that has asked other machines to do."""
        if self._process is not None:
            self._process.kill()
            self._process.wait()

    def _read_progress(self, stderr: TextIO) -> None:
        with stderr:
            for line in stderr:
                with contextlib.suppress(SchemaError):
                    self.progress = decode(_Step, loads(line)).progress
                    if self._first_step is None:
                        self._first_step = time.monotonic(), self.progress.done
                    continue
                self._said.append(line.strip())

    def _read_result(self, stdout: TextIO) -> None:
        with stdout:
            for line in stdout:
                # Blender itself writes after the result.
                if line.startswith("{"):
                    self._result = line

    def _parsed_result(self) -> "_Result":
        try:
            return decode(_Result, loads(self._result))
        except SchemaError:
            return {"ok": False}


B = TypeVar("B", bound=Bake)


class BakeQueue(Generic[B]):
    """Bakes in the order in which they were added, one at a time; those of other machines go on beside."""

    def __init__(self) -> None:
        self.bakes: list[B] = []

    def add(self, bake: B) -> None:
        """Start a bake, or let it wait for those before it."""
        self.bakes.append(bake)
        self.update()

    def update(self) -> list[B]:
        """Notice what has happened; a timer calls this.

        Returns
        -------
        list of Bake
            The bakes that have ended since.
        """
        running = [bake for bake in self.bakes if not bake.ended]
        for bake in running:
            bake.update()
        active = [bake for bake in self.bakes if not bake.ended]
        here = [bake for bake in active if not bake.elsewhere]
        elsewhere = [bake for bake in active if bake.elsewhere]
        for bake in here[:1] + elsewhere[:MOST_ELSEWHERE]:
            if bake.state is State.WAITING:
                bake.start()
        return [bake for bake in running if bake.ended]

    def unfinished(self, output: Path) -> B | None:
        """The bake that will write a file; None where none runs or waits."""
        return next((bake for bake in self.bakes if bake.output == output and not bake.ended), None)

    @property
    def busy(self) -> bool:
        """Whether a bake runs or waits."""
        return any(not bake.ended for bake in self.bakes)

    def forget_ended(self, which: Callable[[B], bool]) -> None:
        """Remove those ended bakes from the queue that a function is true of."""
        self.bakes = [bake for bake in self.bakes if not (bake.ended and which(bake))]

    def close(self) -> None:
        """Cancel all that is done here."""
        for bake in reversed(self.bakes):
            if bake.elsewhere:
                bake.leave()
            else:
                bake.cancel()
        self.bakes.clear()
