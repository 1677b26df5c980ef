"""Long-lived processes that do the bakes of a batch."""

import json
import os
import queue
import subprocess
import sys
import threading
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from dataclasses import asdict, dataclass, field
from typing import IO, Any

from ...core.errors import SchemaError
from ...core.schema import loads
from ...core.threads import VARIABLE
from .bakes import BatchBake

LOOK_SECONDS = 0.2
"""Longest time between two steps: so soon is an interruption noticed."""

GRACE_SECONDS = 5.0
"""For a process to end after its input has, before it is killed: it needs a moment."""


@dataclass
class Worker:
    """A process, and what it does.

    Attributes
    ----------
    process : subprocess.Popen
        See `command_line.worker`.
    bake : BatchBake or None
        What it works on.
    environment : str or None
        The one that it has read last.
    """

    process: subprocess.Popen[str]
    bake: BatchBake | None = None
    environment: str | None = None

    def give(self, bake: BatchBake, picture: bool) -> None:
        """Let it do a bake, and read and make a picture of what is there already, if that is wanted."""
        self.bake, self.environment = bake, bake.job.light.environment
        opened = asdict(bake.opened) if bake.opened else None
        asked = {"job": json.loads(bake.job.to_json()), "opened": opened, "picture": picture}
        assert self.process.stdin is not None
        with suppress(BrokenPipeError):  # the end of its output will be heard
            self.process.stdin.write(json.dumps(asked) + "\n")
            self.process.stdin.flush()


@dataclass
class Workers:
    """Some workers, and what they say.

    Attributes
    ----------
    command : sequence of str
        Starts one.
    threads : int
        That each may use.
    """

    command: Sequence[str]
    threads: int
    _said: "queue.SimpleQueue[tuple[Worker, dict[str, Any] | None]]" = field(
        default_factory=queue.SimpleQueue
    )
    _all: list[Worker] = field(default_factory=list)

    def start(self) -> Worker:
        """Start one more.

        Raises
        ------
        OSError
            The system starts none.
        """
        process = subprocess.Popen(
            self.command,
            env={**os.environ, VARIABLE: str(self.threads), "OPENBLAS_NUM_THREADS": str(self.threads)},
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            text=True,
            encoding="utf-8",
            errors="replace",
            start_new_session=sys.platform != "win32",  # Ctrl-C is for the batch, which ends them
        )
        worker = Worker(process)
        self._all.append(worker)
        assert process.stdout is not None
        threading.Thread(target=self._listen, args=(worker, process.stdout), daemon=True).start()
        return worker

    def heard(self) -> Iterator[tuple[Worker, dict[str, Any] | None]]:
        """The next that a worker says, None of one that has ended; nothing after `LOOK_SECONDS`."""
        with suppress(queue.Empty):
            yield self._said.get(timeout=LOOK_SECONDS)

    def close(self) -> None:
        """End all. What they have begun leaves nothing but finished views."""
        for worker in self._all:
            assert worker.process.stdin is not None
            with suppress(BrokenPipeError):
                worker.process.stdin.close()
        for worker in self._all:
            try:
                worker.process.wait(GRACE_SECONDS)
            except subprocess.TimeoutExpired:
                worker.process.kill()
                worker.process.wait()

    def _listen(self, worker: Worker, stdout: IO[str]) -> None:
        with stdout:
            for line in stdout:
                # Blender itself writes other lines
                with suppress(SchemaError):
                    said = loads(line)
                    if isinstance(said, dict):
                        self._said.put((worker, said))
        self._said.put((worker, None))


@contextmanager
def started_workers(command: Sequence[str], threads: int) -> Iterator[Workers]:
    """Workers that end with the body."""
    workers = Workers(command, threads)
    try:
        yield workers
    finally:
        workers.close()
