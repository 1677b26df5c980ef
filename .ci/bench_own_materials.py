"""Measure what edits of own materials cost, a frame of many triangles, memory, and many materials at once.

Previews are drawn without a window, by Mesa's software driver where there is no other. Times are those of the
processor; what an edit costs is without the draw that it asks for.
"""

import resource
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

import bpy
import made_textures as made
import numpy as np
from docs_table import write_table
from material_objects import GOLD, Material, textured_sphere
from material_studio import Light, draw, framed, start
from rsibr.rsibr_addon.core.at_once import AtOnce
from rsibr.rsibr_addon.core.conventions import Array
from rsibr.rsibr_addon.core.kinds.kernel_pyramid.bake import bake_pyramid
from rsibr.rsibr_addon.core.progress import drain
from rsibr.rsibr_addon.host.map_sets import use_map_set
from rsibr.rsibr_addon.host.visible_surfaces import View
from rsibr.rsibr_addon.settings.kernel_pyramid import KernelPyramidSettings
from rsibr.rsibr_addon.tasks.light.environments import load_environment
from rsibr.rsibr_addon.tasks.methods.live_materials import LiveFits
from rsibr.rsibr_addon.tasks.viewport.previews import Previews

RSIBR = Path(sys.executable).with_name("rsibr")
STACK = ["bake", "--environment", "forest", "--brdf", "ggx:alpha=0.3,metal=copper", "--lobes", "3"]

SUNSET = ["bake", "kernel-pyramid", "--environment", "sunset"]

SMALL, LARGE = 32, 512
"""Widths of pictures where a draw is to cost nothing, and where it is what costs."""

TRIES = 5
OBJECTS = 20

HALF_BYTES, FLOAT_BYTES = 8, 16
"""Of a texel."""


class Window:
    """A viewport's frames."""

    def __init__(self, view: View, width: int) -> None:
        self._view, self._width = view, width
        self.previews = Previews(LiveFits(), AtOnce())

    def frame(self, edit: Callable[[], None] | None = None) -> tuple[float, float]:
        """Draw one, after an edit: seconds of the process, and of the thread that draws."""
        with framed(self._width) as target:
            target.read_color(0, 0, 1, 1, 4, 0, "FLOAT")
            process, thread = time.process_time(), time.thread_time()
            if edit:
                edit()
                bpy.context.view_layer.update()
                self.previews.scene_changed()
            draw(self.previews, self._view)
            thread = time.thread_time() - thread
            target.read_color(0, 0, 1, 1, 4, 0, "FLOAT")
            return time.process_time() - process, thread

    def median(self, edit: Callable[[int], None] | None = None) -> float:
        """Processor seconds of a frame, after one like it."""
        edits = [(lambda number=number: edit(number)) if edit else None for number in range(TRIES + 1)]
        return float(np.median([self.frame(each)[0] for each in edits][1:]))

    def messages(self, item: bpy.types.Object) -> list[str]:
        """What went wrong."""
        return self.previews.messages(item)


def sphere() -> bpy.types.Object:
    """A sphere of 101,760 triangles, in a material of four images."""
    bpy.ops.mesh.primitive_uv_sphere_add(segments=320, ring_count=160)
    return dressed_in_images(bpy.context.object)


def suzanne() -> bpy.types.Object:
    """Suzanne, smooth, in a coated material of four images."""
    bpy.ops.mesh.primitive_monkey_add()
    item = bpy.context.object
    item.modifiers.new("Subdivision", "SUBSURF").levels = 2
    coat_over(dressed_in_images(item), 0.5)
    return item


def dressed_in_images(item: bpy.types.Object) -> bpy.types.Object:
    """An object, smooth and in a material of four images."""
    dressed = textured_sphere()
    item.data.shade_smooth()
    item.data.materials.append(dressed.data.materials[0])
    bpy.data.objects.remove(dressed)
    return item


def coat_over(item: bpy.types.Object, weight: float) -> None:
    """Give an object's material a coat."""
    nodes = item.data.materials[0].node_tree.nodes
    (principled,) = (each for each in nodes if each.type == "BSDF_PRINCIPLED")
    principled.inputs["Coat Weight"].default_value = weight


def turning_world() -> bpy.types.Node:
    """Give the scene a world whose environment turns; returns its Mapping."""
    world = bpy.context.scene.world
    nodes, links = world.node_tree.nodes, world.node_tree.links
    texture, place, coordinates = (
        nodes.new(f"ShaderNode{kind}") for kind in ("TexEnvironment", "Mapping", "TexCoord")
    )
    (background,) = (each for each in nodes if each.type == "BACKGROUND")
    texture.image = bpy.data.images.new("world", 8, 4, float_buffer=True)
    links.new(coordinates.outputs["Generated"], place.inputs["Vector"])
    links.new(place.outputs["Vector"], texture.inputs["Vector"])
    links.new(texture.outputs["Color"], background.inputs["Color"])
    return place


def edits(item: bpy.types.Object) -> dict[str, Callable[[int], None]]:
    """What an artist changes -> how; the number makes each change another."""
    nodes = item.data.materials[0].node_tree.nodes
    (principled,) = (each for each in nodes if each.type == "BSDF_PRINCIPLED")
    image = next(each.image for each in nodes if each.type == "TEX_IMAGE")
    place = turning_world()
    pixels = np.array(image.pixels[:], np.float32)

    def slider(number: int) -> None:
        coat_over(item, 0.1 * number)

    def color(number: int) -> None:
        principled.inputs["Specular Tint"].default_value = (1.0, 0.1 * number, 1.0, 1.0)

    def texture(number: int) -> None:
        image.pixels.foreach_set(pixels * (1.0 - 0.1 * number))
        image.update()

    def turn(number: int) -> None:
        place.inputs["Rotation"].default_value = (0.0, 0.0, 0.1 * number)

    return {
        "a slider": slider,
        "a color": color,
        f"a texture of {image.size[0]}x{image.size[1]}, painted": texture,
        "the world's rotation": turn,
    }


