"""Compare the active object's map set with the truth."""

import bpy

from ..rsibr_addon.files.output_paths import comparison_page
from ..rsibr_addon.host.map_sets import written_path
from ..rsibr_addon.session.running import session
from ..rsibr_addon.tasks.queue.bake_request import comparison_of, shown_material
from . import background
from .at_once import AtOnce
from .reporting import can_start


class RSIBR_OT_compare(AtOnce, bpy.types.Operator):
    """Compare the preview with Cycles in the background, and open a report"""  # noqa: D400  (a tooltip)

    bl_idname = "rsibr.compare"
    bl_label = "Compare"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Whether the map set has a reference to compare with; if not, the button's tooltip says why."""
        if context.object is None or not context.object.rsibr.map_set:
            return False
        return can_start(cls, lambda: shown_material(context.object, written_path(context.object.rsibr)))

    def work(self, context: bpy.types.Context) -> None:
        """Queue the comparison, unless it is there already."""
        item = context.object
        path = written_path(item.rsibr)
        if session().bakes.unfinished(comparison_page(path)) is not None:
            self.report({"INFO"}, f"Being compared already: {path.name}")
            return
        background.submit(comparison_of(context.scene, item, path))
        self.report({"INFO"}, f"Comparing {path.name}")
