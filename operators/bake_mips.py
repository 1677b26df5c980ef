"""Filter the world of the open file, or an environment, into a mip chain."""

from pathlib import Path

import bpy

from ..rsibr_addon.core.progress import drain
from ..rsibr_addon.tasks.methods.mip_chain import MipSettings, bake_mips
from .reporting import reporting


class RSIBR_OT_bake_mips(bpy.types.Operator):
    """Filter an environment into mips for glossy and diffuse reflections, into a map set"""  # noqa: D400  (a tooltip)

    bl_idname = "rsibr.bake_mips"
    bl_label = "Bake Mip Chain"
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
    filter = bpy.props.EnumProperty(
        name="Filter",
        items=[
            ("ggx", "GGX", "GGX lobes, as engines use them"),
            ("bordered", "Bordered", "Weighted means across the faces' borders"),
            ("box", "Box", "Means within each face, as graphics hardware makes them"),
        ],
    )
    size = bpy.props.EnumProperty(
        name="Size",
        description="Width of the first mip's faces in texels",
        items=[(str(size), str(size), "") for size in (64, 128, 256, 512, 1024)],
        default="256",
    )
    roughness = bpy.props.EnumProperty(
        name="Roughness",
        description="How roughness grows from mip to mip; of GGX",
        items=[
            ("linear", "Linear", "mip / last"),
            ("quadratic", "Quadratic", "1 - sqrt(1 - mip / last), as Filament's"),
        ],
    )
    force = bpy.props.BoolProperty(name="Replace", description="Replace the file if it exists")

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Bake at a stretch."""
        with reporting(self):
            settings = MipSettings(self.filter, int(self.size), self.roughness)
            output = Path(bpy.path.abspath(self.filepath))
            path = drain(bake_mips(self.environment or None, settings, output, self.force))
            self.report({"INFO"}, f"Baked {path}")
            return {"FINISHED"}
        return {"CANCELLED"}

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Ask for a file."""
        context.window_manager.fileselect_add(self)
        return {"RUNNING_MODAL"}
