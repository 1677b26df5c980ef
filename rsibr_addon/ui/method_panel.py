"""How it is baked."""

import bpy

from ..tasks.methods.methods import QUALITIES


class RSIBR_PT_method(bpy.types.Panel):
    """How light and material become maps"""  # noqa: D400  (a tooltip)

    bl_label = "Method"
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "RSIBR"

    def draw(self, context: bpy.types.Context) -> None:
        """Show the method, qualities for it, and its own settings."""
        scene, layout = context.scene.rsibr_bake, self.layout
        layout.prop(scene, "kind", text="")
        if not scene.kind:  # one of a newer version
            return
        chosen = getattr(scene, scene.kind)
        row = layout.row(align=True)
        for quality, settings in QUALITIES.items():
            shown = all(getattr(chosen, name) == value for name, value in settings[scene.kind].items())
            row.operator("rsibr.apply_quality", text=quality.capitalize(), depress=shown).quality = quality
        column = layout.column()
        column.use_property_split = True
        column.use_property_decorate = False
        for name in QUALITIES["GOOD"][scene.kind] | _OTHERS.get(scene.kind, {}):
            column.prop(chosen, name)


_OTHERS: dict[str, dict[str, None]] = {"mip_chain": {"filter": None, "roughness": None}}
"""Kind -> settings that no quality says anything of."""
