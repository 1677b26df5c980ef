"""Measure what chosen views are worth, for docs/captured-lobes.md.

Lobes are fitted to 4 captured views, to these and 8 that are chosen, and to 12 that are evenly spread. They
show the 42 views of a geodesic sphere. Captures are exact, of 64 texels, in `city` at 512x256. Fits take a
quarter of the texels that the program's take.
"""

import argparse
from dataclasses import replace
from pathlib import Path

import bench_captures
import numpy as np
from bench_captures import CAPTURED, DIRECTIONS, captured, errors_and_powers
from docs_table import write_table
from rsibr.rsibr_addon.core.conventions import Array
from rsibr.rsibr_addon.core.environment import Environment
from rsibr.rsibr_addon.core.kinds.radiance_views.views import RadianceViews
from rsibr.rsibr_addon.core.lobes import captures
from rsibr.rsibr_addon.core.lobes.captured_light import CapturedLight
from rsibr.rsibr_addon.core.lobes.captures import CapturedFit, fit_captures
from rsibr.rsibr_addon.core.lobes.next_views import next_views
from rsibr.rsibr_addon.core.progress import drain
from rsibr.rsibr_addon.tasks.light.environments import load_environment
from rsibr.rsibr_addon.tasks.methods.fit_captures import filtered_light, shipped_families
from rsibr.rsibr_addon.tasks.methods.more_views import AT_ONCE

ENVIRONMENT = "city"
MATERIALS = ("car paint", "coat, alpha .1, over Lambert", "copper, alpha .3", "Ward, alpha .1")
bench_captures.SIZE, bench_captures.RINGS = 64, 192
captures.TEXELS = 6000
FIRST = [0, 3, 5, 10]
"""Views of the icosahedron that are far from each other."""


def reduced(name: str) -> Environment:
    """A built-in environment at half its size."""
    light = load_environment(name)
    height, width = light.radiance.shape[:2]
    quarters = light.radiance.reshape(height // 2, 2, width // 2, 2, 3)
    return replace(light, radiance=quarters.mean(axis=(1, 3), dtype=np.float64).astype(np.float32))


def fitted(views: RadianceViews, numbers: list[int], light: CapturedLight) -> CapturedFit:
    """Lobes fitted to some of the views."""
    maps = views.diffuse[numbers], views.glossy[numbers]
    some = RadianceViews(*maps, views.albedo, view_dirs=DIRECTIONS[numbers])
    return drain(fit_captures(some, light, shipped_families(), "captured"))


def with_chosen(views: RadianceViews, light: CapturedLight, found: CapturedFit) -> list[int]:
    """The first views, and those that are chosen until there are as many as are spread evenly."""
    numbers = list(FIRST)
    while len(numbers) < CAPTURED:
        there = DIRECTIONS[numbers]
        more = next_views(there, views.size, light, found.weighed, min(AT_ONCE, CAPTURED - len(numbers)))
        numbers += np.argmax(more @ DIRECTIONS.T, axis=1).tolist()
        found = fitted(views, numbers, light) if len(numbers) < CAPTURED else found
    return numbers


def errors(views: RadianceViews, light: CapturedLight, found: CapturedFit, uncaptured: list[int]) -> Array:
    """Relative error of all views together, of the worst one in units of their mean, and of some of them."""
    squares, powers = errors_and_powers(found.fit, light, views)
    some = squares[uncaptured].sum() / powers[uncaptured].sum()
    return np.sqrt([squares.sum() / powers.sum(), squares.max() / powers.mean(), some])


def main() -> None:
    """Measure, and write the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=Path, help="where exact views are kept")
    folder = parser.parse_args().folder
    folder.mkdir(exist_ok=True)
    lines = [
        "| material | 4 views: all | 12 even: all | worst | in neither "
        "| 4, 8 chosen: all | worst | in neither |",
        f"|---|{'---:|' * 7}",
    ]
    environment = reduced(ENVIRONMENT)
    light = filtered_light(environment.radiance)
    for material in MATERIALS:
        views = captured(environment, material, folder, DIRECTIONS)
        few = fitted(views, FIRST, light)
        even, chosen = list(range(CAPTURED)), with_chosen(views, light, few)
        neither = sorted({*range(len(DIRECTIONS))} - {*even, *chosen})
        figures = [errors(views, light, few, neither)[0]]
        for numbers in (even, chosen):
            figures.extend(errors(views, light, fitted(views, numbers, light), neither))
        lines.append(f"| {material} | {' | '.join(f'{figure:.1%}' for figure in figures)} |")
        print(lines[-1], flush=True)
    write_table("captured-lobes.md", "next views", "\n".join(lines))


if __name__ == "__main__":
    main()
