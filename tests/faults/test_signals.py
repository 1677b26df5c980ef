"""Signals that ask a command to end, at moments all over its run: one sentence, and nothing is left."""

import os
import random
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import pytest
from rsibr.rsibr_addon.command_line.endings import SIGNALS
from rsibr.rsibr_addon.command_line.endings import interrupted as sentence_of
from rsibr.tests.faults.processes import Ended, Running, run
from rsibr.tests.mirror_capture import write_mirror_capture

pytestmark = [
    pytest.mark.skipif(sys.platform != "linux", reason="reads /proc"),
    pytest.mark.needs("gl", "bpy", "cycles"),
    pytest.mark.slow,
]

COMMANDS = {
    "mips": "mips --environment forest --filter box --size 32 -o out.rsibr.exr",
    "preview": "preview ../../in.rsibr.exr --size 64 -o out.png",
    "capture": "capture --environment forest --material gold --views 12 --size 8 --samples 2 -o out.exr",
    "report": "report ../../in.rsibr.exr -o out.html",
    "tables": "tables --environment forest --diffuse lambert:kd=0.5 -o out.rsibr.exr",
}
MOMENTS = int(os.environ.get("RSIBR_MOMENTS", len(COMMANDS)))

RENDER = (
    "capture --environment forest --material copper --views 12 --size 999 --samples 4096 -o out.rsibr.exr"
)
"""Whose first view takes minutes."""


@pytest.fixture(scope="module", autouse=True)
def _not_ignored() -> Iterator[None]:
    """Whoever started the tests in the background may have had them ignore signals, and so their children."""
    ignored = [number for number in SIGNALS if signal.getsignal(number) is signal.SIG_IGN]
    for number in ignored:
        signal.signal(number, signal.SIG_DFL)
    yield
    for number in ignored:
        signal.signal(number, signal.SIG_IGN)


@pytest.fixture(scope="module")
def source(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with `in.rsibr.exr`, which commands read."""
    folder = tmp_path_factory.mktemp("source")
    write_mirror_capture(folder / "in.rsibr.exr")
    return folder


@pytest.fixture(scope="module")
def seconds(source: Path) -> dict[str, float]:
    """How long each command takes."""
    taken = {}
    for name, command in COMMANDS.items():
        begin = time.monotonic()
        ended = run(source / name, *command.split())
        assert (ended.code, ended.temporary) == (0, []), ended.err
        taken[name] = time.monotonic() - begin
    return taken


def wait_until_ours(running: Running) -> None:
    """Wait for the guard to have begun its work in a process of its own: until then a signal is Python's."""
    while running.process.poll() is None and len(running.family()) < 2:
        time.sleep(0.001)


def interrupted(folder: Path, command: str, number: int, after: float) -> Ended:
    running = Running(folder, *command.split())
    wait_until_ours(running)
    time.sleep(after)
    running.process.send_signal(number)
    ended = running.end()
    assert running.family() == set()
    return ended


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
def test_at_any_moment(number: int, source: Path, seconds: dict[str, float]) -> None:
    chance = random.Random(int(number))
    names, heard = list(COMMANDS), 0
    for moment in range(MOMENTS):
        name = names[moment % len(names)]
        after = chance.random() * seconds[name]
        ended = interrupted(source / f"{number}-{moment}", COMMANDS[name], number, after)
        where = f"{name} after {after:.3f} s: {ended}"
        assert ended.temporary == [], where
        if ended.code == 0:
            assert len(ended.left) == 1, where
            continue
        heard += 1
        assert ended.code == 128 + number, where
        *warnings, last = ended.err.splitlines()
        assert last == f"rsibr: error: {sentence_of(COMMANDS[name].split())}", where
        assert all(line.startswith("rsibr: warning: ") for line in warnings), where
        assert ended.out == "", where
        # A capture's finished views are kept for the next time
        assert ended.left <= ({"out.exr.partial"} if name == "capture" else set()), where
    # Of some a command is done first
    assert heard > MOMENTS / 4


def test_amid_a_render(source: Path) -> None:
    running = Running(source / "render", *RENDER.split(), "--progress", "json", "--json")
    for line in running.process.stderr or ():
        if "view 1" in line:
            break
    time.sleep(0.5)
    running.process.terminate()
    ended = running.end()
    assert ended.code == 128 + signal.SIGTERM
    assert ended.err.splitlines()[-1] == f"rsibr: error: {sentence_of(RENDER.split())}"
    assert '"ok": false' in ended.out
    assert ended.temporary == []
    assert running.family() == set()


def test_an_ignored_signal_stays_ignored(source: Path) -> None:
    command = COMMANDS["mips"].split()
    before = signal.signal(signal.SIGHUP, signal.SIG_IGN)  # as nohup does
    try:
        running = Running(source / "ignored", *command)
    finally:
        signal.signal(signal.SIGHUP, before)
    wait_until_ours(running)
    running.process.send_signal(signal.SIGHUP)
    assert running.end().code == 0


def test_the_work_ends_with_its_guard(source: Path) -> None:
    running = Running(source / "killed", *RENDER.split())
    wait_until_ours(running)
    time.sleep(1.0)
    running.process.kill()
    running.end()
    deadline = time.monotonic() + 30.0
    while running.family():
        assert time.monotonic() < deadline
        time.sleep(0.01)


@pytest.mark.parametrize("output", [["-o", "a.exr"], ["--output=a.exr"]])
def test_a_killed_command_leaves_no_staging_folder(output: list[str], tmp_path: Path) -> None:
    script = (
        "import os, signal, sys\n"
        "from pathlib import Path\n"
        "from rsibr.rsibr_addon.command_line.guard import guarded\n"
        "from rsibr.rsibr_addon.files.staging import staging_folder\n"
        "def work():\n"
        "    with staging_folder(Path()) as folder:\n"
        "        print(folder.name, flush=True)\n"
        "        os.kill(os.getpid(), signal.SIGKILL)\n"
        "sys.exit(guarded(work, sys.argv[1:]))\n"
    )
    command = [sys.executable, "-c", script, "bake", *output]
    killed = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False)
    assert killed.returncode == 75
    assert killed.stdout.startswith(".rsibr-")
    assert list(tmp_path.iterdir()) == []


def test_a_command_that_is_ended_amid_a_step_leaves_no_empty_work_folder(tmp_path: Path) -> None:
    script = (
        "import os, signal, sys, time\n"
        "from pathlib import Path\n"
        "from rsibr.rsibr_addon.command_line.endings import orderly\n"
        "from rsibr.rsibr_addon.command_line.guard import guarded\n"
        "from rsibr.rsibr_addon.files.work_folder import held_work_folder\n"
        "def work():\n"
        "    with orderly(), held_work_folder(Path('a.exr.partial')):\n"
        "        os.kill(os.getpid(), signal.SIGTERM)\n"
        "        time.sleep(60)\n"
        "sys.exit(guarded(work, sys.argv[1:]))\n"
    )
    command = [sys.executable, "-c", script, "bake", "-o", "a.exr"]
    ended = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False)
    assert ended.returncode == 128 + signal.SIGTERM, ended.stderr
    assert list(tmp_path.iterdir()) == []
