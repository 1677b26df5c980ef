"""The built zip in a Blender of its own, whose Python is not the one of the other tests."""

import json
import subprocess
import tomllib
import zipfile
from collections.abc import Callable
from pathlib import Path

import numpy as np
from rsibr.rsibr_addon.command_line.main import run
from rsibr.rsibr_addon.files.pictures import read_exr

ROOT = Path(__file__).parents[2]

Blender = Callable[..., subprocess.CompletedProcess[str]]


def test_the_zip_holds_what_runs_and_nothing_else(extension: Path) -> None:
    with zipfile.ZipFile(extension) as archive:
        names = {name for name in archive.namelist() if not name.endswith("/")}
    folders = [ROOT / "rsibr_addon", ROOT / "operators", ROOT / "gpu_shaders"]
    sources = [path for folder in folders for path in folder.rglob("*.*") if path.suffix != ".pyc"]
    expected = {path.relative_to(ROOT).as_posix() for path in sources}
    expected |= {"__init__.py", "LICENSE", "blender_manifest.toml"}
    manifest = tomllib.loads((ROOT / "blender_manifest.toml").read_text())
    assert names == expected | {wheel.removeprefix("./") for wheel in manifest["wheels"]}


def test_the_command_is_registered(blender: Blender) -> None:
    process = blender("--command", "rsibr", "--help")
    assert process.returncode == 0
    assert process.stdout.startswith("usage: rsibr")


def test_exit_codes_and_json_reach_the_caller(blender: Blender) -> None:
    failed = blender("--command", "rsibr", "info", "/job/missing.rsibr.exr", "--json")
    assert failed.returncode == 1
    assert "/job/missing.rsibr.exr" in json.loads(failed.stdout.splitlines()[-1])["error"]
    assert blender("--command", "rsibr", "info").returncode == 2


def test_the_installed_zip_bakes_and_previews(blender: Blender, job: Path) -> None:
    """As the checkout does, whose preview of the same map set is the same picture."""
    options = ["--mesh", "sphere", "--size", "64"]
    bake = ["--environment", "city", "--brdf", "ward:alpha=0.3,ks=1", "--size", "16", "--slices", "4"]
    for arguments in (
        ["bake", *bake, "--verbose", "-o", "/job/installed.rsibr.exr"],
        ["preview", "/job/installed.rsibr.exr", *options, "-o", "/job/preview.exr"],
    ):
        process = blender("-b", "--command", "rsibr", *arguments)
        assert process.returncode == 0, process.stderr
        # Those of another version cannot read what this one makes
        assert "EXR_ERR" not in process.stdout + process.stderr, "OpenEXR calls functions of Blender's own"
    assert run(["preview", str(job / "installed.rsibr.exr"), *options, "-o", str(job / "ours.exr")]) == 0
    theirs, ours = (read_exr(job / name) for name in ("preview.exr", "ours.exr"))
    covered = (theirs[..., 3] == 1.0) & (ours[..., 3] == 1.0)
    assert covered.sum() > 2000
    # Two versions of Mesa round single precision in their own ways
    np.testing.assert_allclose(theirs[covered], ours[covered], rtol=1e-3)


def test_disabling_leaves_nothing_behind(blender: Blender) -> None:
    script = """
import addon_utils, bpy, sys
name = "bl_ext.user_default.rsibr"
def of_ours():
    return [kind for kind in dir(bpy.types) if kind.startswith("RSIBR_")] + list(dir(bpy.ops.rsibr))
enabled = of_ours()
for _ in range(2):
    addon_utils.disable(name)
    assert of_ours() == [], of_ours()
    assert addon_utils.enable(name) is not None
    assert of_ours() == enabled
"""
    process = blender("-b", "--python-exit-code", "3", "--python-expr", script)
    assert process.returncode == 0, process.stderr
    assert "Traceback" not in process.stdout + process.stderr
