"""A wheel's library that calls its own functions, where the program has others of the same names."""

import base64
import csv
import hashlib
import os
import platform
import runpy
import shutil
import subprocess
import sys
import zipfile
from pathlib import Path

import OpenEXR
import pytest
from rsibr.tests.pages import ROOT

pytestmark = pytest.mark.skipif(
    sys.platform != "linux" or not platform.libc_ver()[0], reason="glibc alone tells what it binds"
)

LIBRARY = Path(OpenEXR.__file__)
RECORD = "openexr-1.dist-info/RECORD"
BIND = runpy.run_path(str(ROOT / ".ci" / "own_symbols.py"))["bind_wheel_to_itself"]


@pytest.fixture
def wheel(tmp_path: Path) -> Path:
    """A wheel of the OpenEXR package's library and a text, whose list knows no hashes."""
    path = tmp_path / "openexr.whl"
    with zipfile.ZipFile(path, "w") as written:
        written.write(LIBRARY, LIBRARY.name)
        written.writestr("notes.txt", "as they were")
        written.writestr(RECORD, f"{LIBRARY.name},sha256=old,1\nnotes.txt,,\n{RECORD},,\n")
    return path


def bound_to(wheel: Path, folder: Path) -> set[str]:
    """Names of the libraries whose functions a wheel's library calls, where another one has them too."""
    with zipfile.ZipFile(wheel) as read:
        read.extractall(folder)
    other = shutil.copy(LIBRARY, folder / "other.so")
    loaded = subprocess.run(
        [sys.executable, "-c", "import OpenEXR; print(OpenEXR.__file__)"],
        env=os.environ
        | {"PYTHONPATH": str(folder), "LD_PRELOAD": str(other), "LD_DEBUG": "bindings", "LD_BIND_NOW": "1"},
        capture_output=True,
        text=True,
        check=True,
    )
    assert loaded.stdout.strip() == str(folder / LIBRARY.name)
    lines = [line.split() for line in loaded.stderr.splitlines() if "symbol `exr_" in line]
    # 7: binding file /a.so [0] to /b.so [0]: normal symbol `exr_read_scanline_chunk_info'
    return {Path(line[6]).name for line in lines if line[3] == loaded.stdout.strip()}


def test_a_library_calls_its_own_functions(wheel: Path, tmp_path: Path) -> None:
    assert bound_to(wheel, tmp_path / "before") == {"other.so"}
    BIND(wheel)
    assert bound_to(wheel, tmp_path / "after") == {LIBRARY.name}


def test_the_wheels_list_has_the_hash_of_what_was_changed(wheel: Path) -> None:
    BIND(wheel)
    with zipfile.ZipFile(wheel) as read:
        changed, notes = read.read(LIBRARY.name), read.read("notes.txt")
        rows = list(csv.reader(read.read(RECORD).decode().splitlines()))
    digest = base64.urlsafe_b64encode(hashlib.sha256(changed).digest()).decode().rstrip("=")
    assert rows == [
        [LIBRARY.name, f"sha256={digest}", str(len(changed))],
        ["notes.txt", "", ""],
        [RECORD, "", ""],
    ]
    assert notes == b"as they were"


def test_a_wheel_that_was_changed_stays_as_it_is(wheel: Path) -> None:
    BIND(wheel)
    once = wheel.stat()
    BIND(wheel)
    assert (wheel.stat().st_ino, wheel.stat().st_mtime_ns) == (once.st_ino, once.st_mtime_ns)
