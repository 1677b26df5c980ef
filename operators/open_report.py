"""Write a report of a map set, and open it."""

import bpy

from ..rsibr_addon.core.errors import SceneError
from ..rsibr_addon.core.progress import drain
from ..rsibr_addon.files.output_paths import report_beside
from ..rsibr_addon.host.map_sets import written_path
from ..rsibr_addon.tasks.report.report import map_set_report
from .at_once import AtOnce


class RSIBR_OT_open_report(AtOnce, bpy.types.Operator):
    """Show the active object's map set in the browser: its maps, settings and error bound"""  # noqa: D400  (a tooltip)

    bl_idname = "rsibr.open_report"
    bl_label = "Report"

    open_browser = bpy.props.BoolProperty(
        name="Open", description="Open the report in the browser", default=True, options={"SKIP_SAVE"}
    )

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Whether there is a map set."""
        return context.object is not None and bool(context.object.rsibr.map_set)

    def work(self, context: bpy.types.Context) -> None:
        """Write it beside the map set, in place of an earlier one."""
        path = written_path(context.object.rsibr)
        if not path.is_file():
            raise SceneError(f"There is no map set {path}: bake it again, or choose another.")
        written = drain(map_set_report(path, report_beside(path), force=True))
        self.report({"INFO"}, f"Wrote {written}")
        if self.open_browser:
            bpy.ops.wm.url_open(url=written.resolve().as_uri())
