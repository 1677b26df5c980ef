"""Measure how time and memory of filtering grow: with the environment, the degree, slices, lobes and texels.

Each measurement runs in a process of its own. Prints a Markdown table and writes it into docs/performance.md,
beside two plots. This module imports nothing large, because a process starts with the peak memory of its
parent.
"""

import json
import math
import subprocess
import sys
import time
from collections.abc import Callable
from dataclasses import dataclass

from docs_table import DOCS, write_table

RUNS = 3

Work = Callable[[], object]


@dataclass(frozen=True)
class Axis:
    """Something that grows.

    Attributes
    ----------
    what : str
    sizes : tuple of int
        Each twice the one before.
    counted : int
        Power of a size that the work is counted in: 2 for the width of a map.
    demanded : int
        Power of the count with which the method's time grows at most.
    work : str
        Name of the function that gives the work from a size.
    """

    what: str
    sizes: tuple[int, ...]
    counted: int
    demanded: int
    work: str


AXES = (
    Axis("texels of the environment", (512, 1024, 2048, 4096, 8192), 2, 1, "of_width"),
    Axis("degree", (125, 250, 500, 1000, 2000), 1, 3, "of_degree"),
    Axis("slices of a stack", (4, 8, 16, 32, 64), 1, 1, "of_slices"),
    Axis("lobes of a stack", (1, 2, 4, 8, 16), 1, 1, "of_lobes"),
    Axis("texels of a map", (64, 128, 256, 512, 1024), 2, 1, "of_texels"),
)


def filtering(width: int, degree: int, size: int) -> Work:
    """Analysis of an environment, and synthesis on the faces of a cube."""
    import numpy as np
    from rsibr.rsibr_addon.core.filtering.harmonics.analysis import analyse_environment
    from rsibr.rsibr_addon.core.filtering.prefilter import prefilter
    from rsibr.rsibr_addon.core.filtering.radial_lobes import ggx_lobe
    from rsibr.rsibr_addon.core.filtering.zonal import ZonalSeries
    from rsibr.rsibr_addon.core.maps.representation import representation

    radiance = np.random.default_rng(1).random((width // 2, width, 3), np.float32)
    series = ZonalSeries(ggx_lobe(0.5), 1e-12, np.ones(degree + 1), np.pi, signed=False)
    directions = representation("cube_map").texel_directions(size)
    return lambda: prefilter(analyse_environment(radiance, degree), [series], directions)


def of_width(width: int) -> Work:
    """An environment, to degree 200 and 6x64x64 texels."""
    return filtering(width, 200, 64)


def of_degree(degree: int) -> Work:
    """A degree, from 1024x512 to 6x64x64 texels."""
    return filtering(1024, degree, 64)


def of_texels(size: int) -> Work:
    """A map, from 1024x512 by degree 200."""
    return filtering(1024, 200, size)


def stack(lobes: int, slices: int) -> Work:
    """A stack of maps of 64x64, each a sum of eight kernels' maps, from 1024x512."""
    import numpy as np
    from rsibr.rsibr_addon.core.kinds.lobe_stack.stack import LAYOUTS
    from rsibr.rsibr_addon.core.lobes.bake import bake_stack
    from rsibr.rsibr_addon.core.lobes.bank import octaves
    from rsibr.rsibr_addon.core.lobes.fit import Fit
    from rsibr.rsibr_addon.core.progress import drain

    rng = np.random.default_rng(1)
    radiance = rng.random((512, 1024, 3), np.float32)
    bank = octaves(512.0)
    fit = Fit(
        brdf="",
        method="",
        mu=(np.arange(slices) + 1.0) / slices,
        bank=bank,
        weights=rng.random((lobes, slices, len(bank), 3)),
        scale=np.ones((lobes, slices, 3)),
        offsets=np.zeros((lobes, slices, 1, 2)),
        taps=np.ones((lobes, slices, 1)),
    )
    return lambda: drain(bake_stack(radiance, fit, next(iter(LAYOUTS)), 64)).stack


def of_slices(slices: int) -> Work:
    """Slices of a stack of three lobes."""
    return stack(3, slices)


def of_lobes(lobes: int) -> Work:
    """Lobes of a stack of 16 slices."""
    return stack(lobes, 16)


def resident(what: str) -> float:
    """Memory of this process [MiB]: VmRSS, what it has, or VmHWM, the most that it had."""
    with open("/proc/self/status", encoding="ascii") as status:
        return next(int(line.split()[1]) / 1024 for line in status if line.startswith(what))


def measure(work: Work) -> tuple[float, float]:
    """CPU seconds of all threads, the least of some runs, and the memory [MiB] that they add."""
    before = resident("VmRSS")
    with open("/proc/self/clear_refs", "w", encoding="ascii") as forget:
        forget.write("5")  # Linux: the most is now what there is
    seconds = []
    for _ in range(RUNS):
        start = time.process_time()
        work()
        seconds.append(time.process_time() - start)
    return min(seconds), resident("VmHWM") - before


def apart(axis: Axis, size: int) -> tuple[float, float]:
    """`measure` in a process of its own."""
    command = [sys.executable, __file__, axis.work, str(size)]
    process = subprocess.run(command, capture_output=True, text=True, check=False)
    if process.returncode != 0:
        raise SystemExit(process.stderr)
    seconds, memory = json.loads(process.stdout)
    return seconds, memory


def power(axis: Axis, values: list[float]) -> float:
    """The power of the count with which values grow, over the last two doublings of the size."""
    return math.log2(values[-1] / values[-3]) / (2.0 * axis.counted)


def plot(name: str, title: str, measured: dict[Axis, list[float]]) -> None:
    """Draw doublings over doublings of the count: a curve's slope is its power."""
    import numpy as np
    from rsibr.rsibr_addon.files.plots import Curve, line_plot

    curves = [
        Curve(axis.what, axis.counted * np.arange(len(values)), np.log2(np.divide(values, values[0])))
        for axis, values in measured.items()
    ]
    # As wide again, for the names
    drawn = line_plot(title, "doublings of the number", (0.0, 15.0), "doublings", curves)
    (DOCS / "images" / name).write_text(drawn, encoding="utf-8")


def main() -> None:
    """Measure, print the table, write it into the docs and draw the plots."""
    times, memories, lines = {}, {}, []
    for axis in AXES:
        found = [apart(axis, size) for size in axis.sizes]
        times[axis], memories[axis] = ([values[i] for values in found] for i in (0, 1))
        sizes = f"{axis.sizes[0]} to {axis.sizes[-1]}" + " wide" * (axis.counted == 2)
        lines.append(
            f"| {axis.what}, {sizes} | {', '.join(f'{t:.3f}' for t in times[axis])} s "
            f"| {power(axis, times[axis]):.1f} | {axis.demanded} "
            f"| {', '.join(f'{m:.0f}' for m in memories[axis])} MiB |"
        )
        print(lines[-1], flush=True)
    head = ["| what doubles | CPU | last power | demanded | memory |", "|---|---|---|---|---|"]
    write_table("performance.md", "growth", "\n".join(head + lines))
    plot("growth-time.svg", "CPU time of filtering", times)
    plot("growth-memory.svg", "Memory of filtering", memories)


if __name__ == "__main__":
    if len(sys.argv) == 1:
        main()
    else:
        _, name, size = sys.argv
        print(json.dumps(measure(globals()[name](int(size)))))
