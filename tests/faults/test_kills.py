"""Kills that nothing hears (-9), at moments all over each command: no output is ever half there.

A few moments with the other tests; RSIBR_MOMENTS asks for more, over the slow commands too.
"""

import contextlib
import json
import os
import random
import shutil
import signal
import subprocess
import sys
import time
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
import pytest
from rsibr.rsibr_addon.files.radiance_pictures import write_radiance
from rsibr.rsibr_addon.job import CommandJob

pytestmark = [
    pytest.mark.skipif(sys.platform != "linux", reason="has process groups and PDEATHSIG"),
    pytest.mark.needs("gl", "bpy", "cycles"),
    pytest.mark.slow,
]

QUICK = {
    "convert": "convert {in}/env.exr out.exr --from equirect --to cube_faces --size 32",
    "mips": "mips --environment {in}/env.exr --filter box --size 32 -o out.rsibr.exr",
    "tables": "tables --environment {in}/env.exr --diffuse lambert:kd=0.5 -o out.rsibr.exr",
    "bake": "bake --environment {in}/env.exr --brdf phong:ks=0.5,n=8 --lobes 1 --slices 6 -o out.rsibr.exr",
    "bank": "bank --environment {in}/env.exr --size 32 -o out.rsibr.exr",
    "pyramid": "bake kernel-pyramid --environment {in}/env.exr --size 32 -o out.rsibr.exr",
    "fit": "fit --brdf phong:ks=0.5,n=8 --lobes 2 --slices 4 --plot plots -o out.json",
    "export": "export {in}/bake.rsibr.exr -o out.ktx2",
    "engine": "export {in}/env.exr --for filament --size 32 -o out.ktx",
    "illuminate": "illuminate faces {in}/convert.exr --size 32 -o out.exr",
    "report": "report {in}/bake.rsibr.exr -o out.html",
    "job": "bake {in}/job.json",
}
SLOW = {
    "capture": "capture --environment {in}/env.exr --material gold --views 12 --size 16 --samples 4 "
    "-o out.rsibr.exr",
    "preview": "preview {in}/bake.rsibr.exr --size 64 -o out.png",
    "turntable": "preview {in}/bake.rsibr.exr --size 32 --turntable 4 -o out.png",
    "compare": "compare {in}/bake.rsibr.exr --views 2 --size 32 --rings 16 -o out",
}
SOURCES = ("convert", "bake")
"""Commands whose outputs others read."""

PATIENCE = 120.0
"""[s] How long a killed command's processes may take to end before the test gives up."""

MOMENTS = int(os.environ.get("RSIBR_MOMENTS", len(QUICK)))
COMMANDS = QUICK if len(QUICK) >= MOMENTS else QUICK | SLOW


@dataclass(frozen=True)
class Truth:
    """A command that nobody disturbed.

    Attributes
    ----------
    argv : list of str
    contents : dict of str to bytes
        Path of a file that it writes -> what is in it.
    seconds : float
        How long it took.
    """

    argv: list[str]
    contents: dict[str, bytes]
    seconds: float


@dataclass
class Place:
    """A folder to work in, and one for temporary files."""

    folder: Path
    work: Path = field(init=False)
    temporary: Path = field(init=False)

    def __post_init__(self) -> None:
        self.work, self.temporary = self.folder / "work", self.folder / "temporary"
        for path in (self.work, self.temporary):
            path.mkdir(parents=True)

    def start(self, argv: list[str]) -> subprocess.Popen[str]:
        command = [Path(sys.executable).with_name("rsibr"), *argv, "--progress", "json"]
        with (self.folder / "told").open("w") as told:
            return subprocess.Popen(
                command,
                cwd=self.work,
                env={**os.environ, "TMPDIR": str(self.temporary)},
                stdout=subprocess.DEVNULL,
                stderr=told,
                text=True,
                start_new_session=True,
            )

    def run(self, argv: list[str]) -> None:
        assert self.start(argv).wait() == 0, self.told()

    def told(self) -> str:
        return (self.folder / "told").read_text()

    def contents(self) -> dict[str, bytes]:
        """What is in the files; of a fit, all but how long it took."""
        files = sorted(path for path in self.work.rglob("*") if path.is_file())
        return {str(path.relative_to(self.work)): _bytes(path) for path in files}


def _bytes(path: Path) -> bytes:
    if path.name != "out.json":
        return path.read_bytes()
    fit = json.loads(path.read_bytes())
    del fit["report"]["seconds"]
    return json.dumps(fit).encode()


@pytest.fixture(scope="module")
def truths(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Truth]:
    source = tmp_path_factory.mktemp("source")
    write_radiance(source / "env.exr", np.random.default_rng(1).random((128, 256, 3)))
    job = QUICK["bake"].replace("{in}", str(source)).split()
    (source / "job.json").write_text(CommandJob((*job, "--force")).to_json())  # as the panel writes it
    found = {}
    for name in sorted(COMMANDS, key=lambda name: name not in SOURCES):
        argv = COMMANDS[name].replace("{in}", str(source)).split()
        place = Place(tmp_path_factory.mktemp(name))
        before = time.monotonic()
        place.run(argv)
        seconds = time.monotonic() - before
        found[name] = Truth(argv, place.contents(), seconds)
        assert list(place.temporary.iterdir()) == []
        if name in SOURCES:
            for path in place.work.iterdir():
                shutil.copy(path, source / path.name.replace("out", name))
    return found


