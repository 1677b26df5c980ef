"""Measure whole commands as a user waits for them: CPU and wall time and memory, in turn with cmgen's.

cmgen, Filament's tool, is in Debian's package libfilament-tools; without it the ratios are left out. Prints a
Markdown table, and writes it into docs/performance.md if cmgen was there. This module imports nothing large,
because a process starts with the peak memory of its parent.
"""

import math
import os
import shutil
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import product
from pathlib import Path

from docs_table import write_table

RSIBR = str(Path(sys.executable).with_name("rsibr"))
RUNS = 5

VARIABLES = {name: value for name, value in os.environ.items() if name != "PYTHONDONTWRITEBYTECODE"}
"""Variables of the commands' environment: a user's modules are compiled once, when they are installed."""

CMGEN = ["cmgen", "--quiet", "--format=exr", "--size=256", "--ibl-ld=cmgen", "interior.hdr"]
"""Mips of 256 to 16 texels."""

BY_HDR = ["--environment", "interior.hdr", "--force"]
CHAIN = ["bake", "mip-chain", "--filter", "ggx", "--size", "256", "-o", "chain.rsibr.exr", *BY_HDR]
COMMANDS = {
    "five GGX mips, 256 to 16 texels, as cmgen": [*CHAIN, "--roughness", "0,.134,.293,.5,1"],
    "GGX mips, 256 to one texel, quadratic": [*CHAIN, "--roughness", "quadratic"],
    "`info` of an HDR": ["info", "interior.hdr"],
    "`convert` to octahedral, 512": [
        *["convert", "interior.hdr", "octahedral.exr"],
        *["--from", "equirect", "--to", "octahedral", "--size", "512", "--force"],
    ],
    "`bake kernel-pyramid`": ["bake", "kernel-pyramid", "-o", "pyramid.rsibr.exr", *BY_HDR],
    "`bake kernel-bank`": ["bake", "kernel-bank", "-o", "bank.rsibr.exr", *BY_HDR],
    "`bake lobe-stack` of copper, alpha .3": [
        *["bake", "lobe-stack", "--brdf", "ggx:metal=copper,alpha=0.3", "-o", "copper.rsibr.exr", *BY_HDR]
    ],
    "`bake reflection-tables`, varnished": [
        *["bake", "reflection-tables", "--material", "varnished", "-o", "tables.rsibr.exr", *BY_HDR]
    ],
    "`preview` of a sphere, 512 x 512": [
        *["preview", "copper.rsibr.exr", "--mesh", "sphere", "--size", "512", "-o", "sphere.png", "--force"]
    ],
    "`preview` of a million triangles, 512 x 512": [
        *["preview", "copper.rsibr.exr", "--mesh", "million.obj", "--size", "512"],
        *["-o", "million.png", "--force"],
    ],
    "mips of an 8192x4096 EXR": [
        *["bake", "mip-chain", "--environment", "large.exr", "--filter", "ggx", "--size", "256"],
        *["-o", "large.rsibr.exr", "--force"],
    ],
}
"""What is measured -> arguments of rsibr; the interior is Blender's, as Radiance HDR of 1024x512."""

BLENDER = [sys.executable, "-c", "import bpy"]
"""What a command that needs Blender waits for before anything else."""

INPUTS = {"interior.hdr": 1024, "large.exr": 8192}
"""Pictures that the commands read -> their width in texels."""


@dataclass(frozen=True)
class Usage:
    """What one process took, with its children: seconds of CPU and of the clock, and peak memory [MiB]."""

    cpu: float
    wall: float
    memory: float


def run(command: Sequence[str], folder: str) -> Usage:
    """Run a command to its end and ask the system what it took."""
    start = time.perf_counter()
    with open(Path(folder) / "said.txt", "wb") as said:
        process = subprocess.Popen(command, cwd=folder, env=VARIABLES, stdout=said, stderr=said)
        _, status, used = os.wait4(process.pid, 0)
    wall = time.perf_counter() - start
    process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode != 0:
        raise SystemExit(f"{' '.join(command)} failed: {(Path(folder) / 'said.txt').read_text()}")
    return Usage(used.ru_utime + used.ru_stime, wall, used.ru_maxrss / 1024)


