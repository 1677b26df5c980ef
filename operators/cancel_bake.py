"""Cancel a bake of the queue, or remove one that has ended."""

import bpy

from ..rsibr_addon.session.running import session
from ..rsibr_addon.tasks.queue.input_bakes import InputBake

CANCELLED = "The bake of the materials was cancelled: press Bake Materials to have it."


class RSIBR_OT_cancel_bake(bpy.types.Operator):
    """Cancel this bake, or remove it from the list if it has ended. Finished views are kept: bake again to go on"""  # noqa: D400, E501  (a tooltip)

    bl_idname = "rsibr.cancel_bake"
    bl_label = "Cancel Bake"

    number = bpy.props.IntProperty(
        name="Number", description="Place in the queue, from 0", options={"SKIP_SAVE"}
    )

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Cancel the bake, or remove it from the list."""
        bakes = session().bakes.bakes
        if not 0 <= self.number < len(bakes):
            self.report({"ERROR"}, f"There is no bake number {self.number}: the queue has changed.")
            return {"CANCELLED"}
        bake = bakes[self.number]
        if bake.ended:
            bakes.remove(bake)
        else:
            bake.cancel()
            bake.tidy()
            if isinstance(bake, InputBake):
                session().previews.inputs.ended(bake.output, CANCELLED)
        return {"FINISHED"}
