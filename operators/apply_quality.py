"""Set a method's settings to those of a quality."""

import bpy

from ..rsibr_addon.core.options import declared_options, quality_values
from ..rsibr_addon.files.kinds.registry import STORED
from ..rsibr_addon.host.option_properties import show_option
from .at_once import Undoable


class RSIBR_OT_apply_quality(Undoable, bpy.types.Operator):
    """Set this method's settings"""  # noqa: D400  (a tooltip)

    bl_idname = "rsibr.apply_quality"
    bl_label = "Quality"

    quality = bpy.props.EnumProperty(
        name="Quality",
        items=[
            ("DRAFT", "Draft", "To see at once what it will be like"),
            ("GOOD", "Good", "For most work"),
            ("FINAL", "Final", "As exact as is worth waiting for"),
        ],
    )

    def work(self, context: bpy.types.Context) -> None:
        """Set them."""
        kind = context.scene.rsibr_bake.kind
        chosen = getattr(context.scene.rsibr_bake, kind)
        values = quality_values(STORED[kind].settings, self.quality.lower())
        for declared in declared_options(STORED[kind].settings):
            if declared.name in values:
                show_option(declared, chosen, values[declared.name])
