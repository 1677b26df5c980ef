"""Show objects over their world by RSIBR and by Cycles, over it blurred, and over a picture, on a floor.

Writes docs/images/render-matte.jpg.
"""

import tempfile
from pathlib import Path

import bpy
import numpy as np
from mathutils import Vector
from rsibr.rsibr_addon.files.pictures import write_exr
from show_materials import save_jpeg
from show_render import arguments, build, by_both, rendered


def add_floor(scene: bpy.types.Scene) -> None:
    """A floor below all objects."""
    corners = [item.matrix_world @ Vector(corner) for item in scene.objects for corner in item.bound_box]
    bpy.ops.mesh.primitive_plane_add(size=40.0, location=(0.0, 0.0, min(corner.z for corner in corners)))
    bpy.context.object.is_shadow_catcher = True


def write_photograph(path: Path) -> None:
    """A wall and a table, as a camera may have taken them."""
    rows, columns = np.mgrid[:280, :560] / 280.0
    wall = np.stack([0.30 + 0.10 * rows, 0.34 + 0.08 * rows, 0.38 + 0.06 * rows], axis=-1)
    grain = 0.9 + 0.1 * np.sin(80.0 * columns / (1.2 - rows))
    wood = grain[..., None] * (0.42, 0.30, 0.20)
    seen = np.where((rows < 0.45)[..., None], wood, wall)
    write_exr(path, np.concatenate([seen, np.ones_like(seen[..., :1])], axis=-1).astype(np.float32))


def main() -> None:
    """Render all, and write the picture."""
    chosen = arguments(__doc__, samples=16, width=400, image="render-matte.jpg")
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        scene = build(folder)
        add_floor(scene)
        plain, truth = by_both(scene, chosen, folder)
        options = scene.rsibr_render
        options.background_blur, options.background_exposure = 6.0, -0.5
        blurred = rendered(scene, "RSIBR", chosen.samples, folder / "blurred.exr")
        write_photograph(folder / "photograph.exr")
        options.background, options.background_exposure = str(folder / "photograph.exr"), 1.0
        pictured = rendered(scene, "RSIBR", chosen.samples, folder / "pictured.exr")
    rows = [np.concatenate(pair, axis=1) for pair in ((blurred, pictured), (plain, truth))]
    save_jpeg(chosen.image, 0.9 / np.percentile(truth, 95.0) * np.concatenate(rows))


if __name__ == "__main__":
    main()
