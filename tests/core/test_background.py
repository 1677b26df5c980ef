"""Bakes in processes of their own: what they say is heard, and whatever becomes of them is told."""

import json
import os
import sys
import time
from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace

import pytest
from rsibr.rsibr_addon.core.progress import Progress
from rsibr.rsibr_addon.tasks.queue import background
from rsibr.rsibr_addon.tasks.queue.background import STARTING, Bake, BakeQueue, Farm, State, blender_command


def bake(script: str, title: str = "bake") -> Bake:
    return Bake(title, Path("out.rsibr.exr"), [sys.executable, "-c", script])


def told(**fields: object) -> str:
    """A line of Python that tells of progress."""
    line = json.dumps({"progress": fields})
    return f"import sys; print({line!r}, file=sys.stderr, flush=True)\n"


def result(**fields: object) -> str:
    return f"print({json.dumps(fields)!r})\n"


def wait(queue: BakeQueue, until: Callable[[], bool]) -> list[Bake]:
    ended = []
    deadline = time.monotonic() + 30.0
    while not until():
        assert time.monotonic() < deadline
        ended += queue.update()
        time.sleep(0.01)
    return ended


def held(path: Path) -> str:
    """Lines of Python that wait for a file."""
    return f"import os, time\nwhile not os.path.exists({str(path)!r}): time.sleep(0.01)\n"


def test_one_after_another(tmp_path: Path) -> None:
    queue = BakeQueue()
    script = (
        told(done=1, total=4, what="view 2") + result(ok=True, warnings=["dark"]) + "print('Blender quit')"
    )
    first, second = bake(held(tmp_path / "go") + script, "first"), bake(script, "second")
    queue.add(first)
    queue.add(second)
    assert (first.state, second.state) == (State.RUNNING, State.WAITING)
    assert queue.unfinished(first.output) is first
    (tmp_path / "go").touch()
    assert wait(queue, lambda: not queue.busy) == [first, second]
    assert first.state is second.state is State.DONE
    assert first.fraction == STARTING + 0.25 * (1.0 - STARTING)
    assert first.progress == Progress(1, 4, "view 2")
    assert first.warnings == ["dark"]
    assert queue.unfinished(first.output) is None
    queue.forget_ended(lambda ended: ended is first)
    assert queue.bakes == [second]


def test_failures_are_told_in_words() -> None:
    queue = BakeQueue()
    said = bake(result(ok=False, error="The disk is full: free some.", warnings=[]) + "raise SystemExit(1)")
    died = bake("import os, sys; print('GPU on fire', file=sys.stderr, flush=True); os._exit(11)")
    missing = Bake("none", Path("x"), ["/nowhere/blender"])
    for each in (said, died, missing):
        queue.add(each)
    wait(queue, lambda: not queue.busy)
    assert [each.state for each in queue.bakes] == [State.FAILED] * 3
    assert said.message == "The disk is full: free some."
    assert died.message == "The background Blender ended with code 11 and no result: GPU on fire"
    assert missing.message.startswith("/nowhere/blender cannot be started")


def test_a_cancelled_bake_ends_and_the_next_begins() -> None:
    queue = BakeQueue()
    endless = bake(told(done=0, total=2, what="waiting") + "import time; time.sleep(600)")
    after = bake(result(ok=True))
    queue.add(endless)
    queue.add(after)
    wait(queue, lambda: endless.progress is not None)
    assert endless.seconds_left is None
    endless.cancel()
    assert endless.state is State.CANCELLED
    wait(queue, lambda: not queue.busy)
    assert after.state is State.DONE


def test_a_waiting_bake_can_be_cancelled_and_a_closed_queue_leaves_nothing() -> None:
    queue = BakeQueue()
    endless, waiting = (bake("import time; time.sleep(600)") for _ in range(2))
    queue.add(endless)
    queue.add(waiting)
    waiting.cancel()
    assert waiting.state is State.CANCELLED
    process = endless._process
    queue.close()
    assert process is not None
    assert process.poll() is not None
    assert queue.bakes == []


