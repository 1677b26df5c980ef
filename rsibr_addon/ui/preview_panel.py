"""What an artist needs: the light, what it will shade, how well, and the button."""

from contextlib import suppress

import bpy

from ..core.errors import RsibrError
from ..files.kinds.registry import STORED
from ..host.map_sets import written_path
from ..host.option_properties import options_of
from ..host.preferences import bakes_inputs_by_itself, check_online, farm_address
from ..session.running import session
from ..tasks.methods.bake import METHODS
from ..tasks.methods.kinds import KINDS
from ..tasks.queue.bake_request import request_for
from ..tasks.queue.freshness import Stale
from ..tasks.report.facts import is_picture, map_set_header
from .bakes import draw_bakes
from .light import draw_light
from .map_set_file import draw_change, draw_remedies
from .materials import draw_materials
from .quality import draw_quality
from .sentences import amount, capital, duration, panel_width, tell
from .sidebar import InSidebar

UNKNOWN_METHOD = "The method is one of another version: choose one below Advanced."


class RSIBR_PT_preview(InSidebar, bpy.types.Panel):
    """See objects in a light, with its true reflections"""  # noqa: D400  (a tooltip)

    bl_label = "Preview"

    def draw(self, context: bpy.types.Context) -> None:
        """Show light, materials, quality and buttons; below them what is told, so that they stay in place."""
        layout, width, chosen = self.layout, panel_width(context), context.scene.rsibr_bake
        draw_light(layout, context)
        if not chosen.kind:
            tell(layout, UNKNOWN_METHOD, width)
            return
        if context.object is not None:
            if KINDS[chosen.kind].own:
                draw_materials(layout, context.object)
            else:
                tell(layout, _shaded_as(context), width, icon="MATERIAL")
        draw_quality(layout, chosen)
        row = layout.row(align=True)
        row.scale_y = 1.5
        row.operator("rsibr.bake", text="Preview", icon="SHADING_RENDERED")
        row.operator("rsibr.preview_scene", text="Preview Scene", icon="SCENE_DATA")
        if farm_address():
            layout.operator("rsibr.send_to_farm", icon="NETWORK_DRIVE")
            _draw_offline(layout, width)
        served = _draw_request(layout, context)
        if context.object is not None:
            fault = ""
            if context.object.rsibr.map_set:
                fault = _draw_state(layout, context.object, width, served)
            _draw_messages(layout, context, fault)
        draw_bakes(layout, session().bakes.bakes, width)


def _shaded_as(context: bpy.types.Context) -> str:
    """What the objects will look like, for methods that do not take their materials as they are."""
    chosen, material = context.scene.rsibr_bake, context.object.active_material
    method = STORED[chosen.kind].settings
    what = ""
    with suppress(RsibrError):  # of settings that cannot be, which is told below the buttons
        settings = options_of(method, getattr(chosen, chosen.kind), material.name if material else "")
        what = METHODS[chosen.kind].material(settings)
    return f"{method.LABEL}: {what}" if what else method.LABEL


def _draw_offline(layout: bpy.types.UILayout, width: int) -> None:
    """Say why nothing can be sent where Blender may not use the network."""
    try:
        check_online()
    except RsibrError as error:
        tell(layout, str(error), width)


def _draw_request(layout: bpy.types.UILayout, context: bpy.types.Context) -> bool:
    """Show what a bake would cost and lack, or why there can be none; whether the active object has it."""
    width = panel_width(context)
    try:
        request = request_for(context.scene.rsibr_bake, context.scene, context.object)
    except RsibrError as error:
        tell(layout, str(error), width)
        return False
    for remark in request.remarks:
        tell(layout, remark, width, icon="INFO")
    if session().freshness.serves(request, context.scene, context.object):
        return True
    if request.settings.expected:
        tell(layout, request.settings.expected, width, icon="INFO")
    cost = request.cost
    takes = f"{amount(cost.memory)} of memory, {amount(cost.disk)} on disk"
    tell(layout, capital(f"{duration(cost.seconds)}, {takes}"), width, icon="TIME")
    return False


def _draw_state(layout: bpy.types.UILayout, item: bpy.types.Object, width: int, served: bool) -> str:
    """Show whether the active object's map set is there, and up to date; why it is not there, or ""."""
    try:
        path = written_path(item.rsibr)
        if not is_picture(path):
            map_set_header(path)
            draw_change(layout, item, path, width)
    except RsibrError as error:
        tell(layout, str(error), width)
        draw_remedies(layout)
        return str(error)
    _draw_freshness(layout, item, width, served)
    return ""


def _draw_freshness(layout: bpy.types.UILayout, item: bpy.types.Object, width: int, served: bool) -> None:
    """Show whether the active object is up to date, and how many others are not.

    Where Preview would bake another map set, that is said of the one shown alone.
    """
    freshness = session().freshness
    stale, to_bake = freshness.of(item), False
    if stale is not None:
        to_bake = _draw_stale(layout, stale, width)
    elif item.session_uid in freshness.stale and not session().previews.inputs.lacks(item):
        text = "Up to date" if served else "The map set shown is up to date"
        layout.label(text=text, icon="CHECKMARK")
    others = sum(each is not None for each in freshness.stale.values()) - (stale is not None)
    if others:
        text = f"{others} other objects out of date" if others > 1 else "Another object out of date"
        layout.label(text=text)
    if others or to_bake:
        layout.operator("rsibr.rebake")


def _draw_messages(layout: bpy.types.UILayout, context: bpy.types.Context, fault: str) -> None:
    """Show what a preview of the active object leaves out or will leave out, and what went wrong.

    Its map set's fault is told above already.
    """
    item, running, chosen = context.object, session(), context.scene.rsibr_bake.kind
    inputs = running.previews.inputs
    is_shown = running.previews.materials_of(item) is not None or inputs.shows_all(item)
    notes = running.material_notes.of_object(item, is_shown) if KINDS[chosen].own else []
    for note in notes:
        tell(layout, note, panel_width(context), icon="INFO")
    for message in running.previews.messages(item):
        if message not in (*notes, fault):
            tell(layout, message, panel_width(context))
    if inputs.lacks(item) and (inputs.is_refused(item) or not bakes_inputs_by_itself()):
        layout.operator("rsibr.bake_inputs")
    if item.rsibr.map_set and (hint := _why_unseen(item, context.space_data.shading)):
        tell(layout, hint, panel_width(context), icon="INFO")
    if running.previews.is_loading(item):
        layout.label(text="Loading...", icon="TIME")


def _why_unseen(item: bpy.types.Object, shading: bpy.types.View3DShading) -> str:
    """Why a viewport does not show the preview of an object, in words; empty if it does."""
    if not item.rsibr.show:
        return "Blender's own shading is shown: Look is switched off."
    if shading.type == "WIREFRAME":
        return "Wireframe shows no previews: choose another Viewport Shading."
    if item.display_type in {"BOUNDS", "WIRE"}:
        return "It is displayed without surfaces: choose Textured in Object, Viewport Display, Display As."
    return ""


def _draw_stale(layout: bpy.types.UILayout, stale: Stale, width: int) -> bool:
    """Show why the active object is out of date; whether it waits to be asked for."""
    if stale.output is None:
        tell(layout, f"It cannot be baked anew. {stale.reason}", width)
    elif session().bakes.unfinished(stale.output) is not None:
        tell(layout, f"{stale.reason}, rebaking", width, icon="TIME")
    else:
        tell(layout, stale.reason, width)
        return True
    return False
