"""Measure previews in a Blender's window, beside what Blender draws; writes the tables of docs/viewport.md.

Needs the window that the tests in tests/gui need; without, it says so and measures nothing.
"""

import json
import os
import shutil
import subprocess
import sys
import tempfile
import tomllib
from pathlib import Path
from typing import Any

from docs_table import write_table
from rsibr.tests.conftest import BLENDER_WINDOW, absence
from rsibr.tests.mirror_capture import write_mirror_capture

CI = Path(__file__).parent
ROOT = CI.parent
RSIBR = Path(sys.executable).with_name("rsibr")
FOREST = ("--environment", "forest")

BAKES = {
    "tables": ["tables", *FOREST, "--material", "varnished"],
    "mips": ["mips", *FOREST, "--size", "128"],
    "stack": ["bake", *FOREST, "--brdf", "ggx:alpha=0.3,metal=copper", "--lobes", "3"],
    "pyramid": ["bake", "kernel-pyramid", *FOREST, "--size", "256"],
}
"""Name of a map set -> the command that makes it."""

SCENE = "import sys; sys.path.insert(0, '/job'); import bench_viewport_scene"

FRAMES = {
    "flat": "depth alone, without shading",
    "mips": "mip chain (Kautz et al. 2004)",
    "tables": "reflection tables (Miller & Hoffman 1984)",
    "views texel": "radiance views, `texel`",
    "views paper": "radiance views, `paper` (Cabral et al. 1999)",
    "views fragment": "radiance views, `fragment`",
    "stack": "lobe stack of three lobes (Kautz & McCool 2000)",
    "pyramid": "own materials, a grey one",
}
"""What is measured -> in words."""


def main() -> None:
    """Measure, print the tables, and write them into the docs."""
    os.environ["RSIBR_REQUIRE"] = "gui"
    if reason := absence("gui"):
        print(f"Previews in a window are NOT measured: {reason}", file=sys.stderr)
        return
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        _prepare(folder)
        told = _measure(folder)
    table = "\n".join([*_frames(told), "", *_ratios(told)])
    print(table)
    write_table("viewport.md", "viewport", table)


def _prepare(folder: Path) -> None:
    """Put the extension, the map sets and the scenario where Blender sees them as /job."""
    subprocess.run([sys.executable, CI / "build_extension.py"], check=True, capture_output=True)
    version = tomllib.loads((ROOT / "blender_manifest.toml").read_text())["version"]
    archive = ROOT / "dist" / f"rsibr-{version}.zip"
    shutil.copy(archive, folder / "extension.zip")
    for script in (
        CI / "bench_viewport_scene.py",
        ROOT / "tests" / "gui" / "in_window.py",
        ROOT / "tests" / "gui" / "xshot.py",
    ):
        shutil.copy(script, folder)
    write_mirror_capture(folder / "views.rsibr.exr", view_count=42, size=128)
    for name, command in BAKES.items():
        subprocess.run([RSIBR, *command, "-o", folder / f"{name}.rsibr.exr"], check=True, capture_output=True)


def _measure(folder: Path) -> dict[str, Any]:
    """What the scenario tells."""
    # The bpy module has set OCIO to its own files, which are not this Blender's.
    environment = {name: value for name, value in os.environ.items() if name != "OCIO"}

    def blender(*arguments: str) -> str:
        command = [BLENDER_WINDOW, "run", folder, *arguments]
        process = subprocess.run(command, env=environment, capture_output=True, text=True, check=True)
        return process.stdout

    blender("--command", "extension", "install-file", "-r", "user_default", "-e", "/job/extension.zip")
    output = blender("--window", "--python-expr", SCENE)
    (line,) = (line for line in output.splitlines() if line.startswith("TOLD "))
    told: dict[str, Any] = json.loads(line.removeprefix("TOLD "))
    if "error" in told:
        raise SystemExit(told["error"])
    return told


def _frames(told: dict[str, Any]) -> list[str]:
    """What each way to shade costs."""
    rows = [
        f"| {words} | {told[name]['cpu']:.0f} | {told[name]['python']:.2f} | {told[name]['allocations']} |"
        for name, words in FRAMES.items()
    ]
    return ["| Frame of previews | CPU ms | Python ms | allocations |", "|---|---|---|---|", *rows]


def _ratios(told: dict[str, Any]) -> list[str]:
    """What was asked for, and what is."""

    def cost(name: str) -> float:
        return float(told[name]["cpu"])

    shaded = [name for name in FRAMES if name != "flat"]
    eevee = told["eevee"]
    rows = [
        (
            f"the costliest frame of previews, of EEVEE's {eevee:.0f} ms in Material Preview",
            max(map(cost, shaded)) / eevee,
            "1/3",
        ),
        ("mip chain, of depth alone", cost("mips") / cost("flat"), "3"),
        ("`fragment`, of `paper`", cost("views fragment") / cost("views paper"), "4"),
    ]
    python = max(told[name]["python"] for name in shaded)
    switches = ", ".join(
        f"{name} {longest:.0f} ({shown:.0f})" for name, (longest, shown) in told["switch"].items()
    )
    longest, shown = told["back"]["stack"]
    return [
        "| Compared | measured | asked, at most |",
        "|---|---|---|",
        *(f"| {what} | {measured:.2f} | {asked} |" for what, measured, asked in rows),
        f"| Python's part of a frame, the most | {python:.2f} ms | 1 ms |",
        f"| CPU of the window's thread for another map set (shown after) | {switches} ms | 100 ms |",
        f"| back to one used lately | {longest:.0f} ({shown:.0f}) ms | 100 ms |",
        f"| for comparison: Blender's own redraw in Solid | {told['solid']:.0f} ms | |",
    ]


if __name__ == "__main__":
    main()