@pytest.mark.parametrize("moment", range(MOMENTS))
def test_a_kill_leaves_nothing_half_and_nothing_for_ever(
    moment: int, truths: dict[str, Truth], tmp_path: Path
) -> None:
    chance = random.Random(moment)
    name = list(COMMANDS)[moment % len(COMMANDS)]
    truth = truths[name]
    place = Place(tmp_path / "place")
    command = place.start(truth.argv)
    time.sleep(chance.random() * truth.seconds)
    # The command alone, as a person does, or all of its processes, as the system does
    (os.kill if chance.random() < 0.5 else os.killpg)(command.pid, signal.SIGKILL)
    command.wait()
    wait_for_group(command.pid)
    seen = {path: data for path, data in place.contents().items() if ".rsibr-" not in path}
    views = sum(path.startswith("out.rsibr.exr.partial/view") for path in seen)
    outputs = {path: data for path, data in seen.items() if ".partial/" not in path}
    assert outputs in ({}, truth.contents)
    if name == "capture" and not outputs:
        assert views >= finished_views(place.told()) - 1
    # A capture that was killed at its very end is told to be done
    again = outputs and name != "job" and not any(".partial/" in path for path in seen)
    place.run([*truth.argv, *(["--force"] if again else [])])
    assert place.contents() == truth.contents
    assert list(place.temporary.iterdir()) == []


BLENDER = """
import sys
import bpy
from rsibr.rsibr_addon.command_line.main import run_alone
sys.exit(run_alone(sys.argv[1:], bpy.app.tempdir))
"""
"""What the panel starts, as far as it is ours."""

PANEL = """
import sys
import time
from pathlib import Path
from rsibr.rsibr_addon.tasks.queue.background import Bake, BakeQueue
queue, bake = BakeQueue(), Bake("", Path("out.rsibr.exr"), [sys.executable, "-c", *sys.argv[1:]])
queue.add(bake)
print(bake._process.pid, flush=True)
while queue.busy:
    queue.update()
    time.sleep(0.01)
print(bake.state, bake.message)
"""


@pytest.mark.parametrize("moment", range(-(-MOMENTS // 5)))
def test_a_kill_of_the_panels_bake_or_of_its_blender(
    moment: int, truths: dict[str, Truth], tmp_path: Path
) -> None:
    chance = random.Random(1000 + moment)
    truth, place = truths["job"], Place(tmp_path / "place")
    argv = [sys.executable, "-c", PANEL, BLENDER, *truth.argv, "--json", "--progress", "json"]
    environment = {**os.environ, "TMPDIR": str(place.temporary)}
    with subprocess.Popen(argv, cwd=place.work, env=environment, stdout=subprocess.PIPE, text=True) as panel:
        assert panel.stdout is not None
        bake = int(panel.stdout.readline())
        time.sleep(chance.random() * truth.seconds)
        is_bake = chance.random() < 0.7
        with contextlib.suppress(ProcessLookupError):  # it may be done
            os.kill(bake if is_bake else panel.pid, signal.SIGKILL)
        told = panel.stdout.read()
    wait_for_group(bake)
    # The folder by which others wait for it is removed by the next bake
    seen = {path: data for path, data in place.contents().items() if ".rsibr-" not in path}
    outputs = {path: data for path, data in seen.items() if ".partial/" not in path}
    if is_bake:
        state = "done" if outputs else "failed The background Blender ended with code -9 and no result"
        assert told.startswith(state) or (outputs and told.startswith("failed")), told
        assert outputs in ({}, truth.contents)
    else:
        # Nobody listens any more; the work is done all the same
        assert outputs == truth.contents
    place.run(truth.argv)
    assert place.contents() == truth.contents
    # Killed before our first line, a Blender leaves an empty folder, which nothing tells for ours
    left = list(place.temporary.iterdir())
    assert all(path.name.startswith("blender_") and not any(path.iterdir()) for path in left), left


def wait_for_group(group: int) -> None:
    """Wait until no process of a command lives: its worker ends when it does, a moment later."""
    deadline = time.monotonic() + PATIENCE
    while time.monotonic() < deadline:
        try:
            os.killpg(group, 0)
        except ProcessLookupError:
            return
        time.sleep(0.01)
    pytest.fail(f"processes of the killed command still live after {PATIENCE} s")


def finished_views(told: str) -> int:
    """How many views a capture has said to be done."""
    steps = [json.loads(line)["progress"] for line in told.splitlines() if line.endswith("}}")]
    return max((step["done"] for step in steps if step["what"].startswith("rendering")), default=0)
