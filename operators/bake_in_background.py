"""Bake what the scene's settings say for the active object, in a Blender of its own."""

import bpy

from ..rsibr_addon.core.errors import RsibrError
from ..rsibr_addon.host.bake_settings import assign
from ..rsibr_addon.tasks.bake_order import bake_of, is_baked, order_for, output_for
from . import background
from .reporting import reporting


class RSIBR_OT_bake(bpy.types.Operator):
    """Bake a map set for the active object in the background, and shade the object from it when it is done"""  # noqa: D400  (a tooltip)

    bl_idname = "rsibr.bake"
    bl_label = "Bake"
    bl_options = {"REGISTER", "UNDO"}  # noqa: RUF012  (Blender reads the class)

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Whether nothing is missing; the button's tooltip says what is."""
        try:
            order_for(context.scene, context.object)
        except RsibrError as error:
            cls.poll_message_set(str(error))
            return False
        return True

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Queue the bake; where the same was baked before, its file is taken at once."""
        with reporting(self):
            order = order_for(context.scene, context.object)
            output = output_for(order, context.scene, context.object)
            if (unfinished := background.queue.unfinished(output)) is not None:
                unfinished.items.append(context.object.session_uid)
                self.report({"INFO"}, f"Being baked already: {output.name}")
            elif is_baked(output):
                assign(context.object.session_uid, output)
                self.report({"INFO"}, f"Baked before: {output.name}")
            else:
                background.submit(bake_of(order, context.object, output))
            return {"FINISHED"}
        return {"CANCELLED"}
