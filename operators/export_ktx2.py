"""Write the active object's map set as textures for engines."""

from pathlib import Path

import bpy

from ..rsibr_addon.core.progress import drain
from ..rsibr_addon.files.textures import Up
from ..rsibr_addon.host.map_sets import planned_path, written_path
from ..rsibr_addon.tasks.export.export import export
from ..rsibr_addon.tasks.export.ktx2 import Ktx2Settings
from .reporting import reporting


class RSIBR_OT_export_ktx2(bpy.types.Operator):
    """Write the active object's map set as textures for game engines and the web"""  # noqa: D400  (a tooltip)

    bl_idname = "rsibr.export_ktx2"
    bl_label = "Export Reflection Maps"

    filepath = bpy.props.StringProperty(
        name="File",
        description="Texture to write",
        subtype="FILE_PATH",
        options={"SKIP_SAVE", "PATH_SUPPORTS_BLEND_RELATIVE"},
    )
    filter_glob = bpy.props.StringProperty(default="*.ktx2", options={"HIDDEN"})
    check_existing = bpy.props.BoolProperty(default=True, options={"HIDDEN"})
    up = bpy.props.EnumProperty(
        name="Up",
        description="Axis that points up in the textures; of mip chains alone it can be another than Z",
        items=[("z", "Z", "As in Blender"), ("y", "Y", "As in glTF")],
    )

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Whether there is a map set."""
        if context.object is None or not context.object.rsibr.map_set:
            cls.poll_message_set("The active object has no map set: bake or assign one.")
            return False
        return True

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Export; who has chosen a file in Blender's dialog has agreed to replace it."""
        with reporting(self):
            map_set, output = written_path(context.object.rsibr), Path(bpy.path.abspath(self.filepath))
            settings = Ktx2Settings(Up(self.up))
            for texture in drain(export(map_set, output, settings, force=self.options.is_invoke)):
                self.report({"INFO"}, f"Wrote {texture}")
            return {"FINISHED"}
        return {"CANCELLED"}

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Ask for the file."""
        name = Path(planned_path(context.object.rsibr)).name.removesuffix(".exr").removesuffix(".rsibr")
        self.filepath = f"{name}.ktx2"
        context.window_manager.fileselect_add(self)
        return {"RUNNING_MODAL"}
