"""Which material is baked."""

from typing import Any

import bpy

from ..core.brdf.gallery import GALLERY, gallery_name
from ..files.kinds.registry import STORED
from ..tasks.methods.kinds import KINDS
from .sentences import tell
from .sidebar import InSidebar


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


class RSIBR_PT_material(InSidebar, bpy.types.Panel):
    """The material that is baked"""  # noqa: D400  (a tooltip)

    bl_label = "Material"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Whether the method is one that this version has."""
        return bool(context.scene.rsibr_bake.kind)

    def draw(self, context: bpy.types.Context) -> None:
        """Show what the method can take."""
        kind, layout = context.scene.rsibr_bake.kind, self.layout
        chosen, remark = getattr(context.scene.rsibr_bake, kind), STORED[kind].settings.REMARK
        if remark:
            tell(layout, remark, context.region.width, icon="INFO")
        elif hasattr(chosen, "source"):
            layout.row().prop(chosen, "source", expand=True)
            _draw_source(layout, chosen, context.object)
        else:
            layout.prop(chosen, "preset", text="")


def _draw_source(layout: bpy.types.UILayout, chosen: Any, item: bpy.types.Object | None) -> None:
    match chosen.source:
        case "OWN":
            if item is not None:
                layout.template_ID(item, "active_material", new="material.new")
        case "PRESET":
            layout.prop(chosen, "preset", text="")
        case "MODEL":
            layout.menu("RSIBR_MT_models", text=gallery_name(chosen.brdf), icon="MATERIAL")
            layout.prop(chosen, "brdf", text="")
        case "FILE":
            layout.prop(chosen, "path", text="")
        case instead:
            layout.prop(chosen, instead.lower(), text="")
