"""Show a scene as F12 renders it by RSIBR, above, and by Cycles; writes docs/images/render.jpg.

Suzanne is shaded from the demo's copper of three lobes, the others in their own materials by the world.
"""

import argparse
import tempfile
import warnings
from collections.abc import Callable
from pathlib import Path

import bpy
import numpy as np
import rsibr
from docs_table import DOCS
from material_objects import Material, ball, cushion, ring, suzanne, vase
from mathutils import Vector
from rsibr.rsibr_addon.core.conventions import Array
from rsibr.rsibr_addon.core.errors import RsibrWarning
from rsibr.rsibr_addon.core.progress import drain
from rsibr.rsibr_addon.files.pictures import read_exr
from rsibr.rsibr_addon.host.installation import studio_environments
from rsibr.rsibr_addon.job import BakeJob
from rsibr.rsibr_addon.settings.light import Light
from rsibr.rsibr_addon.settings.lobe_stack import LobeStackSettings
from rsibr.rsibr_addon.tasks.methods.bake import bake
from show_materials import save_jpeg

ALPHA = 0.3
COPPER = (0.955, 0.638, 0.538)

Places = dict[Callable[[], bpy.types.Object], tuple[float, float, float]]

PLACES: Places = {
    ring: (-2.1, 0.5, 0.0),
    suzanne: (-0.75, -0.4, 0.0),
    ball: (0.9, 0.9, 0.0),
    vase: (1.3, -0.9, -0.1),
    cushion: (2.7, 0.2, -0.2),
}


def build(folder: Path) -> bpy.types.Scene:
    """The scene, saved in a folder."""
    scene = placed(PLACES, "forest", folder)
    look(scene, Vector((0.3, -8.0, 1.4)), Vector((0.3, 0.0, 0.0)))
    shade_in_copper(bpy.data.objects["Suzanne"], folder)
    return scene


def placed(places: Places, environment: str, folder: Path) -> bpy.types.Scene:
    """A scene of some objects in the light of one of Blender's environments, saved in a folder."""
    warnings.simplefilter("ignore", RsibrWarning)
    bpy.ops.wm.read_factory_settings()
    rsibr.register()
    for item in list(bpy.data.objects):
        bpy.data.objects.remove(item)
    bpy.ops.wm.save_as_mainfile(filepath=str(folder / "scene.blend"))
    scene = bpy.context.scene
    for make, place in places.items():
        make().location = place
    tree = scene.world.node_tree
    texture = tree.nodes.new("ShaderNodeTexEnvironment")
    texture.image = bpy.data.images.load(str(studio_environments()[environment]))
    tree.links.new(texture.outputs["Color"], tree.nodes["Background"].inputs["Color"])
    return scene


def look(scene: bpy.types.Scene, eye: Vector, at: Vector) -> None:
    """Give a scene a camera that looks at a point."""
    scene.camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
    scene.collection.objects.link(scene.camera)
    scene.camera.location = eye
    scene.camera.rotation_euler = (at - eye).to_track_quat("-Z", "Y").to_euler()
    scene.camera.data.lens = 45.0


def shade_in_copper(item: bpy.types.Object, folder: Path) -> None:
    """Shade an object from lobes; for Cycles it is copper as well."""
    path = folder / "lobes.rsibr.exr"
    settings = LobeStackSettings(brdf=f"ggx:alpha={ALPHA},metal=copper", lobes=3)
    drain(bake(BakeJob(settings, str(path), Light(environment="forest"))))
    item.rsibr.map_set = str(path)
    inputs = {"Base Color": COPPER, "Metallic": 1.0, "Roughness": float(np.sqrt(ALPHA))}
    item.data.materials[0] = Material("Copper", inputs).data


def rendered(scene: bpy.types.Scene, engine: str, samples: int, path: Path) -> Array:
    """A picture of the scene by an engine."""
    scene.render.engine, scene.rsibr_render.samples, scene.cycles.samples = engine, 16, samples
    scene.cycles.device, scene.cycles.use_denoising = "CPU", True
    scene.render.image_settings.file_format = "OPEN_EXR"
    scene.render.image_settings.color_depth = "32"
    scene.render.filepath = str(path)
    bpy.ops.render.render(write_still=True)
    picture: Array = read_exr(path)[..., :3]
    return picture


def by_both(scene: bpy.types.Scene, chosen: argparse.Namespace, folder: Path) -> tuple[Array, Array]:
    """Pictures of the scene by RSIBR and by Cycles."""
    scene.render.resolution_x, scene.render.resolution_y = chosen.width, chosen.width // 2
    return (
        rendered(scene, "RSIBR", chosen.samples, folder / "RSIBR.exr"),
        rendered(scene, "CYCLES", chosen.samples, folder / "CYCLES.exr"),
    )


def arguments(description: str | None, samples: int, width: int, image: str) -> argparse.Namespace:
    """What the command line says, or else these values; the image is one of the documentation's."""
    parser = argparse.ArgumentParser(description=description)
    parser.add_argument("--samples", type=int, default=samples)
    parser.add_argument("--width", type=int, default=width)
    parser.add_argument("--image", type=Path, default=DOCS / "images" / image)
    return parser.parse_args()


def main() -> None:
    """Render both, and write the picture."""
    chosen = arguments(__doc__, samples=64, width=560, image="render.jpg")
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        ours, truth = by_both(build(folder), chosen, folder)
    save_jpeg(chosen.image, 0.9 / np.percentile(truth, 95.0) * np.concatenate([truth, ours]))


if __name__ == "__main__":
    main()
