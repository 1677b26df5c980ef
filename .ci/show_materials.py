"""Show objects with materials of their own beside Cycles and the split sum: a sheet, and a table of errors.

Writes docs/images/materials-ENVIRONMENT.jpg, and the table of objects in docs/materials.md.
"""

import argparse
import tempfile
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path

import bpy
import numpy as np
from docs_table import DOCS, write_table
from material_objects import SHOWN, SPHERES, suzanne
from material_studio import Light, Studio, error, start
from rsibr.rsibr_addon.core.conventions import Array
from rsibr.rsibr_addon.host.scenes import temporary_scene
from rsibr.rsibr_addon.tasks.light.environments import load_environment

BRIGHT = 99.0
"""Percentage of a picture's values below what is shown as .9 of white."""

GRAY, MAGNIFIED = 0.214, 2.0
"""What no difference looks like, and how differences are magnified."""


@dataclass(frozen=True)
class Seen:
    """Pictures of an object, shape (size, size, 4); of Cycles two each, with and without its own shadows."""

    name: str
    ours: Array
    split: Array
    alone: list[Array]
    shadowed: list[Array]

    def row(self, environment: str) -> str:
        """Line of the table."""
        ours, split = error(self.ours, self.alone), error(self.split, self.alone)
        ratio = f" ({split / ours:.1f}x)" if ours > 0.0 else ""
        shadows = apart(self.alone, self.shadowed)
        own, other = (f"{each:.1%}" if each > 0.0 else "below the noise" for each in (ours, split))
        return f"| {self.name} | {environment} | {own} | {other}{ratio} | {shadows:.1%} |"

    def strip(self) -> Array:
        """Ours, Cycles, the split sum, and what both differ from Cycles by, side by side."""
        truth = 0.5 * (self.alone[0] + self.alone[1])
        scale = 0.9 / np.percentile(truth[truth[..., 3] > 0.0][:, :3], BRIGHT)
        shown = [np.clip(each, 0.0, None) for each in (self.ours, truth, self.split)]
        lit = [scale * each[..., :3] + 1.0 - each[..., 3:] for each in shown]
        differences = [GRAY + MAGNIFIED * scale * (each - truth)[..., :3] for each in (self.ours, self.split)]
        strip: Array = np.concatenate([*lit, *differences], axis=1)
        return strip


def apart(first: list[Array], second: list[Array]) -> float:
    """Relative root-mean-square difference of what was rendered twice, without the noise of renders."""
    (a, b), (c, d) = ([each[..., :3] for each in pictures] for pictures in (first, second))
    return float(np.sqrt(max(np.sum((a - c) * (b - d)) / np.sum(c * d), 0.0)))


def pictures(
    studio: Studio, makers: Iterable[Callable[[], bpy.types.Object]], samples: int
) -> Iterator[Seen]:
    """Objects, one after the other."""
    for make in makers:
        item = make()
        ours, split = studio.ours(item), studio.ours(item, split=True)
        alone, shadowed = (
            [studio.cycles(item, samples, seed, shadows) for seed in (1, 2)] for shadows in (False, True)
        )
        yield Seen(item.name, ours, split, alone, shadowed)
        bpy.data.objects.remove(item)


def save_jpeg(path: Path, rgb: Array) -> None:
    """Write linear colours as a small picture, row 0 at the bottom."""
    with temporary_scene() as scene:
        scene.view_settings.view_transform = "Standard"
        settings = scene.render.image_settings
        settings.file_format, settings.quality = "JPEG", 85
        image = bpy.data.images.new(path.name, *rgb.shape[1::-1], float_buffer=True)
        image.pixels.foreach_set(np.dstack([rgb, np.ones(rgb.shape[:2])]).astype(np.float32).ravel())
        image.save_render(str(path), scene=scene)


def main() -> None:
    """Draw the sheets, and print and write the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument(
        "--environments", nargs="*", default=["forest", "city"], help="all objects in the first"
    )
    parser.add_argument("--samples", type=int, default=64)
    parser.add_argument("--size", type=int, default=120)
    parser.add_argument("--images", type=Path, default=DOCS / "images")
    chosen = parser.parse_args()
    view = start()
    lines = ["| object | environment | ours | split sum | its own shadows |", "|---|---|---:|---:|---:|"]
    for name in chosen.environments:
        shown = SHOWN if name == chosen.environments[0] else (suzanne,)
        with tempfile.TemporaryDirectory() as folder:
            studio = Studio(view, Light(load_environment(name), Path(folder)), chosen.size)
            strips = []
            for seen in pictures(studio, (*SPHERES, *shown), chosen.samples):
                lines.append(seen.row(name))
                print(lines[-1], flush=True)
                strips.append(seen.strip())
        save_jpeg(chosen.images / f"materials-{name}.jpg", np.concatenate(strips[::-1]))
    write_table("materials.md", "objects", "\n".join(lines))


if __name__ == "__main__":
    main()
