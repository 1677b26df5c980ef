"""What most previews leave alone: methods, their materials and settings."""

from typing import Any

import bpy

from ..core.brdf.gallery import gallery_name
from ..core.options import Declared, declared_options
from ..files.kinds.registry import STORED
from ..host.option_properties import model_property, property_name
from .model_options import draw_model
from .sentences import panel_width, tell
from .sidebar import InSidebar


class RSIBR_PT_advanced(InSidebar, bpy.types.Panel):
    """How light and material become maps, and what the maps are"""  # noqa: D400  (a tooltip)

    bl_label = "Advanced"
    bl_options = {"DEFAULT_CLOSED"}  # noqa: RUF012  (Blender reads the class)

    def draw(self, context: bpy.types.Context) -> None:
        """Show the method, the material that it asks for, and its settings."""
        scene, layout, width = context.scene.rsibr_bake, self.layout, panel_width(context)
        layout.prop(scene, "kind", text="")
        if not scene.kind:  # one of a newer version
            return
        chosen, settings = getattr(scene, scene.kind), STORED[scene.kind].settings
        if settings.REMARK:
            tell(layout, settings.REMARK, width, icon="INFO")
        _draw_material(layout, settings, chosen, context.object)
        _draw_options(layout, chosen, [each for each in _shown(settings) if not each.option.advanced])


class RSIBR_PT_method_advanced(InSidebar, bpy.types.Panel):
    """Settings of the method that most bakes leave alone"""  # noqa: D400  (a tooltip)

    bl_label = "More Settings"
    bl_parent_id = "RSIBR_PT_advanced"
    bl_options = {"DEFAULT_CLOSED"}  # noqa: RUF012  (Blender reads the class)

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Whether the method has any."""
        return bool(_advanced(context.scene.rsibr_bake.kind))

    def draw(self, context: bpy.types.Context) -> None:
        """Show them."""
        kind = context.scene.rsibr_bake.kind
        _draw_options(self.layout, getattr(context.scene.rsibr_bake, kind), _advanced(kind))


def _draw_material(
    layout: bpy.types.UILayout, settings: type, chosen: Any, item: bpy.types.Object | None
) -> None:
    """Show where a method's material comes from; there are methods of light alone."""
    if hasattr(chosen, "source"):
        layout.row().prop(chosen, "source", expand=True)
    match getattr(chosen, "source", "PRESET" if hasattr(chosen, "preset") else None):
        case None:
            pass
        case "OWN":
            if item is not None:
                layout.template_ID(item, "active_material", new="material.new")
        case "PRESET":
            layout.prop(chosen, "preset", text="")
        case "MODEL":
            model = model_property(settings)
            layout.menu("RSIBR_MT_models", text=gallery_name(getattr(chosen, model)), icon="MATERIAL")
            layout.prop(chosen, model, text="")
        case "FILE":
            layout.prop(chosen, "path", text="")
        case instead:
            layout.prop(chosen, instead.lower(), text="")


def _shown(settings: type) -> list[Declared]:
    """All options but the material, and what can be given instead of it."""
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
        if each.option.models:
            draw_model(column, chosen, each)
        else:
            row = column.row()
            row.prop(chosen, property_name(each), text=_label(each))
            if each.option.adds:
                row.operator(each.option.adds, text="", icon="ADD")


def _label(declared: Declared) -> str:
    """An option's label; of a whole number, such as a size, also that 0 leaves it to the bake."""
    told = declared.option
    is_left = isinstance(told.none_as, int) and told.none_as == 0 and told.none != "none"
    return f"{told.label} (0: auto)" if is_left else told.label
