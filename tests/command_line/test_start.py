"""What commands import: those that need no Blender do without, so that they start at once."""

import json
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from rsibr.rsibr_addon.files.kinds.registry import STORED
from rsibr.rsibr_addon.files.map_set import read_map_set_header
from rsibr.rsibr_addon.files.radiance_pictures import write_radiance
from rsibr.rsibr_addon.files.version import rsibr

SCRIPT = """
import json, sys
from rsibr.rsibr_addon.command_line.main import run
code = run(sys.argv[1:])
print(json.dumps([code, sorted(sys.modules)]))
"""

WITHOUT_BLENDER = """
import sys
from rsibr.rsibr_addon.command_line.main import run

class Blindfold:
    def __init__(self, finder):
        self.finder = finder

    def find_spec(self, name, *where):
        hidden = name in ("bpy", "bmesh", "gpu", "mathutils")
        return None if hidden else self.finder.find_spec(name, *where)

sys.meta_path[:] = map(Blindfold, sys.meta_path)
sys.exit(run(sys.argv[1:]))
"""
"""Blender cannot be found, as if it were not installed."""

AT_NUMPY = """
import os, sys
from rsibr.rsibr_addon.command_line.main import run

told = []

class Watch:
    def find_spec(self, name, *where):
        if name == "numpy":
            told.append(os.environ["OPENBLAS_THREAD_TIMEOUT"])

sys.meta_path.insert(0, Watch())
run(sys.argv[1:])
print(*told)
"""
"""Prints at last how long OpenBLAS's threads wait, as they are told when numpy is imported."""

FEW = ("--method", "single", "--slices", "2")
LIGHT = ("--environment", "light.hdr")
COMMANDS = {
    "info": ("info", "light.hdr"),
    "convert": ("convert", "light.hdr", "a.exr", "--from", "equirect", "--to", "octahedral", "--size", "16"),
    "mip-chain": ("bake", "mip-chain", *LIGHT, "--size", "8", "-o", "a.rsibr.exr"),
    "kernel-bank": ("bake", "kernel-bank", *LIGHT, "--size", "16", "-o", "bank.rsibr.exr"),
    "kernel-pyramid": ("bake", "kernel-pyramid", *LIGHT, "--size", "32", "-o", "pyramid.rsibr.exr"),
    "views": (
        "bake",
        "radiance-views",
        *LIGHT,
        "--material",
        "phong:ks=.5,n=4",
        "--size",
        "8",
        "-o",
        "v.rsibr.exr",
    ),
    "lobe-stack": ("bake", "lobe-stack", *LIGHT, "--brdf", "phong:ks=.5,n=4", *FEW, "-o", "stack.rsibr.exr"),
    "tables": ("bake", "reflection-tables", *LIGHT, "--material", "matte", "-o", "tables.rsibr.exr"),
    "fit": ("fit", "--brdf", "phong:ks=.5,n=4", *FEW, "-o", "a.json"),
    "export": ("export", "mips.rsibr.exr", "-o", "a.ktx2"),
    "engine": ("export", "mips.rsibr.exr", "--for", "three", "--size", "16", "-o", "a.dds"),
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


@pytest.mark.parametrize("argv", [["--help"], ["--version"]])
def test_what_needs_no_numbers_imports_no_numpy(argv: list[str], folder: Path) -> None:
    code, modules, told = imported(folder, *argv)
    assert code == 0, told
    assert "numpy" not in modules


@pytest.mark.parametrize(("own", "told"), [({}, "10"), ({"OPENBLAS_THREAD_TIMEOUT": "20"}, "20")])
def test_openblas_is_told_not_to_wait_before_numpy_is_imported(
    own: dict[str, str], told: str, folder: Path
) -> None:
    free = {name: value for name, value in os.environ.items() if name != "OPENBLAS_THREAD_TIMEOUT"}
    watched = [sys.executable, "-c", AT_NUMPY, *COMMANDS["info"]]
    ended = subprocess.run(watched, cwd=folder, env=free | own, capture_output=True, text=True, check=True)
    assert ended.stdout.splitlines()[-1] == told


def test_a_bake_imports_nothing_of_other_kinds(folder: Path) -> None:
    _, modules, _ = imported(folder, *COMMANDS["mip-chain"], "--force")
    known = {name.rpartition(".")[2] for name in modules if ".files.kinds." in name}
    assert known & set(STORED) == {"mip_chain"}


@pytest.mark.parametrize(
    ("command", "sentence"),
    [
        (
            "preview mips.rsibr.exr -o a.png",
            "rsibr preview needs Blender for this: pip install",
        ),
        ("fit --brdf blend:copper -o blend.json", "rsibr fit needs Blender for this"),
        ("bake mip-chain -o world.rsibr.exr", "give --environment FILE."),
        ("bake mip-chain --environment forest -o forest.rsibr.exr", "those with names come with Blender"),
    ],
)
def test_without_blender_a_sentence_says_what_needs_it(command: str, sentence: str, folder: Path) -> None:
    run = [sys.executable, "-c", WITHOUT_BLENDER, *command.split()]
    ended = subprocess.run(run, cwd=folder, capture_output=True, text=True, check=False)
    assert ended.returncode == 1
    (line,) = ended.stderr.splitlines()
    assert line.startswith("rsibr: error: ")
    assert sentence in line
