"""How good fits are: the tables and plots of docs/lobes.md.

bench_fits.py [SPEC ...] fits these models too. bench_fits.py --errors prints E of the fits that were once
different on every processor, as JSON.
"""

import json
import os
import subprocess
import sys
import time
from collections.abc import Callable
from functools import partial
from pathlib import Path

import numpy as np
from docs_table import write_table
from rsibr.rsibr_addon.core.lobes.accuracy import fit_errors
from rsibr.rsibr_addon.core.lobes.fit import Fit
from rsibr.rsibr_addon.core.lobes.joint import JointFitter
from rsibr.rsibr_addon.core.lobes.kautz_mccool import greedy_errors, greedy_fit, single_2d_fit, single_fit
from rsibr.rsibr_addon.core.lobes.layers import layered_fit
from rsibr.rsibr_addon.core.lobes.seeking import SEEKING
from rsibr.rsibr_addon.core.lobes.target import elevation_slices, target_slices
from rsibr.rsibr_addon.core.progress import drain
from rsibr.rsibr_addon.files.brdfs import brdf_from_spec
from rsibr.rsibr_addon.files.plots import Curve, line_plot
from rsibr.rsibr_addon.tasks.reflectance.fit_plots import lobe_plot

COPPER = "ggx:alpha=0.3,eta=0.2/0.924/1.102,k=3.912/2.452/2.142"
WARD = "ward:alpha=0.04,ks=0.8"
MODELS = ("ggx:alpha=0.1,f0=0.04", "car_paint:name=blue")
MU = elevation_slices(16)
BETWEEN = np.arange(1, 16) / 16.0
IMAGES = Path(__file__).parents[1] / "docs" / "images"
HEAD = "| fit | E | grazing | between | albedo error | amplification | s |\n|---|---|---|---|---|---|---|\n"


def joint(spec: str, lobes: int, taps: int = 1, non_negative: bool = False) -> Fit:
    """Fit a model of one layer."""
    fitter = JointFitter(target_slices(brdf_from_spec(spec), MU), spec, non_negative)
    for _ in range(lobes):
        fitter.grow()
    return fitter.fit(taps)[0]


def layered(spec: str) -> Fit:
    """Fit a model layer by layer."""
    return drain(layered_fit(brdf_from_spec(spec), MU, 3))


def row(name: str, spec: str, make: Callable[[], Fit]) -> str:
    """Fit, and say how well, as a row of a table."""
    started = time.process_time()
    fit = make()
    seconds = time.process_time() - started
    brdf = brdf_from_spec(spec)
    errors, between = fit_errors(fit, brdf), fit_errors(fit, brdf, BETWEEN)
    # What interpolation adds: over the mean of both neighbours
    added = np.max(between.shape - 0.5 * (errors.shape[1:] + errors.shape[:-1]))
    cells = (
        name,
        f"{errors.error:.3f}",
        f"{errors.grazing_error:.3f}",
        f"{added:+.4f}",
        f"{errors.albedo_error:.0e}",
        f"{errors.amplification.max():.1f}",
        f"{seconds:.1f}",
    )
    line = f"| {' | '.join(cells)} |\n"
    print(line, end="", flush=True)
    return line


def methods(spec: str) -> str:
    """Every method on one model, as a table."""
    brdf = brdf_from_spec(spec)
    fits: dict[str, Callable[[], Fit]] = {
        **{f"joint, {lobes}": partial(joint, spec, lobes) for lobes in range(1, 6)},
        "joint, 3, not negative": partial(joint, spec, 3, non_negative=True),
        "joint, 1 with 5 taps": partial(joint, spec, 1, 5),
        "joint, 2 with 3 taps": partial(joint, spec, 2, 3),
        "single": partial(single_fit, brdf, spec, MU),
        "single 2D": partial(single_2d_fit, brdf, spec, MU),
        **{f"greedy, 3, {name}": partial(greedy_fit, brdf, spec, MU, 3, SEEKING[name]) for name in SEEKING},
    }
    return HEAD + "".join(row(name, spec, fit) for name, fit in fits.items())


def tapped() -> dict[str, Callable[[], Fit]]:
    """The fits with taps, whose start is hardest to choose."""
    return {
        "copper, 1 with 5 taps": partial(joint, COPPER, 1, 5),
        "copper, 2 with 3 taps": partial(joint, COPPER, 2, 3),
        "Ward, 1 with 5 taps": partial(joint, WARD, 1, 5),
        "Ward, 2 with 3 taps": partial(joint, WARD, 2, 3),
        **{spec: partial(layered, spec) for spec in MODELS},
    }


def errors_here() -> list[str]:
    """E of `tapped` on this processor."""
    fits = [make() for make in tapped().values()]
    return [f"{fit_errors(fit, brdf_from_spec(fit.brdf)).error:.5f}" for fit in fits]


def processors() -> str:
    """The least and the greatest E of `tapped` under OpenBLAS's kernels, as a table."""
    errors = []
    for kernel in ("default", "Prescott", "Nehalem", "Sandybridge", "Haswell", "Zen"):
        setting = {} if kernel == "default" else {"OPENBLAS_CORETYPE": kernel}
        command = [sys.executable, __file__, "--errors"]
        run = subprocess.run(command, env=os.environ | setting, capture_output=True, check=True)
        errors.append(json.loads(run.stdout))
    rows = zip(tapped(), zip(*errors, strict=True), strict=True)
    table = "| fit | least E | greatest E |\n|---|---|---|\n"
    return table + "".join(f"| {name} | {min(found)} | {max(found)} |\n" for name, found in rows)


def main() -> None:
    """Make all tables and plots."""
    if sys.argv[1:] == ["--errors"]:
        print(json.dumps(errors_here()))
        return
    write_table("lobes.md", "processors", processors())
    write_table("lobes.md", "copper", methods(COPPER))
    write_table("lobes.md", "ward", methods(WARD))
    models = [row(spec.rpartition("/")[2], spec, partial(layered, spec)) for spec in (*MODELS, *sys.argv[1:])]
    write_table("lobes.md", "models", HEAD + "".join(models))
    ward, lobes = brdf_from_spec(WARD), np.arange(1.0, 15.0)
    curves = [
        Curve(name, lobes, greedy_errors(ward, MU[4:], 14, np.linspace(0.0, np.pi, 121), clamped))
        for name, clamped in (("unclamped", False), ("clamped", True))
    ]
    head = f"| lobes | {' | '.join(f'{count:.0f}' for count in lobes)} |\n|{15 * '---|'}\n"
    rows = [f"| {curve.name} | {' | '.join(f'{error:.3f}' for error in curve.y)} |\n" for curve in curves]
    write_table("lobes.md", "greedy", head + "".join(rows))
    title = "Ward, alpha 0.04: minimum profiles as in Kautz & McCool 2000"
    plot = line_plot(title, "lobes", (0.0, 14.0), "E", curves)
    (IMAGES / "lobes-greedy.svg").write_text(plot, encoding="utf-8")
    plot = lobe_plot(joint(COPPER, 3), brdf_from_spec(COPPER), 0.35)
    (IMAGES / "lobes-copper.svg").write_text(plot, encoding="utf-8")


if __name__ == "__main__":
    main()
