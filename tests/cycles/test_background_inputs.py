"""Inputs that a background Blender bakes of the scene written for it are those of the open file."""

import os
import subprocess
import sys
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import bpy
import pytest
from rsibr.rsibr_addon.core.progress import drain
from rsibr.rsibr_addon.tasks.methods.bake import bake
from rsibr.rsibr_addon.tasks.queue.input_bakes import input_bake_of, input_job, inputs_settings
from rsibr.tests.cycles.test_background_bake import CHILD, linked, modified
from rsibr.tests.open_file import open_file_state


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore:Material .* depends on the view")
@pytest.mark.parametrize("make", [modified, linked])
def test_the_written_scene_gives_the_same_inputs(
    make: Callable[[Path], None], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("rsibr.rsibr_addon.tasks.queue.bake_request.blender_program", lambda: "blender")
    settings = replace(inputs_settings(), size=32, samples=1)
    monkeypatch.setattr("rsibr.rsibr_addon.tasks.queue.input_bakes.inputs_settings", lambda: settings)
    make(tmp_path)
    item, theirs, ours = bpy.context.object, tmp_path / "theirs.exr", tmp_path / "ours.exr"
    before = open_file_state()
    sent = input_bake_of(bpy.context.scene, item, theirs)
    assert open_file_state() == before
    child = subprocess.run(
        [sys.executable, "-c", CHILD, *sent.command[1:]],
        env={**os.environ, **sent.variables},
        capture_output=True,
        text=True,
        check=False,
    )
    sent.tidy()
    assert child.returncode == 0, child.stdout + child.stderr
    drain(bake(input_job(item, ours)))
    assert theirs.read_bytes() == ours.read_bytes()
