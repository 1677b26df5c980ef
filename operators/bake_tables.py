"""Make reflection tables of a material from the world of the open file, or from an environment."""

from pathlib import Path

import bpy

from ..rsibr_addon.core.kinds.reflection_tables.bake import DIFFUSE_ROWS, LARGEST, TableSizes
from ..rsibr_addon.core.kinds.reflection_tables.material import PARTS, PRESETS, preset
from ..rsibr_addon.core.progress import drain
from ..rsibr_addon.tasks.methods.reflection_tables import TableSettings, bake_table_set
from .reporting import reporting

NO_PRESET = "none"


def _part(name: str, example: str) -> str:
    return bpy.props.StringProperty(
        name=name, description=f"As {example}; empty for the preset's own, if any"
    )


class RSIBR_OT_bake_tables(bpy.types.Operator):
    """Make tables of what a material reflects of an environment, into a map set"""  # noqa: D400  (a tooltip)

    bl_idname = "rsibr.bake_tables"
    bl_label = "Bake Reflection Tables"
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
    preset = bpy.props.EnumProperty(
        name="Preset",
        description="Parts that the material starts from",
        items=[
            *((name, name.capitalize(), ", ".join(parts)) for name, parts in PRESETS.items()),
            (NO_PRESET, "None", "Only the parts given below"),
        ],
    )
    diffuse = _part("Diffuse", "lambert:kd=0.5/0.4/0.3 or luminous:kd=0.5")
    emission = _part("Emission", "2/1/0.5")
    specular = _part("Specular", "mirror:ks=0.9 or phong:n=50,ks=0.3")
    coat = _part("Coat", "fresnel:eta=1.5 or constant:k=0.5")
    retro = _part("Retro-reflection", "phong:n=200,ks=0.3")
    refraction = _part("Refraction", "clear:eta=1.5,tint=1/0.9/0.8")
    weights = _part("Weights", "fresnel:eta=1.5 or albedo:brdf=(ggx:alpha=0.3,f0=0.04)")
    diffuse_rows = bpy.props.IntProperty(
        name="Diffuse Rows",
        description="Of the diffuse table; tables have twice as many columns",
        default=DIFFUSE_ROWS,
        min=1,
        max=LARGEST,
    )
    rows = bpy.props.IntProperty(
        name="Rows",
        description="Of the other tables; 0 for what their lobes need",
        default=0,
        min=0,
        max=LARGEST,
    )
    force = bpy.props.BoolProperty(name="Replace", description="Replace the file if it exists")

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Bake at a stretch."""
        with reporting(self):
            output = Path(bpy.path.abspath(self.filepath))
            path = drain(bake_table_set(self.environment or None, self._settings(), output, self.force))
            self.report({"INFO"}, f"Baked {path}")
            return {"FINISHED"}
        return {"CANCELLED"}

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Ask for a file."""
        context.window_manager.fileselect_add(self)
        return {"RUNNING_MODAL"}

    def _settings(self) -> TableSettings:
        given = {part: getattr(self, part) for part in PARTS if getattr(self, part)}
        base = {} if self.preset == NO_PRESET else preset(self.preset)
        return TableSettings(base | given, TableSizes(self.diffuse_rows, self.rows or None))
