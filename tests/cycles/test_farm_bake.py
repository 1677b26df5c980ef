"""A bake of the open scene that other machines do is the bake of the open file."""

import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import bpy
import pytest
import rsibr
from rsibr.rsibr_addon.command_line.main import run
from rsibr.rsibr_addon.tasks.light import environments
from rsibr.rsibr_addon.tasks.queue.bake_request import request_for
from rsibr.tests.bake_jobs import run_job
from rsibr.tests.cycles.test_background_bake import HEIGHT, linked, second_scene

WORKER = [
    sys.executable,
    "-c",
    "from rsibr.rsibr_addon.tasks.light import environments\n"
    f"environments.WORLD_HEIGHT = {HEIGHT}\n"
    "from rsibr.rsibr_addon.command_line.worker import serve\n"
    "serve()",
]


@pytest.fixture(autouse=True)
def _registered(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    monkeypatch.setattr("rsibr.rsibr_addon.command_line.batch._worker_command", lambda: WORKER)
    monkeypatch.setattr(environments, "WORLD_HEIGHT", HEIGHT)
    rsibr.register()
    yield
    rsibr.unregister()


@pytest.mark.slow
@pytest.mark.parametrize("make", [linked, second_scene])
def test_a_sent_scene_gives_the_same_bake(make: Callable[[Path], None], tmp_path: Path) -> None:
    (tmp_path / "studio").mkdir()
    make(tmp_path / "studio")
    chosen, item, scene = bpy.context.scene.rsibr_bake, bpy.context.object, bpy.context.scene
    chosen.kind, views = "radiance_views", chosen.radiance_views
    views.size, views.samples, views.denoise = 8, 4, False
    request = request_for(scene.rsibr_bake, scene, item)
    ours = tmp_path / "ours.rsibr.exr"
    assert run_job(request.job(ours), tmp_path) == 0
    job = tmp_path / "scene.json"
    job.write_text(request.job(tmp_path / "theirs.rsibr.exr").to_json())
    assert run(["submit", str(job), "--openjd", str(tmp_path / "bundle")]) == 0
    (tmp_path / "studio").rename(tmp_path / "gone")
    [batch] = map(str, (tmp_path / "bundle" / "inputs").glob("*.json"))
    assert run(["batch", batch, "--output", str(tmp_path), "--part", "world-radiance-views"]) == 0
    assert (tmp_path / "theirs.rsibr.exr").read_bytes() == ours.read_bytes()
