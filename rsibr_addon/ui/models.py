"""Menus of reflectance models."""

import bpy

from ..core.brdf.gallery import GALLERY
from ..files.kinds.registry import STORED
from ..host.option_properties import model_property
from ..tasks.methods.kinds import KINDS


def _draw_models(layout: bpy.types.UILayout, data_path: str) -> None:
    """Show the models that come with the extension, by groups; the text of the chosen one goes to a path."""
    row = layout.row()
    for group, models in GALLERY.items():
        column = row.column()
        column.label(text=group)
        column.separator()
        for name, spec in models.items():
            choose = column.operator("wm.context_set_string", text=name)
            choose.data_path, choose.value = data_path, spec


class RSIBR_MT_models(bpy.types.Menu):
    """Choose a reflectance model to bake"""  # noqa: D400  (a tooltip)

    bl_label = "Models"

    def draw(self, context: bpy.types.Context) -> None:
        """Show the models, for the method that is chosen."""
        kind = context.scene.rsibr_bake.kind
        _draw_models(self.layout, f"scene.rsibr_bake.{kind}.{model_property(STORED[kind].settings)}")


class RSIBR_MT_live_models(bpy.types.Menu):
    """Choose a reflectance model to shade the object as"""  # noqa: D400  (a tooltip)

    bl_label = "Models"

    def draw(self, context: bpy.types.Context) -> None:
        """Show the models, for the kind whose preview offers this menu."""
        (kind,) = (kind for kind, row in KINDS.items() if row.menu == type(self).__name__)
        _draw_models(self.layout, f"object.rsibr.{kind}.brdf")
