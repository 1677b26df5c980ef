"""How it is baked."""

import bpy

from ..core.options import Declared, declared_options, quality_values
from ..files.kinds.registry import STORED
from ..host.option_properties import property_name, shown_value
from .sidebar import InSidebar


class RSIBR_PT_method(InSidebar, bpy.types.Panel):
    """How light and material become maps"""  # noqa: D400  (a tooltip)

    bl_label = "Method"

    def draw(self, context: bpy.types.Context) -> None:
        """Show the method, qualities for it, and its own settings."""
        scene, layout = context.scene.rsibr_bake, self.layout
        layout.prop(scene, "kind", text="")
        if not scene.kind:  # one of a newer version
            return
        chosen, settings = getattr(scene, scene.kind), STORED[scene.kind].settings
        row = layout.row(align=True)
        for quality in ("draft", "good", "final"):
            values = quality_values(settings, quality)
            shown = all(
                getattr(chosen, property_name(each)) == shown_value(each, values[each.name])
                for each in declared_options(settings)
                if each.name in values
            )
            row.operator(
                "rsibr.apply_quality", text=quality.capitalize(), depress=shown
            ).quality = quality.upper()
        _draw_options(layout, chosen, [each for each in _shown(settings) if not each.option.advanced])


class RSIBR_PT_method_advanced(InSidebar, bpy.types.Panel):
    """Settings of the method that most bakes leave alone"""  # noqa: D400  (a tooltip)

    bl_label = "Advanced"
    bl_parent_id = "RSIBR_PT_method"
    bl_options = {"DEFAULT_CLOSED"}  # noqa: RUF012  (Blender reads the class)

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Whether the method has any."""
        return bool(_advanced(context.scene.rsibr_bake.kind))

    def draw(self, context: bpy.types.Context) -> None:
        """Show them."""
        kind = context.scene.rsibr_bake.kind
        _draw_options(self.layout, getattr(context.scene.rsibr_bake, kind), _advanced(kind))


def _shown(settings: type) -> list[Declared]:
    """A material, and what can be given instead, are chosen in a panel of their own."""
    options = declared_options(settings)
    materials = [each.option.materials for each in options if each.option.materials]
    instead = {each.instead for each in materials}
    return [each for each in options if each.option.materials is None and each.name not in instead]


def _advanced(kind: str) -> list[Declared]:
    return [each for each in _shown(STORED[kind].settings) if each.option.advanced] if kind else []


def _draw_options(
    layout: bpy.types.UILayout, chosen: bpy.types.PropertyGroup, options: list[Declared]
) -> None:
    column = layout.column()
    column.use_property_split = True
    column.use_property_decorate = False
    for each in options:
        column.prop(chosen, property_name(each))
