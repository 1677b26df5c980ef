"""Measure filtering: CPU time, memory and errors of each piece of work, beside what it has to reach.

Each measurement runs in a process of its own. Errors are those against a run whose own promised error is
negligible, and that run is compared with brute force in some directions.
"""

import importlib.util
import json
import resource
import statistics
import subprocess
import sys
import time
from collections.abc import Callable
from dataclasses import asdict, dataclass
from pathlib import Path

import numpy as np
from docs_table import write_table
from rsibr.rsibr_addon.core.conventions import Array
from rsibr.rsibr_addon.core.filtering.harmonics.analysis import analyse_environment
from rsibr.rsibr_addon.core.filtering.irradiance import irradiance_exact
from rsibr.rsibr_addon.core.filtering.prefilter import (
    Prefiltered,
    analysis_degree,
    prefilter,
    prefilter_exact,
)
from rsibr.rsibr_addon.core.filtering.radial_lobes import ggx_lobe
from rsibr.rsibr_addon.core.filtering.zonal import ZonalLobe, expand
from rsibr.rsibr_addon.core.maps.representation import representation
from rsibr.rsibr_addon.files.environments import read_environment

ENVIRONMENT = "interior"
RUNS = 5
REFERENCE = 1e-11
BRUTE_DIRECTIONS = 8
BRUTE_LOBES = 4


@dataclass(frozen=True)
class Stack:
    """Lobes of GGX without n.l, filtered in the directions of two paraboloid maps of 128x128."""

    what: str
    target: str
    repeat: int
    slices: int
    narrowest: float
    tolerance: float


STACKS = (
    Stack("16 slices, alpha .04-.5, 2048x1024", "1.0 s, 1e-5, 3e-5, 250 MiB", 2, 16, 0.04, 1e-6),
    Stack("the same, tolerance 1e-5", "1.0 s, 1e-5, 3e-5, 250 MiB", 2, 16, 0.04, 1e-5),
    Stack("the same, tolerance 1e-7", "1e-7", 2, 16, 0.04, 1e-7),
    Stack("the same, 4096x2048", "1.6 s", 4, 16, 0.04, 1e-6),
    Stack("the same, 64 slices", "2.5 s", 2, 64, 0.04, 1e-6),
    Stack("the same, alpha .01-.5", "6 s", 2, 16, 0.01, 1e-6),
    Stack("the same, alpha .01-.5, tolerance 1e-5", "6 s", 2, 16, 0.01, 1e-5),
)


def environment(repeat: int) -> Array:
    """One of Blender's own environments, 1024x512, each texel repeated along both axes."""
    package = importlib.util.find_spec("bpy")
    if package is None or package.origin is None:
        raise SystemExit("The environments are those of the bpy module, which is not installed.")
    folders = Path(package.origin).parent.glob("*/datafiles/studiolights/world")
    radiance = read_environment(next(folders) / f"{ENVIRONMENT}.exr").radiance
    return np.repeat(np.repeat(radiance, repeat, axis=0), repeat, axis=1)


def directions_of(name: str, size: int) -> Array:
    """Directions of all texels of a map."""
    return representation(name).texel_directions(size)


def filtered(radiance: Array, lobes: list[ZonalLobe], directions: Array, tolerance: float) -> Prefiltered:
    """The whole of the work: expand, analyse, filter."""
    series = [expand(lobe, tolerance) for lobe in lobes]
    return prefilter(analyse_environment(radiance, analysis_degree(series)), series, directions)


def cpu_seconds(work: Callable[[], object]) -> float:
    """CPU time of all threads."""
    start = time.process_time()
    work()
    return time.process_time() - start


def measure_time(stack: Stack) -> dict[str, float]:
    """CPU seconds and the process's largest memory [MiB], with the environment in it."""
    radiance, directions = environment(stack.repeat), directions_of("dual_paraboloid", 128)
    lobes = [ggx_lobe(alpha) for alpha in np.geomspace(stack.narrowest, 0.5, stack.slices)]
    seconds = cpu_seconds(lambda: filtered(radiance, lobes, directions, stack.tolerance))
    return {
        "seconds": seconds,
        "memory": resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024,
    }


