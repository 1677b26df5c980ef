"""Filter the world of the open file, or an environment, with a material's lobes."""

from pathlib import Path

import bpy

from ..rsibr_addon.core.progress import drain
from ..rsibr_addon.tasks.methods.lobe_stack import StackSettings, bake_brdf
from ..rsibr_addon.tasks.reflectance.fit_lobes import FitSettings
from .reporting import reporting


class RSIBR_OT_bake_stack(bpy.types.Operator):
    """Fit lobes to a reflectance model and filter an environment with them, into a map set"""  # noqa: D400  (a tooltip)

    bl_idname = "rsibr.bake_stack"
    bl_label = "Bake Lobe Stack"
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
    brdf = bpy.props.StringProperty(
        name="BRDF", description="Model and its parameters", default="ggx:alpha=0.3,metal=copper"
    )
    lobes = bpy.props.IntProperty(
        name="Lobes", description="For each layer of the model", default=3, min=1, max=12
    )
    slices = bpy.props.IntProperty(name="Slices", description="View elevations", default=16, min=1, max=256)
    layout_of_maps = bpy.props.EnumProperty(
        name="Layout",
        items=[("dual_paraboloid", "Dual Paraboloid", ""), ("octahedral", "Octahedral", "")],
    )
    size = bpy.props.IntProperty(
        name="Size", description="Width of a map in texels; 0 for what the lobes need", min=0, max=1024
    )
    half = bpy.props.BoolProperty(name="Half Floats", description="Half the space, 11 significant bits")
    force = bpy.props.BoolProperty(name="Replace", description="Replace the file if it exists")

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Bake at a stretch."""
        with reporting(self):
            settings = StackSettings(self.layout_of_maps, self.size or None, self.half)
            fitting = FitSettings(lobes=self.lobes, slices=self.slices)
            output = Path(bpy.path.abspath(self.filepath))
            drain(bake_brdf(self.environment or None, self.brdf, fitting, settings, output, self.force))
            self.report({"INFO"}, f"Baked {output}")
            return {"FINISHED"}
        return {"CANCELLED"}

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Ask for a file."""
        context.window_manager.fileselect_add(self)
        return {"RUNNING_MODAL"}
