"""Bake for the active object in a background Blender, by the scene's settings."""

import bpy

from ..rsibr_addon.core.errors import RsibrError
from ..rsibr_addon.host.bake_settings import assign
from ..rsibr_addon.session.running import session
from ..rsibr_addon.tasks.queue.bake_request import bake_of, is_baked, output_for, plain_name, request_for
from ..rsibr_addon.tasks.report.facts import map_set_content
from . import background
from .at_once import Undoable


class RSIBR_OT_bake(Undoable, bpy.types.Operator):
    """Bake a map set for the active object in the background, then shade the object from it"""  # noqa: D400  (a tooltip)

    bl_idname = "rsibr.bake"
    bl_label = "Bake"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Whether the bake can start; if not, the button's tooltip says why."""
        try:
            request_for(context.scene, context.object)
        except RsibrError as error:
            cls.poll_message_set(str(error))
            return False
        return True

    def work(self, context: bpy.types.Context) -> None:
        """Queue the bake; where the same was baked before, its file is taken at once."""
        self.report({"INFO"}, queue_bake(context))


def queue_bake(context: bpy.types.Context, content: str = "") -> str:
    """Bake for the active object, unless the same is being baked or was before.

    Parameters
    ----------
    context : bpy.types.Context
    content : str
        Hash of what a file that was baked before has to hold; empty if anything will do.

    Returns
    -------
    str
        What was done, in words.

    Raises
    ------
    RsibrError
        See `request_for`, `output_for` and `bake_of`.
    """
    item = context.object
    request = request_for(context.scene, item)
    output = output_for(request, context.scene, item)
    if (unfinished := session().bakes.unfinished(output)) is not None:
        unfinished.items.append(item.session_uid)
        return f"Being baked already: {plain_name(output)}"
    if is_baked(output) and content in ("", map_set_content(output)):
        assign(item.session_uid, output, request.shown)
        return f"Baked before: {plain_name(output)}"
    background.submit(bake_of(request, context.scene, item, output))
    return f"Baking {plain_name(output)}"
