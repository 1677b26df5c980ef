"""A library that ends the process beneath Python, as OpenBLAS does without memory, is told of."""

import json
import subprocess
import sys

import pytest
from rsibr.rsibr_addon.command_line.endings import TRY_AGAIN

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="has no guard")

GUARDED = """
import ctypes, os
from rsibr.rsibr_addon.command_line.guard import guarded
raise SystemExit(guarded({work}, ["info", "--json"]))
"""


def ended(work: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, "-c", GUARDED.format(work=work)], capture_output=True, text=True, timeout=60
    )


@pytest.mark.parametrize("code", [0, 1])
def test_an_exit_of_a_library_is_told(code: int) -> None:
    found = ended(f"lambda: ctypes.CDLL(None).exit({code})")
    assert found.returncode == TRY_AGAIN
    assert found.stderr.startswith("rsibr: error: A library ended the process")
    assert len(found.stderr.splitlines()) == 1
    assert [json.loads(found.stdout)[name] for name in ("ok", "try_again")] == [False, True]


@pytest.mark.parametrize("code", [0, 1, 2])
def test_work_that_came_to_its_end_keeps_its_code(code: int) -> None:
    found = ended(f"lambda: {code}")
    assert (found.returncode, found.stdout, found.stderr) == (code, "", "")


def test_a_crash_is_told_without_naming_blender() -> None:
    found = ended("os.abort")
    assert found.returncode == TRY_AGAIN
    assert found.stderr.startswith("rsibr: error: The process crashed (SIGABRT)")
