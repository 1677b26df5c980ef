"""A render engine of Blender's: what previews show, as pictures."""

import time
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from typing import Any

import bpy
from bpy.app.handlers import persistent

from ..core.errors import RsibrError
from ..core.progress import drain
from ..core.warned import is_recorded, recorded_warnings, warn
from ..device.context import ensure_context, has_driver
from ..files.map_set import is_whole_map_set
from ..host.handlers import add_handlers
from ..host.option_properties import options_of
from ..host.render_views import CameraView, camera_view, left_out
from ..host.visible_surfaces import RENDER_ENGINE, current_view
from ..session.running import session
from ..settings.render import RenderOptions
from ..tasks.queue.world_bakes import WorldBake, world_bake_of, world_file
from ..tasks.render.missing_bakes import bake_for_render
from ..tasks.render.picture import CHANNELS, COMBINED, DEPTH, EMISSION, NORMAL, Picture

WAIT_SECONDS = 0.1
"""Between two looks at a bake of the world."""

SHOW_SECONDS = 1.0
"""Between two pictures of a render that goes on."""

SWITCHES = {DEPTH: "use_pass_z", NORMAL: "use_pass_normal", EMISSION: "use_pass_emit"}
"""Pass -> the view layer's switch."""

SOCKETS = {"Z": "VALUE", "XYZ": "VECTOR", "RGB": "COLOR", "RGBA": "COLOR"}
"""Channels of a pass -> the type of its socket in the compositor."""


class RSIBR_RE_previews(bpy.types.RenderEngine):
    """Renders what previews show."""

    bl_idname = RENDER_ENGINE
    bl_label = "RSIBR"
    bl_use_preview = False
    bl_use_postprocess = True
    # Where there is no driver, `ensure_context` says so
    bl_use_gpu_context = not bpy.app.background or has_driver()
    bl_use_eevee_viewport = True

    def update_render_passes(self, scene: bpy.types.Scene, layer: bpy.types.ViewLayer) -> None:
        """Say which passes there are."""
        for name in _passes(layer):
            channels = CHANNELS[name]
            self.register_pass(scene, layer, name, len(channels), channels, SOCKETS[channels])

    def update(self, data: bpy.types.BlendData, depsgraph: bpy.types.Depsgraph) -> None:
        """Write down what a background Blender needs for the world, while nobody can change it."""
        self._bake: WorldBake | None = None
        self._has_failed, scene = False, depsgraph.scene
        if not bpy.app.background:
            session().renders.show_as(session().previews)
        with self._telling():
            if scene.world and not bpy.app.background and not is_whole_map_set(world_file(scene)):
                self._bake = world_bake_of(scene)

    def render(self, depsgraph: bpy.types.Depsgraph) -> None:
        """Render a view layer."""
        with self._telling():
            ensure_context()
            if not self._has_failed and (self._bake is None or self._wait_for(self._bake)):
                self._render(depsgraph)

    def view_update(self, context: bpy.types.Context, depsgraph: bpy.types.Depsgraph) -> None:
        """Nothing: the viewport's previews notice by themselves."""

    def view_draw(self, context: bpy.types.Context, depsgraph: bpy.types.Depsgraph) -> None:
        """Draw the world; objects come with the viewport's other previews."""
        previews = session().previews
        with previews.faults.guarded():
            previews.draw_backdrop(current_view())

    @contextmanager
    def _telling(self) -> Iterator[None]:
        """Within, our errors end the render, and our warnings are told."""
        with recorded_warnings() as warnings:
            try:
                yield
            except (RsibrError, OSError) as error:
                self._has_failed = True
                self.report({"ERROR"}, str(error))
        for warning in warnings:
            self._warn(warning)

    def _warn(self, sentence: str) -> None:
        """Tell whoever had us rendered: a command, or else whoever looks at Blender's reports."""
        if is_recorded():
            warn(sentence)
        else:
            self.report({"WARNING"}, sentence)

    def _wait_for(self, bake: WorldBake) -> bool:
        """Have the world baked; False where that is cancelled, or fails."""
        bake.start()
        try:
            while not bake.ended:
                if self.test_break():
                    return False
                self.update_stats("", f"Baking the world: {100.0 * bake.fraction:.0f}%")
                self.update_progress(bake.fraction)
                time.sleep(WAIT_SECONDS)
                bake.update()
        finally:
            bake.cancel()
            bake.tidy()
        if is_whole_map_set(bake.output):  # perhaps by another Blender
            return True
        self.report({"ERROR"}, bake.message)
        return False

    def _render(self, depsgraph: bpy.types.Depsgraph) -> None:
        layer = depsgraph.view_layer.name
        result = self.begin_result(0, 0, 1, 1, layer=layer)
        names = [each.name for each in result.views]  # two of a stereoscopic picture
        self.end_result(result, cancel=True)
        for name in names:
            self.active_view_set(name)
            self._render_view(depsgraph, name)

    def _render_view(self, depsgraph: bpy.types.Depsgraph, name: str) -> None:
        camera = self.camera_override
        pose = self.camera_model_matrix(camera) if camera else None
        shift = self.camera_shift_x(camera) if camera else 0.0
        view = camera_view(depsgraph, camera, pose, shift, (self.resolution_x, self.resolution_y))
        passes, renders = _passes(depsgraph.view_layer_eval), session().renders
        picture = renders.picture(view, passes)
        for message in renders.news(left_out(depsgraph.scene, depsgraph.view_layer, camera)):
            warn(message)
        samples = options_of(RenderOptions, depsgraph.scene.rsibr_render).samples
        since = time.monotonic()
        for done in range(samples):
            if self.test_break():
                return
            picture.add_sample()
            self.update_stats(name, f"Sample {done + 1} of {samples}")
            self.update_progress((done + 1) / samples)
            if done + 1 < samples and time.monotonic() > since + SHOW_SECONDS and not bpy.app.background:
                self._show(picture, view, name)
                since = time.monotonic()
        self._show(picture, view, name)
        for message in renders.news(renders.messages(picture)):
            warn(message)

    def _show(self, picture: Picture, view: CameraView, name: str) -> None:
        layer = view.depsgraph.view_layer.name
        result = self.begin_result(0, 0, *view.size, layer=layer, view=name)
        of_layer = result.layers[0].passes
        for pass_name, pixels in picture.read().items():
            of_layer.find_by_name(pass_name, name).rect.foreach_set(pixels.ravel())
        self.end_result(result)


def start(undo: ExitStack) -> None:
    """Have renders prepared and ended.

    Parameters
    ----------
    undo : ExitStack
        Takes what ends it.
    """
    add_handlers({"render_init": _prepare, "render_complete": _end, "render_cancel": _end}, undo)


@persistent
def _prepare(scene: bpy.types.Scene, *_: object) -> None:
    """Bake what a render lacks where no window waits for it: no render can begin within another."""
    if not bpy.app.background:
        return
    try:
        session().renders.wish(drain(bake_for_render(scene)))
    except (RsibrError, OSError) as error:
        session().renders.trouble = str(error)


@persistent
def _end(scene: bpy.types.Scene, *_: object) -> None:
    session().renders.release()


def _passes(layer: Any) -> list[str]:
    """The passes that a view layer asks for."""
    return [COMBINED, *(name for name, switch in SWITCHES.items() if getattr(layer, switch))]
