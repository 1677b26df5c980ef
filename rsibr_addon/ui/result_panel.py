"""What the active object is shaded from."""

import bpy

from ..core.errors import RsibrError
from ..host.map_sets import written_path
from ..tasks.map_set_facts import map_set_facts
from .map_set_file import draw_file, draw_remedies
from .sentences import tell


class RSIBR_PT_result(bpy.types.Panel):
    """The active object's map set"""  # noqa: D400  (a tooltip)

    bl_label = "Result"
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "RSIBR"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Whether there is a map set."""
        return context.object is not None and bool(context.object.rsibr.map_set)

    def draw(self, context: bpy.types.Context) -> None:
        """Show its file, what it is, the errors that it promises; and open its report."""
        layout, item = self.layout, context.object
        try:
            path = written_path(item.rsibr)
            facts = map_set_facts(path)
        except RsibrError as error:
            tell(layout, str(error), context.region.width)
            draw_remedies(layout)
            return
        draw_file(layout, item, path, context.region.width)
        column = layout.column(align=True)
        for what, which in facts.items():
            row = column.split(factor=0.4)
            row.alignment = "RIGHT"
            row.label(text=what)
            row.label(text=which)
        row = layout.row(align=True)
        row.operator("rsibr.open_report", icon="URL")
        row.operator("rsibr.compare", icon="MOD_DATA_TRANSFER")