def medians(runs: Sequence[Usage]) -> Usage:
    """Median of each figure."""
    return Usage(
        statistics.median(run.cpu for run in runs),
        statistics.median(run.wall for run in runs),
        max(run.memory for run in runs),
    )


def measured(command: Sequence[str], beside: Sequence[str] | None, folder: str) -> tuple[Usage, Usage | None]:
    """Medians of a command and of another one, run in turn."""
    own, other = [], []
    for _ in range(RUNS):
        own.append(run(command, folder))
        if beside:
            other.append(run(beside, folder))
    return medians(own), medians(other) if other else None


def row(what: str, used: Usage, beside: Usage | None) -> str:
    """A row of the table: ratios first."""
    ratios = f"{used.cpu / beside.cpu:.2f} | {used.wall / beside.wall:.2f}" if beside else "- | -"
    return f"| {what} | {ratios} | {used.cpu:.2f} s | {used.wall:.2f} s | {used.memory:.0f} MiB |"


def environment_file(name: str) -> str:
    """Path of one of Blender's own environments."""
    from importlib.util import find_spec

    spec = find_spec("bpy")
    if spec is None or spec.origin is None:
        raise SystemExit("The environments that are measured with are Blender's: install bpy.")
    (found,) = Path(spec.origin).parent.rglob(f"studiolights/world/{name}.exr")
    return str(found)


def write_sphere(path: Path) -> None:
    """Write a sphere of a million triangles as OBJ."""
    rings, sectors = 501, 1000
    with open(path, "w", encoding="ascii") as file:
        for ring, sector in product(range(rings + 1), range(sectors)):
            theta, phi = math.pi * ring / rings, 2.0 * math.pi * sector / sectors
            x, y, z = math.sin(theta) * math.cos(phi), math.sin(theta) * math.sin(phi), math.cos(theta)
            file.write(f"v {x:.6f} {y:.6f} {z:.6f}\n")
        for ring, sector in product(range(rings), range(sectors)):
            here, beside = 1 + ring * sectors + sector, 1 + ring * sectors + (sector + 1) % sectors
            if ring < rings - 1:  # at a pole, one of a cell's two triangles is empty
                file.write(f"f {here} {here + sectors} {beside + sectors}\n")
            if ring > 0:
                file.write(f"f {here} {beside + sectors} {beside}\n")


def main() -> None:
    """Measure in a folder that is thrown away, print the table and write it into the docs."""
    installed = shutil.which("cmgen") is not None
    lines = [
        "| work | CPU, of cmgen's | wall, of cmgen's | CPU | wall | memory |",
        "|---|---|---|---|---|---|",
    ]
    with tempfile.TemporaryDirectory() as folder:
        source = environment_file("interior")
        for name, width in INPUTS.items():
            laid_out = ["--from", "equirect", "--to", "equirect", "--size", str(width)]
            run([RSIBR, "convert", source, name, *laid_out], folder)
        write_sphere(Path(folder) / "million.obj")
        for number, (what, command) in enumerate(COMMANDS.items()):
            used, other = measured([RSIBR, *command], CMGEN if installed and number < 2 else None, folder)
            if other and number == 0:
                lines.append(row("cmgen, five GGX mips, 256 to 16 texels", other, other))
            lines.append(row(what, used, other))
            print(lines[-1], flush=True)
        lines.append(row("`import bpy` alone, which `preview` contains", *measured(BLENDER, None, folder)))
    table = "\n".join(lines)
    print(f"\n{table}")
    if installed:
        write_table("performance.md", "commands", table)
    else:
        print("\ncmgen is not installed (Debian: libfilament-tools), so docs/performance.md stays as it is.")


if __name__ == "__main__":
    main()
