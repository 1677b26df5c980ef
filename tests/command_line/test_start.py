"""What commands import: those that need no Blender do without, so that they start at once."""

import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from rsibr.rsibr_addon.files.map_set import read_map_set_header
from rsibr.rsibr_addon.files.radiance_pictures import write_radiance
from rsibr.rsibr_addon.files.version import rsibr

SCRIPT = """
import json, sys
from rsibr.rsibr_addon.command_line.main import run
code = run(sys.argv[1:])
print(json.dumps([code, sorted(sys.modules)]))
"""

LIGHT = ("--environment", "light.hdr")
COMMANDS = {
    "info": ("info", "light.hdr"),
    "convert": ("convert", "light.hdr", "a.exr", "--from", "equirect", "--to", "octahedral", "--size", "16"),
    "mip-chain": ("bake", "mip-chain", *LIGHT, "--size", "8", "-o", "a.rsibr.exr"),
    "kernel-bank": ("bake", "kernel-bank", *LIGHT, "--size", "16", "-o", "bank.rsibr.exr"),
    "lobe-stack": ("bake", "lobe-stack", *LIGHT, "--brdf", "phong:ks=.5,n=4", "-o", "stack.rsibr.exr"),
    "tables": ("bake", "reflection-tables", *LIGHT, "--material", "matte", "-o", "tables.rsibr.exr"),
    "fit": ("fit", "--brdf", "phong:ks=.5,n=4", "--lobes", "2", "--slices", "4", "-o", "a.json"),
    "export": ("export", "mips.rsibr.exr", "-o", "a.ktx2"),
    "brackets": ("illuminate", "brackets", "light.hdr", "light.hdr", "--times", "1,2", "-o", "b.exr"),
}
"""What needs no Blender."""

BLENDER = {"bpy", "gpu", "mathutils", "bmesh"}


def imported(folder: Path, *argv: str) -> tuple[int, set[str], str]:
    """A command's exit code, the modules that are imported at its end, and what it tells."""
    ended = subprocess.run(
        [sys.executable, "-c", SCRIPT, *argv], cwd=folder, capture_output=True, text=True, check=False
    )
    assert not ended.returncode, ended.stderr
    code, modules = json.loads(ended.stdout.splitlines()[-1])
    return code, set(modules), ended.stderr


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Holds `light.hdr`, and `mips.rsibr.exr` made of it."""
    folder = tmp_path_factory.mktemp("start")
    write_radiance(folder / "light.hdr", np.full((64, 128, 3), 0.5))
    code, _, told = imported(folder, *COMMANDS["mip-chain"][:-1], "mips.rsibr.exr")
    assert code == 0, told
    return folder


@pytest.mark.parametrize("command", COMMANDS)
def test_what_needs_no_blender_imports_none(command: str, folder: Path) -> None:
    code, modules, told = imported(folder, *COMMANDS[command])
    assert code == 0, told
    assert not BLENDER & modules


def test_what_blender_had_no_part_in_names_none(folder: Path) -> None:
    assert read_map_set_header(folder / "mips.rsibr.exr")["software"] == rsibr()
