"""Bake the active object's map set again."""

import bpy

from ..rsibr_addon.host.plain_settings import apply_settings, plain_settings
from ..rsibr_addon.tasks.queue.bake_request import request_for
from .at_once import Undoable
from .bake_in_background import queue_bake


class RSIBR_OT_bake_again(Undoable, bpy.types.Operator):
    """Bake this object's map set again with its own settings, and show them in the panels"""  # noqa: D400  (a tooltip)

    bl_idname = "rsibr.bake_again"
    bl_label = "Bake Again"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Whether the settings of its bake are known."""
        known = context.object is not None and context.object.is_property_set("rsibr_baked")
        if not known:
            cls.poll_message_set("It was not baked here: choose settings, and press Bake")
        return known

    def work(self, context: bpy.types.Context) -> None:
        """Choose the settings and queue the bake; a file that holds what it did is taken at once."""
        apply_settings(context.scene.rsibr_bake, plain_settings(context.object.rsibr_baked))
        scene, item = context.scene, context.object
        request = request_for(scene.rsibr_bake, scene, item)
        self.report({"INFO"}, queue_bake(scene, request, [item], item.rsibr.content))
