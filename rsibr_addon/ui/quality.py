"""How well is baked, in one of three words."""

import bpy

from ..files.kinds.registry import STORED
from ..host.qualities import QUALITIES, has_quality
from .bake_properties import RSIBR_PG_bake


def draw_quality(layout: bpy.types.UILayout, chosen: RSIBR_PG_bake) -> None:
    """Show a button for each quality of the method that is chosen; the one that its settings have is pressed.

    Parameters
    ----------
    layout : bpy.types.UILayout
    chosen : RSIBR_PG_bake
    """
    settings, group = STORED[chosen.kind].settings, getattr(chosen, chosen.kind)
    row = layout.row(align=True)
    for quality in QUALITIES:
        shown = has_quality(settings, group, quality)
        button = row.operator("rsibr.apply_quality", text=quality.capitalize(), depress=shown)
        button.quality = quality.upper()
