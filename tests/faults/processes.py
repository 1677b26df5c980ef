"""Commands as processes of their own, each with a folder to work in and one for its temporary files."""

import os
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import IO

RSIBR = Path(sys.executable).with_name("rsibr")
PATIENCE_SECONDS = 120.0
"""For a process that should have ended long before."""


@dataclass(frozen=True)
class Ended:
    """What a process that has ended leaves behind.

    Attributes
    ----------
    code : int
        As Popen has it.
    out, err : str
    left : set of str
        What is in the working folder.
    temporary : list of str
        What is in the temporary folder.
    """

    code: int
    out: str
    err: str
    left: set[str]
    temporary: list[str]


class Running:
    """A command at work.

    Parameters
    ----------
    folder : Path
        Holds `work` and `temporary` afterwards.
    *argv : str
        The command's arguments.
    variables : dict of str to str
        Of its environment, beside our own.
    addresses : int, optional
        Bytes that it may have.
    """

    def __init__(
        self,
        folder: Path,
        *argv: str,
        variables: dict[str, str] | None = None,
        stdout: int | IO[bytes] = subprocess.PIPE,
        stderr: int | IO[bytes] = subprocess.PIPE,
        addresses: int | None = None,
    ) -> None:
        self.work, self.temporary = folder / "work", folder / "temporary"
        for path in (self.work, self.temporary):
            path.mkdir(parents=True, exist_ok=True)
        self.process = subprocess.Popen(
            [*(() if addresses is None else ("prlimit", f"--as={addresses}")), RSIBR, *argv],
            cwd=self.work,
            env={**os.environ, "TMPDIR": str(self.temporary), **(variables or {})},
            stdout=stdout,
            stderr=stderr,
            text=True,
            start_new_session=True,
        )

    def end(self) -> Ended:
        """Wait for it."""
        out, err = self.process.communicate(timeout=PATIENCE_SECONDS)
        return Ended(
            self.process.returncode,
            out or "",
            err or "",
            {path.name for path in self.work.iterdir()},
            sorted(path.name for path in self.temporary.iterdir()),
        )

    def family(self) -> set[int]:
        """Processes of its session; empty once it has ended as it should."""
        return {
            int(path.name)
            for path in Path("/proc").iterdir()
            if path.name.isdecimal() and _session(path) == self.process.pid
        }


def run(folder: Path, *argv: str, **options: dict[str, str] | int | IO[bytes] | None) -> Ended:
    """Run a command to its end; see `Running`."""
    return Running(folder, *argv, **options).end()  # type: ignore[arg-type]


def _session(process: Path) -> int:
    try:
        return int((process / "stat").read_text().rpartition(")")[2].split()[3])
    except OSError:  # it has just ended
        return 0