def many(path: str) -> list[bpy.types.Object]:
    """Objects, each of a material with two images of its own."""
    bpy.ops.mesh.primitive_uv_sphere_add(segments=64, ring_count=32)
    first = bpy.context.object
    items = []
    for number in range(OBJECTS):
        item = bpy.data.objects.new(f"Object {number}", first.data.copy())
        bpy.context.scene.collection.objects.link(item)
        waves: Array = made.noise(number, 4.0)
        inputs = {"Base Color": made.mixed(waves, (0.1, 0.1, 0.3), GOLD), "Roughness": 0.2 + 0.6 * waves}
        item.data.materials.append(Material(f"Material {number}", inputs).data)
        item.location = (0.3 * (number % 5 - 2), 0.0, 0.3 * (number // 5 - 1.5))
        item.scale = (0.14, 0.14, 0.14)
        use_map_set(item.rsibr, path)
        items.append(item)
    bpy.data.objects.remove(first)
    return items


def processes() -> float:
    """Processor seconds of this process, and of those that it has waited for."""
    children = resource.getrusage(resource.RUSAGE_CHILDREN)
    return time.process_time() + children.ru_utime + children.ru_stime


def first_preview(view: View, folder: Path) -> tuple[float, float]:
    """Seconds of the light's bake in `sunset`, and of Suzanne's first picture in it with her materials."""
    path, begin = folder / "sunset.rsibr.exr", processes()
    subprocess.run([RSIBR, *SUNSET, "-o", path], check=True, capture_output=True)
    baked = processes()
    item = suzanne()
    use_map_set(item.rsibr, str(path))
    first = Window(view, LARGE)
    first.frame(bpy.context.view_layer.update)
    assert not first.messages(item), first.messages(item)
    bpy.data.objects.remove(item)
    return baked - begin, processes() - baked


def measured(view: View, folder: Path) -> list[tuple[str, str, str]]:
    """What, what was measured, and what was asked."""
    bake, picture = first_preview(view, folder)
    environment = load_environment("forest")
    light = Light(environment, folder)
    item = sphere()
    use_map_set(item.rsibr, str(light.path))
    small = Window(view, SMALL)
    still = small.median()
    rows = [
        (f"from {name} to new pixels, beyond the draw", f"{small.median(edit) - still:.3f} s", "0.05 s")
        for name, edit in edits(item).items()
    ]
    assert not small.messages(item), small.messages(item)
    begin = time.process_time()
    drain(bake_pyramid(environment.radiance, KernelPyramidSettings().size))
    rows.append(("another world of 1024x512", f"{time.process_time() - begin:.1f} s", "1.5 s"))

    stack = folder / "stack.rsibr.exr"
    subprocess.run([RSIBR, *STACK, "-o", stack], check=True, capture_output=True)
    use_map_set(item.rsibr, str(stack))
    bpy.context.view_layer.update()
    theirs = Window(view, LARGE).median()
    use_map_set(item.rsibr, str(light.path))
    for coat, words in ((0.0, "in four images"), (0.5, "in four images, coated")):
        coat_over(item, coat)
        bpy.context.view_layer.update()
        large = Window(view, LARGE)
        frame = f"a frame of 101,760 triangles {words}, {LARGE}x{LARGE} pixels, of a lobe stack's"
        rows.append((frame, f"{large.median() / theirs:.1f}", "2.5"))
    (used,) = large.previews._map_sets.used.values()
    half = used.gpu_map_set.textures[0]._format == "RGBA16F"
    sizes = [(HALF_BYTES if half else FLOAT_BYTES, used.gpu_map_set.textures[0])]
    sizes += [(FLOAT_BYTES, each) for each in used.gpu_map_set.textures[1:]]
    taken = sum(size * np.prod(texture._shape[:-1]) for size, texture in sizes) / 1e6
    rows.append(("the pyramid and the families on the GPU", f"{taken:.0f} MB", "40 MB"))
    bpy.data.objects.remove(item)

    items = many(str(light.path))
    first = Window(view, LARGE)
    whole, python = first.frame(bpy.context.view_layer.update)
    assert not [message for each in items for message in first.messages(each)]
    words = f"the first picture of {OBJECTS} objects, {OBJECTS} materials and {2 * OBJECTS} images"
    rows.append((words, f"{whole:.1f} s", "20 s"))
    rows.append(
        ("of that, the thread that runs Python, the driver's part included", f"{python:.1f} s", "5 s")
    )
    rows.append(
        ("a first preview: `sunset` is baked, by a process of its own", f"{bake:.1f} s", "15 s with the next")
    )
    rows.append(("Suzanne's first picture in it, coated and in four images", f"{picture:.1f} s", ""))
    return rows


def main() -> None:
    """Print the table, and write it into docs/materials.md."""
    view = start()
    lines = ["| What | measured | asked, at most |", "|---|---:|---:|"]
    with tempfile.TemporaryDirectory() as folder:
        for what, found, asked in measured(view, Path(folder)):
            lines.append(f"| {what} | {found} | {asked} |")
            print(lines[-1], flush=True)
    write_table("materials.md", "edits", "\n".join(lines))


if __name__ == "__main__":
    main()
