"""Show objects at sunset, by RSIBR left of a line and by Cycles right of it; writes docs/images/sunset.jpg.

The floor is a shadow catcher, of which objects get no light.
"""

import argparse
import tempfile
from pathlib import Path

import bpy
import numpy as np
from material_objects import ball, cushion, ring, suzanne, vase
from mathutils import Vector
from rsibr.rsibr_addon.core.conventions import Array
from show_materials import save_jpeg
from show_render import Places, arguments, look, placed, rendered

PLACES: Places = {
    ring: (-2.3, 0.4, 0.0),
    ball: (-1.15, 1.0, 0.1),
    suzanne: (0.0, -0.4, 0.0),
    vase: (1.2, 0.5, -0.05),
    cushion: (2.45, 0.2, -0.3),
}
"""Suzanne is on the line."""

FLOOR = -0.9
"""Height of the floor."""

EXPOSURE = 1.25


def build(folder: Path) -> bpy.types.Scene:
    """The scene, saved in a folder."""
    scene = placed(PLACES, "sunset", folder)
    look(scene, Vector((0.0, -8.0, 1.1)), Vector((0.05, 0.0, 0.05)))
    bpy.ops.mesh.primitive_plane_add(size=40.0, location=(0.0, 0.0, FLOOR))
    floor = bpy.context.object
    floor.is_shadow_catcher, floor.visible_diffuse, floor.visible_glossy = True, False, False
    return scene


def halves(scene: bpy.types.Scene, chosen: argparse.Namespace, folder: Path) -> Array:
    """The scene by RSIBR on the left, and by Cycles on the right of a line."""
    render = scene.render
    render.resolution_x, render.resolution_y = chosen.width, int(0.42 * chosen.width)
    render.use_border = True
    render.border_min_x, render.border_max_x, render.border_min_y, render.border_max_y = 0.0, 0.5, 0.0, 1.0
    ours = rendered(scene, "RSIBR", chosen.samples, folder / "RSIBR.exr")
    render.border_min_x, render.border_max_x = 0.5, 1.0
    truth = rendered(scene, "CYCLES", chosen.samples, folder / "CYCLES.exr")
    middle = chosen.width // 2
    picture = np.concatenate([ours[:, :middle], truth[:, middle:]], axis=1)
    picture[:, middle - 1 : middle + 1] = 1.0 / EXPOSURE
    return picture


def main() -> None:
    """Render both, and write the picture."""
    chosen = arguments(__doc__, samples=24, width=900, image="sunset.jpg")
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        save_jpeg(chosen.image, EXPOSURE * halves(build(folder), chosen, folder))


if __name__ == "__main__":
    main()
