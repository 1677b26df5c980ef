"""Standard streams that are closed, broken or full: the work is done and kept, and the code is the work's."""

import os
import pty
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from rsibr.rsibr_addon.files.radiance_pictures import write_radiance
from rsibr.tests.faults.processes import RSIBR

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="uses a POSIX shell")

WORK = "convert in.exr out.exr --from equirect --to octahedral --size 8 --progress json"


@pytest.fixture(autouse=True)
def _source(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    write_radiance(tmp_path / "in.exr", np.ones((8, 16, 3), np.float32))


def shell(command: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        ["bash", "-o", "pipefail", "-c", command], capture_output=True, text=True, check=False
    )


@pytest.mark.parametrize(
    "streams", [">&-", "2>&-", "<&- >&- 2>&-", "| head -c 0", "2>&1 | head -c 0", ">/dev/full", "2>/dev/full"]
)
@pytest.mark.parametrize("options", ["", "--json"])
def test_the_work_is_done(streams: str, options: str) -> None:
    ended = shell(f"{RSIBR} {WORK} {options} {streams}")
    assert ended.returncode == 0
    assert "Traceback" not in ended.stdout + ended.stderr
    assert Path("out.exr").stat().st_size > 0


@pytest.mark.parametrize(("command", "code"), [("info missing.exr", 1), ("info", 2), ("--help", 0)])
@pytest.mark.parametrize("streams", [">&- 2>&-", ">/dev/full 2>&1", "2>&1 | head -c 0"])
def test_failures_keep_their_code(command: str, code: int, streams: str) -> None:
    assert shell(f"{RSIBR} {command} {streams}").returncode == code


def test_control_characters_are_spelled_out_on_a_terminal_alone() -> None:
    name = "missing\x1b[31m\x9b.exr"
    ours, theirs = pty.openpty()
    process = subprocess.run([RSIBR, "info", name], stdout=theirs, stderr=theirs, check=False)
    os.close(theirs)
    told = os.read(ours, 4096)
    os.close(ours)
    assert process.returncode == 1
    assert rb"missing\x1b[31m\x9b.exr" in told
    assert b"\x1b" not in told
    assert name.encode() in subprocess.run([RSIBR, "info", name], capture_output=True, check=False).stderr
