"""Set the methods' settings to those of a quality."""

import bpy

from ..rsibr_addon.files.kinds.registry import STORED
from ..rsibr_addon.host.qualities import QUALITIES, has_quality, set_quality
from .at_once import Undoable


class RSIBR_OT_apply_quality(Undoable, bpy.types.Operator):
    """Set this method's settings, and those of other methods that were not changed by hand"""  # noqa: D400  (a tooltip)

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
        """Set those of the chosen method, and of the others that nobody changed by hand."""
        chosen = context.scene.rsibr_bake
        for kind, stored in STORED.items():
            settings, group = stored.settings, getattr(chosen, kind)
            if kind == chosen.kind or any(has_quality(settings, group, each) for each in QUALITIES):
                set_quality(settings, group, self.quality.lower())
