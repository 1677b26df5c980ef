"""Set a method's settings to those of a quality."""

import bpy

from ..rsibr_addon.tasks.methods.methods import QUALITIES


class RSIBR_OT_apply_quality(bpy.types.Operator):
    """Set this method's settings"""  # noqa: D400  (a tooltip)

    bl_idname = "rsibr.apply_quality"
    bl_label = "Quality"
    bl_options = {"REGISTER", "UNDO"}  # noqa: RUF012  (Blender reads the class)

    quality = bpy.props.EnumProperty(
        name="Quality",
        items=[
            ("DRAFT", "Draft", "To see at once what it will be like"),
            ("GOOD", "Good", "For most work"),
            ("FINAL", "Final", "As exact as is worth waiting for"),
        ],
    )

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Set them."""
        kind = context.scene.rsibr_bake.kind
        chosen = getattr(context.scene.rsibr_bake, kind)
        for name, value in QUALITIES[self.quality][kind].items():
            setattr(chosen, name, value)
        return {"FINISHED"}
