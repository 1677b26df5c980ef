"""Menus of reflectance models."""

import bpy

from ..core.brdf.gallery import GALLERY
from ..tasks.methods.kinds import KINDS


class _Models:
    """Choose a reflectance model"""  # noqa: D400  (a tooltip)

    bl_label = "Models"
    layout: bpy.types.UILayout

    def data_path(self, context: bpy.types.Context) -> str:
        """Where the text of the model that is chosen goes."""
        raise NotImplementedError

    def draw(self, context: bpy.types.Context) -> None:
        """Show what comes with the extension, by groups."""
        row = self.layout.row()
        for group, models in GALLERY.items():
            column = row.column()
            column.label(text=group)
            column.separator()
            for name, spec in models.items():
                choose = column.operator("wm.context_set_string", text=name)
                choose.data_path, choose.value = self.data_path(context), spec


class RSIBR_MT_models(_Models, bpy.types.Menu):
    """Choose a reflectance model to bake"""  # noqa: D400  (a tooltip)

    def data_path(self, context: bpy.types.Context) -> str:
        """See `_Models`."""
        return f"scene.rsibr_bake.{context.scene.rsibr_bake.kind}.brdf"


class RSIBR_MT_live_models(_Models, bpy.types.Menu):
    """Choose a reflectance model to shade the object as"""  # noqa: D400  (a tooltip)

    def data_path(self, context: bpy.types.Context) -> str:
        """See `_Models`; of the kind whose preview offers this menu."""
        (kind,) = (kind for kind, row in KINDS.items() if row.menu == type(self).__name__)
        return f"object.rsibr.{kind}.brdf"
