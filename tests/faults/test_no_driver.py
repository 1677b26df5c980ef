"""Machines whose graphics driver is missing or too old: one sentence, and what needs none is done."""

import os
import subprocess
import sys
from pathlib import Path

import pytest
from rsibr.tests.faults.processes import run
from rsibr.tests.mirror_capture import write_mirror_capture

pytestmark = [
    pytest.mark.skipif(sys.platform != "linux", reason="EGL is Linux's"),
    pytest.mark.needs("gl", "bpy"),
    pytest.mark.slow,
]

NO_DRIVER = {
    "none": {"__EGL_VENDOR_LIBRARY_FILENAMES": "/nonexistent.json"},
    "too old": {"MESA_GL_VERSION_OVERRIDE": "3.0"},
}
SENTENCE = "Blender found no graphics driver (EGL has no "


@pytest.mark.parametrize("which", NO_DRIVER)
def test_a_preview_fails_with_a_sentence(which: str, tmp_path: Path) -> None:
    write_mirror_capture(tmp_path / "in.rsibr.exr")
    ended = run(tmp_path, "preview", "../in.rsibr.exr", "-o", "out.png", variables=NO_DRIVER[which])
    assert ended.code == 1
    assert ended.err.startswith(f"rsibr: error: {SENTENCE}")
    assert len(ended.err.splitlines()) == 1
    assert ended.left == set()


def test_a_render_fails_with_a_sentence(tmp_path: Path) -> None:
    """By the command, and by a script that knows the engine alone."""
    (tmp_path / "save.py").write_text(SAVE)
    subprocess.run([sys.executable, tmp_path / "save.py"], check=True, cwd=tmp_path, capture_output=True)
    ended = run(tmp_path, "render", "../in.blend", "-o", "out.png", variables=NO_DRIVER["none"])
    assert ended.code == 1
    assert ended.err.startswith(f"rsibr: error: {SENTENCE}")
    assert ended.left == set()
    (tmp_path / "render.py").write_text(RENDER)
    script = subprocess.run(
        [sys.executable, tmp_path / "render.py"],
        env={**os.environ, **NO_DRIVER["none"]},
        cwd=tmp_path,
        capture_output=True,
        text=True,
        check=False,
    )
    assert script.returncode == 0, script.stdout + script.stderr
    assert f"told: Error: {SENTENCE}" in script.stdout


SAVE = """
import bpy
bpy.context.scene.world = None
bpy.ops.wm.save_as_mainfile(filepath="in.blend")
"""

RENDER = """
import bpy, rsibr
rsibr.register()
bpy.context.scene.world, bpy.context.scene.render.engine = None, "RSIBR"
try:
    bpy.ops.render.render()
except RuntimeError as error:
    print("told:", error)
"""


def test_a_report_comes_without_meshes(tmp_path: Path) -> None:
    write_mirror_capture(tmp_path / "in.rsibr.exr")
    ended = run(tmp_path, "report", "../in.rsibr.exr", "-o", "out.html", variables=NO_DRIVER["none"])
    assert ended.code == 0
    assert ended.err.startswith(f"rsibr: warning: The report shows no mesh: {SENTENCE}")
    page = (tmp_path / "work" / "out.html").read_text()
    assert 'alt="a sphere"' not in page
    assert "<figure>" in page
