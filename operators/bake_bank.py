"""Filter the world of the open file, or an environment, with a bank of kernels."""

from pathlib import Path

import bpy

from ..rsibr_addon.core.progress import drain
from ..rsibr_addon.tasks.methods.kernel_bank import BankSettings, bake_environment
from .reporting import reporting


class RSIBR_OT_bake_bank(bpy.types.Operator):
    """Filter an environment for any material: models are then chosen in the viewport, without a bake"""  # noqa: D400  (a tooltip)

    bl_idname = "rsibr.bake_bank"
    bl_label = "Bake Kernel Bank"
    bl_options = {"REGISTER"}  # noqa: RUF012  (Blender reads the class)

    filepath = bpy.props.StringProperty(
        name="Map Set",
        description="File to write",
        subtype="FILE_PATH",
        options={"SKIP_SAVE", "PATH_SUPPORTS_BLEND_RELATIVE"},
    )
    environment = bpy.props.StringProperty(
        name="Environment",
        description="Latitude-longitude picture, or the name of one of Blender's own; empty for the world",
    )
    layout_of_maps = bpy.props.EnumProperty(
        name="Layout",
        items=[("dual_paraboloid", "Dual Paraboloid", ""), ("octahedral", "Octahedral", "")],
    )
    size = bpy.props.IntProperty(
        name="Size", description="Width of a map in texels", default=128, min=2, max=1024
    )
    force = bpy.props.BoolProperty(name="Replace", description="Replace the file if it exists")

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Bake at a stretch."""
        with reporting(self):
            settings = BankSettings(self.layout_of_maps, self.size)
            output = Path(bpy.path.abspath(self.filepath))
            drain(bake_environment(self.environment or None, settings, output, self.force))
            self.report({"INFO"}, f"Baked {output}")
            return {"FINISHED"}
        return {"CANCELLED"}

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Ask for a file."""
        context.window_manager.fileselect_add(self)
        return {"RUNNING_MODAL"}
