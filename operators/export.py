"""Write the active object's map set for other programs: an operator for each format."""

from pathlib import Path
from typing import Any

import bpy

from ..rsibr_addon.core.progress import drain
from ..rsibr_addon.host.map_sets import planned_path, written_path
from ..rsibr_addon.host.option_properties import options_of, properties_of
from ..rsibr_addon.tasks.export.export import export
from ..rsibr_addon.tasks.export.format import Format
from ..rsibr_addon.tasks.export.formats import FORMATS
from .file_properties import file_path
from .reporting import reporting


class _Export:
    """Write the active object's map set for game engines and the web"""  # noqa: D400  (a tooltip)

    bl_label = "Export Reflection Maps"
    exported: Format

    filepath = file_path("File")
    check_existing = bpy.props.BoolProperty(default=True, options={"HIDDEN"})

    @classmethod
    def poll(cls: Any, context: bpy.types.Context) -> bool:
        """Whether there is a map set."""
        if context.object is None or not context.object.rsibr.map_set:
            cls.poll_message_set("The active object has no map set: bake or assign one.")
            return False
        return True

    def execute(self: Any, context: bpy.types.Context) -> set[str]:
        """Export; who has chosen a file in Blender's dialog has agreed to replace it."""
        with reporting(self):
            map_set, output = written_path(context.object.rsibr), Path(bpy.path.abspath(self.filepath))
            settings = options_of(self.exported.settings, self)
            for texture in drain(export(map_set, output, settings, force=self.options.is_invoke)):
                self.report({"INFO"}, f"Wrote {texture}")
            return {"FINISHED"}
        return {"CANCELLED"}

    def invoke(self: Any, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Ask for the file."""
        name = Path(planned_path(context.object.rsibr)).name.removesuffix(".exr").removesuffix(".rsibr")
        self.filepath = f"{name}{self.exported.suffix}"
        context.window_manager.fileselect_add(self)
        return {"RUNNING_MODAL"}


def _operator(name: str, exported: Format) -> type:
    filter_glob = bpy.props.StringProperty(default=f"*{exported.suffix}", options={"HIDDEN"})
    own = {"bl_idname": f"rsibr.export_{name}", "exported": exported, "filter_glob": filter_glob}
    return type(
        f"RSIBR_OT_export_{name}", (_Export, bpy.types.Operator), own | properties_of(exported.settings)
    )


CLASSES = tuple(_operator(name, exported) for name, exported in FORMATS.items())
