"""How well is baked, in one of three words."""

import bpy

from ..core.options import declared_options, quality_values
from ..files.kinds.registry import STORED
from ..host.option_properties import property_name, shown_value
from .bake_properties import RSIBR_PG_bake


def draw_quality(layout: bpy.types.UILayout, chosen: RSIBR_PG_bake) -> None:
    """Show a button for each quality of the method that is chosen; the one that its settings have is pressed.

    Parameters
    ----------
    layout : bpy.types.UILayout
    chosen : RSIBR_PG_bake
    """
    settings = STORED[chosen.kind].settings
    group, row = getattr(chosen, chosen.kind), layout.row(align=True)
    for quality in ("draft", "good", "final"):
        values = quality_values(settings, quality)
        shown = all(
            getattr(group, property_name(each)) == shown_value(each, values[each.name])
            for each in declared_options(settings)
            if each.name in values
        )
        button = row.operator("rsibr.apply_quality", text=quality.capitalize(), depress=shown)
        button.quality = quality.upper()