def test_time_left_is_judged_by_the_steps_so_far(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    now = 100.0
    monkeypatch.setattr(background, "time", SimpleNamespace(monotonic=lambda: now))
    queue = BakeQueue()
    steps = told(done=2, total=6, what="a") + held(tmp_path / "go") + told(done=4, total=6, what="b")
    steady = bake(steps + "time.sleep(600)")
    queue.add(steady)
    wait(queue, lambda: steady._first_step is not None)
    assert steady.seconds_left is None
    now += 5.0
    (tmp_path / "go").touch()
    wait(queue, lambda: steady.progress is not None and steady.progress.done == 4)
    # Two steps took five seconds; two more are to come
    assert steady.seconds_left == 5.0
    queue.close()


@pytest.mark.skipif(sys.platform == "win32", reason="Windows has classes of priority instead")
def test_what_the_artist_does_comes_first() -> None:
    queue = BakeQueue()
    polite = bake(told(done=0, total=1, what="waiting") + "import time; time.sleep(600)")
    queue.add(polite)
    wait(queue, lambda: polite.progress is not None)
    assert polite._process is not None
    assert os.getpriority(os.PRIO_PROCESS, polite._process.pid) >= min(19, os.nice(0) + 1)
    queue.close()


def test_the_command_is_blenders() -> None:
    command = blender_command("/opt/blender", "ours", (Path("a.blend"), "Two"), Path("job.json"))
    assert command[:10] == [
        "/opt/blender",
        "--background",
        "--disable-autoexec",
        "a.blend",
        "--scene",
        "Two",
        "--addons",
        "ours",
        "--command",
        "rsibr",
    ]
    assert command[10:] == ["bake", "job.json", "--json", "--progress", "json"]
    assert blender_command("/opt/blender", "ours", None, Path("j"))[:4] == [
        "/opt/blender",
        "--background",
        "--disable-autoexec",
        "--addons",
    ]


def test_the_command_of_a_farm_is_allowed_the_network_and_waits() -> None:
    farm = Farm("http://farm:8080", "/mnt/farm")
    command = blender_command("/opt/blender", "ours", None, Path("job.json"), farm)
    assert command[:6] == [
        *blender_command("/opt/blender", "ours", None, Path("j"))[:3],
        "--online-mode",
        *command[4:6],
    ]
    assert command[command.index("rsibr") + 1 :] == [
        *("submit", "job.json", "--flamenco", "http://farm:8080", "--shared", "/mnt/farm", "--wait"),
        *("--json", "--progress", "json"),
    ]
    assert "--shared" not in Farm("http://farm:8080").words


def test_a_bake_elsewhere_waits_for_none_and_is_left_to_go_on(tmp_path: Path) -> None:
    queue = BakeQueue()
    here, other = bake(held(tmp_path / "go") + result(ok=True)), bake("")
    told_of_end = (
        "import pathlib, signal\n"
        f"signal.signal(signal.SIGTERM, lambda *told: pathlib.Path({str(tmp_path / 'ended')!r}).touch())\n"
    )
    away = bake(told_of_end + told(done=0, total=1, what="ready") + held(tmp_path / "never"))
    away.elsewhere = True
    for each in (here, other, away):
        queue.add(each)
    assert [each.state for each in (here, other, away)] == [State.RUNNING, State.WAITING, State.RUNNING]
    wait(queue, lambda: away.progress is not None)
    assert away._process is not None
    queue.close()
    assert away._process.poll() is not None
    assert not (tmp_path / "ended").exists()


def test_a_process_gets_variables_beside_our_own() -> None:
    queue = BakeQueue()
    script = (
        "import json, os; print(json.dumps({'ok': os.environ['RSIBR_TEST'] == 'a' and 'PATH' in os.environ}))"
    )
    told = bake(script)
    told.variables = {"RSIBR_TEST": "a"}
    queue.add(told)
    wait(queue, lambda: not queue.busy)
    assert told.state is State.DONE
