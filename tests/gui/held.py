"""Hold captures at a known step, so that what a scenario does meanwhile does not race with them.

Copied to Blender's start-up scripts: every Blender of a test runs it, also one in the background. While
/job/hold is there, no captured view gets its name once as many have theirs as that file says.
"""

import math
import sys
import time
from pathlib import Path

HOLD = Path("/job/hold")


def wait(event: str, arguments: tuple[object, ...]) -> None:
    """Wait before a view gets its name, while a hold is on: files are written under other names first."""
    if event in ("os.rename", "os.link") and Path(str(arguments[1])).match("*.partial/view*.exr"):
        while finished_views() >= views_before_hold():
            time.sleep(0.02)


def finished_views() -> int:
    """Of captures that go on, or did when they were ended."""
    return sum(1 for _ in HOLD.parent.glob("**/*.partial/view*.exr"))


def views_before_hold() -> float:
    """What the file says; infinity without one."""
    try:
        return int(HOLD.read_text())
    except FileNotFoundError:
        return math.inf


def register() -> None:
    """What Blender calls; handlers of renders would not do, as captures have them rest."""
    sys.addaudithook(wait)
