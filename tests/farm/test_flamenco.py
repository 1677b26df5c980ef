"""The whole way with a real manager of Flamenco 3 and two workers, whose programs FLAMENCO names."""

import json
import os
import shutil
import signal
import socket
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from rsibr.rsibr_addon.command_line.main import run
from rsibr.rsibr_addon.core.errors import NotNowError
from rsibr.rsibr_addon.files.map_set import read_map_set
from rsibr.rsibr_addon.files.radiance_pictures import write_radiance
from rsibr.rsibr_addon.tasks.farm.flamenco import SCRIPT, Manager

PROGRAMS = Path(os.environ.get("FLAMENCO", ""))
PATIENCE_SECONDS = 300

CONFIGURATION = """
_meta: {{version: 3}}
manager_name: test
database: {folder}/manager/database.sqlite
listen: 127.0.0.1:{port}
autodiscoverable: false
local_manager_storage_path: {folder}/manager/storage
shared_storage_path: {folder}/shared
shaman: {{enabled: false}}
variables:
  rsibr:
    values: [{{platform: linux, value: {rsibr}}}]
"""


@dataclass
class Farm:
    """A manager and its workers' processes."""

    manager: Manager
    workers: list[subprocess.Popen[bytes]]


@pytest.fixture(scope="module")
def farm(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Farm]:
    folder = tmp_path_factory.mktemp("farm")
    with socket.socket() as free, ExitStack() as stack:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
        free.close()
        for name in ("manager/scripts", "shared", "a", "b"):
            (folder / name).mkdir(parents=True)
        # The manager reads what lies beside its program
        shutil.copy(PROGRAMS / "flamenco-manager", folder / "manager")
        shutil.copy(SCRIPT, folder / "manager" / "scripts")
        rsibr = Path(sys.executable).with_name("rsibr")
        text = CONFIGURATION.format(folder=folder, port=port, rsibr=rsibr)
        (folder / "manager" / "flamenco-manager.yaml").write_text(text)
        manager = Manager(f"127.0.0.1:{port}")
        _started([folder / "manager" / "flamenco-manager"], folder / "manager", stack)
        _until(lambda: _answers(manager))
        command = [PROGRAMS / "flamenco-worker", "-manager", manager.url]
        yield Farm(manager, [_started(command, folder / name, stack) for name in ("a", "b")])


def _started(command: list[Any], folder: Path, stack: ExitStack) -> subprocess.Popen[bytes]:
    process = subprocess.Popen(
        command,
        cwd=folder,
        env={**os.environ, "FLAMENCO_HOME": str(folder)},
        stdout=stack.enter_context((folder / "log").open("wb")),
        stderr=subprocess.STDOUT,
    )
    stack.callback(process.wait)
    stack.callback(process.terminate)
    return process


def _answers(manager: Manager) -> bool:
    try:
        return bool(manager.etag())
    except NotNowError:
        return False


def _until(holds: Any) -> None:
    end = time.monotonic() + PATIENCE_SECONDS
    while not holds():
        assert time.monotonic() < end
        time.sleep(0.2)


@pytest.fixture(autouse=True)
def _light(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    for number, name in enumerate(("dawn", "dusk")):
        write_radiance(Path(f"{name}.exr"), np.random.default_rng(number).random((8, 16, 3)))


def submitted(farm: Farm, **batch: Any) -> subprocess.Popen[str]:
    Path("metals.json").write_text(json.dumps({"environments": ["d*.exr"]} | batch))
    rsibr = Path(sys.executable).with_name("rsibr")
    words = (
        "submit",
        "metals.json",
        "--flamenco",
        farm.manager.url,
        "--program",
        "{rsibr}",
        "--wait",
        "--json",
    )
    return subprocess.Popen([rsibr, *words], stdout=subprocess.PIPE, text=True)


def told(process: subprocess.Popen[str]) -> Any:
    return json.loads(process.communicate(timeout=PATIENCE_SECONDS)[0])


TABLES = [{"kind": "reflection-tables", "rows": 4, "diffuse_rows": 4}]


def test_a_batch_with_a_broken_job_is_done_but_for_that_and_fetched(farm: Farm) -> None:
    batch: dict[str, Any] = {"methods": TABLES, "materials": ["chrome", "wood"]}
    failed = told(submitted(farm, **batch))
    assert failed["error"].startswith("2 of 4 bakes failed")
    assert not failed["try_again"]
    assert sum("There is no preset wood" in warning for warning in failed["warnings"]) == 2
    for name in ("dawn", "dusk"):
        read_map_set(Path(f"{name}-chrome.rsibr.exr"))
    assert "There is no preset wood" in Path("metals-batch/index.html").read_text()
    done = told(submitted(farm, methods=TABLES, materials=["chrome"]))
    assert done["ok"]


def test_a_worker_that_is_ended_leaves_its_capture_to_the_other(farm: Farm, tmp_path: Path) -> None:
    views = {"kind": "radiance-views", "views": 12, "size": 32, "samples": 256, "denoise": False}
    watched = submitted(farm, environments=["dawn.exr"], methods=[views], materials=["chrome"])
    shared = farm.manager.shared_storage()
    _until(lambda: len(list(shared.glob("*/maps/*.partial/view*.exr"))) > 2)
    [lock] = shared.glob("*/maps/*.partial")
    before = {path.name: path.stat().st_mtime_ns for path in lock.glob("view*.exr")}
    worker = next(each for each in farm.workers if _has_children(each.pid))
    worker.send_signal(signal.SIGTERM)
    _until(lambda: len(list(lock.glob("view*.exr"))) > len(before))
    after = {path.name: path.stat().st_mtime_ns for path in lock.glob("view*.exr")}
    assert before.items() <= after.items()
    assert told(watched)["ok"]
    read_map_set(tmp_path / "dawn-chrome.rsibr.exr")


@pytest.mark.needs("bpy", "cycles")
def test_textures_of_an_object_s_materials_come_back(farm: Farm, tmp_path: Path) -> None:
    import bpy

    bpy.ops.wm.read_homefile(use_factory_startup=True)
    tree = bpy.context.object.active_material.node_tree
    noise = tree.nodes.new("ShaderNodeTexNoise").outputs["Color"]
    tree.links.new(noise, tree.nodes["Principled BSDF"].inputs["Base Color"])
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "studio.blend"))
    settings = {"object": "Cube", "size": 16, "samples": 1}
    job = {"format": 2, "kind": "inputs", "settings": settings, "output": "theirs.exr"}
    Path("cube.json").write_text(json.dumps(job))
    words = ["submit", "cube.json", "--flamenco", farm.manager.url, "--program", "{rsibr}", "--wait"]
    assert run(words) == 0
    assert run(["inputs", "Cube", "--size", "16", "--samples", "1", "-o", "ours.exr"]) == 0
    assert Path("theirs.exr").read_bytes() == Path("ours.exr").read_bytes()


def _has_children(process: int) -> bool:
    return any(path.read_text() for path in Path(f"/proc/{process}/task").glob("*/children"))
