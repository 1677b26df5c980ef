"""Pictures of objects with materials of their own: as previews draw them, and by Cycles."""

import dataclasses
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import bpy
import gpu
import numpy as np
import rsibr
from mathutils import Matrix
from rsibr.rsibr_addon.core.at_once import AtOnce
from rsibr.rsibr_addon.core.conventions import Array
from rsibr.rsibr_addon.core.environment import Environment
from rsibr.rsibr_addon.core.errors import RsibrWarning
from rsibr.rsibr_addon.core.geometry.camera import Camera
from rsibr.rsibr_addon.core.kinds.kernel_pyramid.bake import bake_pyramid
from rsibr.rsibr_addon.core.kinds.kernel_pyramid.pyramid import Pyramid
from rsibr.rsibr_addon.core.kinds.kernel_pyramid.shading import Families
from rsibr.rsibr_addon.core.kinds.kernel_pyramid.split_sum import split_families
from rsibr.rsibr_addon.core.progress import drain
from rsibr.rsibr_addon.core.suns import NO_SUNS
from rsibr.rsibr_addon.device import buffers
from rsibr.rsibr_addon.device.context import ensure_context
from rsibr.rsibr_addon.device.kinds.kernel_pyramid import GpuPyramid
from rsibr.rsibr_addon.files.kinds.kernel_pyramid import shipped_families, to_map_set
from rsibr.rsibr_addon.files.map_set import write_map_set
from rsibr.rsibr_addon.files.map_set_header import Origin
from rsibr.rsibr_addon.host.cameras import add_camera
from rsibr.rsibr_addon.host.cycles import RenderedView, RenderSettings, render_view
from rsibr.rsibr_addon.host.map_sets import use_map_set
from rsibr.rsibr_addon.host.scenes import temporary_scene
from rsibr.rsibr_addon.host.visible_surfaces import View
from rsibr.rsibr_addon.host.worlds import light_with
from rsibr.rsibr_addon.settings.kernel_pyramid import KernelPyramidSettings
from rsibr.rsibr_addon.tasks.methods.live_materials import LiveFits
from rsibr.rsibr_addon.tasks.viewport.previews import Previews

CAMERA = Camera((0.3, -1.0, 0.25))
FINE = 4
"""Samples along each axis of a pixel, whose mean is the pixel."""

RAYS = ("visible_diffuse", "visible_glossy", "visible_transmission", "visible_shadow")


def start() -> View:
    """Register the extension in an empty file; returns its viewport."""
    warnings.simplefilter("ignore", RsibrWarning)
    bpy.ops.wm.read_factory_settings()
    rsibr.register()
    ensure_context()
    for item in list(bpy.data.objects):
        bpy.data.objects.remove(item)
    scene, layer = bpy.context.scene, bpy.context.view_layer
    (space,) = (area.spaces.active for area in bpy.context.screen.areas if area.type == "VIEW_3D")
    return View(scene, (scene.session_uid, layer.name), layer.depsgraph, space)


@contextmanager
def framed(width: int, camera: Camera = CAMERA) -> Iterator[Any]:
    """A frame buffer and a view for `Previews.draw`."""
    target = gpu.types.GPUOffScreen(width, width, format="RGBA32F")
    with target.bind(), gpu.matrix.push_pop(), gpu.matrix.push_pop_projection():
        gpu.matrix.load_matrix(Matrix(np.linalg.inv(camera.world_from_camera)))
        gpu.matrix.load_projection_matrix(Matrix(camera.projection))
        yield gpu.state.active_framebuffer_get()


def draw(previews: Previews, view: View) -> None:
    """Draw a frame, once all that it needs is there."""
    while True:
        with previews.faults.guarded():
            if not previews.draw(view):
                previews.add_display(view.scene)
                continue
        assert previews.faults.trouble is None, previews.faults.trouble
        if not previews.is_busy:
            return


class Light:
    """An environment and its pyramid, as a file of a folder."""

    def __init__(self, environment: Environment, folder: Path) -> None:
        self.environment = environment
        settings = KernelPyramidSettings()
        baked = drain(bake_pyramid(environment.radiance, settings.size))
        self.pyramid: Pyramid = baked.pyramid
        self.path = folder / f"{Path(environment.name).stem}.rsibr.exr"
        write_map_set(self.path, to_map_set(baked, Origin(environment, {}, "")))


class Studio:
    """Draws one object of the open file at a time, in one light."""

    def __init__(self, view: View, light: Light, size: int) -> None:
        self._view, self._light, self._size = view, light, size
        self._families: Families = shipped_families()

    def ours(self, item: bpy.types.Object, split: bool = False) -> Array:
        """As previews show it, or the split sum: shape (size, size, 4), as by `Studio.cycles`."""
        use_map_set(item.rsibr, str(self._light.path))
        bpy.context.view_layer.update()
        previews = Previews(LiveFits(), AtOnce())
        with framed(FINE * self._size):
            draw(previews, self._view)
            if split:
                used, key = previews._map_sets, str(self._light.path)
                whole = dataclasses.replace(self._light.pyramid, suns=NO_SUNS)
                peer = GpuPyramid(whole, split_families(self._families))
                for texture in peer.textures:
                    texture.whole()
                used.used[key] = used._shown[item.session_uid] = dataclasses.replace(
                    used.used[key], gpu_map_set=peer
                )
                draw(previews, self._view)
            for message in previews.messages(item):
                print(f"{item.name}: {message}")
            drawn = buffers.pixels(previews._stage._target, FINE * self._size)
        cells = drawn.reshape(self._size, FINE, self._size, FINE, 4)
        return cells.mean(axis=(1, 3), dtype=np.float64)

    def cycles(self, item: bpy.types.Object, samples: int, seed: int, shadows: bool) -> Array:
        """By Cycles: radiance times coverage, and coverage. It hides light from itself if it has shadows."""
        before = {name: getattr(item, name) for name in RAYS}
        for name in RAYS:
            setattr(item, name, shadows)
        try:
            with temporary_scene() as scene:
                light_with(scene, self._light.environment)
                add_camera(scene, CAMERA)
                scene.collection.objects.link(item)
                seen: RenderedView = render_view(scene, RenderSettings(self._size, samples, seed=seed))
        finally:
            for name, value in before.items():
                setattr(item, name, value)
        return seen.rgba.astype(np.float64)


def error(shown: Array, truth: list[Array]) -> float:
    """Relative root-mean-square error, over pixels that are wholly covered.

    In the product of differences from two renders their noise cancels.
    """
    first, second = truth
    inside = np.minimum(np.minimum(first[..., 3], second[..., 3]), shown[..., 3]) > 0.999
    a, b, c = (each[inside][:, :3] for each in (shown, first, second))
    square = np.sum((a - b) * (a - c)) / np.sum(b * c)
    return float(np.sqrt(max(square, 0.0)))