def measure_errors(stack: Stack) -> dict[str, float]:
    """Errors over the slices: the worst of each kind."""
    radiance, directions = environment(stack.repeat), directions_of("dual_paraboloid", 128)
    lobes = [ggx_lobe(alpha) for alpha in np.geomspace(stack.narrowest, 0.5, stack.slices)]
    found = filtered(radiance, lobes, directions, stack.tolerance)
    exact = filtered(radiance, lobes, directions, REFERENCE).radiance
    error = np.abs(found.radiance - exact)
    pixels = tuple(range(1, error.ndim))
    # Brute force in a few directions and of a few lobes, spread evenly, tells its time for all.
    nth = 2 * 128 * 128 // BRUTE_DIRECTIONS
    start = time.process_time()
    brute = prefilter_exact(
        radiance, lobes[:: stack.slices // BRUTE_LOBES], directions.reshape(-1, 3)[nth // 2 :: nth]
    )
    brute_seconds = (time.process_time() - start) * nth * stack.slices / BRUTE_LOBES
    there = exact.reshape(len(lobes), -1, 3)[:: stack.slices // BRUTE_LOBES, nth // 2 :: nth]
    ratio = found.bound / error.max(axis=pixels[:-1])
    return {
        "rms": float(np.max(np.sqrt((error**2).mean(axis=pixels) / (exact**2).mean(axis=pixels)))),
        "peak": float(np.max(error.max(axis=pixels) / exact.max(axis=pixels))),
        "negative": int(np.count_nonzero(found.radiance < 0.0)),
        "least_ratio": float(ratio.min()),
        "largest_ratio": float(ratio.max()),
        "brute_seconds": brute_seconds,
        "reference": float(np.max(np.abs(there - brute)) / brute.max()),
    }


def measure_others() -> dict[str, float]:
    """Whatever is no stack of slices."""
    radiance = environment(1)
    normals = np.random.default_rng(1).normal(size=(36 * 72, 3))
    return {
        "nine_seconds": statistics.median(
            cpu_seconds(lambda: analyse_environment(radiance, 2).real(2)) for _ in range(RUNS)
        ),
        "diffuse_seconds": cpu_seconds(lambda: irradiance_exact(radiance, normals)),
    }


def apart(name: str, *arguments: object) -> dict[str, float]:
    """Run one of the measurements in a process of its own."""
    command = [sys.executable, __file__, name, json.dumps(arguments)]
    process = subprocess.run(command, capture_output=True, text=True, check=False)
    if process.returncode != 0:
        raise SystemExit(process.stderr)
    return json.loads(process.stdout)


def main() -> None:
    """Print the tables, and write them into docs/prefiltering.md."""
    lines = [
        "| work | CPU s | brute force / ours | MiB | rel. RMSE | max / peak | bound / seen | < 0 | asked |",
        "|---|---|---|---|---|---|---|---|---|",
    ]
    reference = 0.0
    for stack in STACKS:
        runs = [apart("measure_time", asdict(stack)) for _ in range(RUNS)]
        seconds = statistics.median(run["seconds"] for run in runs)
        seen = apart("measure_errors", asdict(stack))
        reference = max(reference, seen["reference"])
        lines.append(
            f"| {stack.what} | {seconds:.2f} | {seen['brute_seconds'] / seconds:,.0f} "
            f"| {max(run['memory'] for run in runs):.0f} | {seen['rms']:.1e} | {seen['peak']:.1e} "
            f"| {seen['least_ratio']:.1f}-{seen['largest_ratio']:.1f} | {seen['negative']:.0f} "
            f"| {stack.target} |"
        )
    seen = apart("measure_others")
    lines += [
        f"\nThe reference differs from brute force by {reference:.0e} of the peak.\n",
        "| work | seen | asked |",
        "|---|---|---|",
        f"| nine coefficients of 1024x512 | {seen['nine_seconds']:.3f} s | 0.1 s |",
        f"| exact diffuse table 36x72 of 1024x512 | {seen['diffuse_seconds']:.2f} s | |",
    ]
    table = "\n".join(lines)
    print(table)
    write_table("prefiltering.md", "prefiltering", table)


if __name__ == "__main__":
    if len(sys.argv) == 1:
        main()
    else:
        _, name, arguments = sys.argv
        stacks = [Stack(**values) for values in json.loads(arguments)]
        print(json.dumps(globals()[name](*stacks)))
