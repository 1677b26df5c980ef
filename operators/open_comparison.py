"""Open the report of the last comparison of the active object's map set."""

import bpy

from ..rsibr_addon.core.errors import SceneError
from ..rsibr_addon.files.output_paths import comparison_page
from ..rsibr_addon.host.map_sets import written_path
from .at_once import AtOnce


class RSIBR_OT_open_comparison(AtOnce, bpy.types.Operator):
    """Show the last comparison of the active object's map set in the browser"""  # noqa: D400  (a tooltip)

    bl_idname = "rsibr.open_comparison"
    bl_label = "Open Comparison"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Whether there is a map set."""
        return context.object is not None and bool(context.object.rsibr.map_set)

    def work(self, context: bpy.types.Context) -> None:
        """Open it."""
        path = written_path(context.object.rsibr)
        page = comparison_page(path)
        if not page.is_file():
            raise SceneError(f"There is no comparison of {path.name}: press Compare.")
        bpy.ops.wm.url_open(url=page.resolve().as_uri())
