"""The tab in the viewport's sidebar."""

import bpy

from ..files.kinds.registry import look_types
from ..host.option_properties import said_by
from ..host.world_light import has_environment, world_light
from ..session.running import session
from ..tasks.methods.kinds import KINDS
from .sentences import tell
from .sidebar import InSidebar

NOT_FOLLOWED = (
    "The world is more than a Background and an Environment Texture with a Mapping that rotates: bake in "
    "the world itself instead of following it."
)


EQUAL_LOOKS = "Both looks are the same, and so nothing differs: change the other look below."


class RSIBR_PT_preview(InSidebar, bpy.types.Panel):
    """Shade the active object from a map set"""  # noqa: D400  (a tooltip)

    bl_label = "Preview"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Whether there is an object to be shaded."""
        return context.object is not None

    def draw_header(self, context: bpy.types.Context) -> None:
        """Show the switch."""
        self.layout.prop(context.object.rsibr, "show", text="")

    def draw(self, context: bpy.types.Context) -> None:
        """Show the file, what it holds, how it is shaded, and what went wrong."""
        item, layout = context.object, self.layout
        layout.use_property_split = True
        row = layout.row(align=True)
        row.prop(item.rsibr, "map_set")
        row.operator("rsibr.reload_map_sets", text="", icon="FILE_REFRESH")
        layout.prop(item.rsibr, "follow_world")
        world = context.scene.world
        if item.rsibr.follow_world and has_environment(world) and world_light(world) is None:
            tell(layout, NOT_FOLLOWED, context.region.width)
        previews = session().previews
        for message in previews.messages(item):
            tell(layout, message, context.region.width)
        if previews.is_loading(item):
            layout.label(text="Loading...", icon="TIME")
        kind = previews.kind(item)
        if kind is None:
            return
        layout.label(text=kind.replace("_", " ").capitalize())
        if KINDS[kind].menu:
            layout.menu(KINDS[kind].menu, text="Choose...", icon="MATERIAL")
        _show_look(layout, getattr(item.rsibr, kind, None))
        view = context.window_manager.rsibr_view
        row = layout.row(heading="Split")
        row.prop(view, "split", text="")
        row.prop(view, "line", text="", slider=True)
        row.operator("rsibr.drag_split", text="", icon="ARROW_LEFTRIGHT")
        if view.split:
            layout.prop(view, "beyond")
        if view.split and view.beyond == "difference":
            layout.prop(view, "difference")
        if view.split and view.beyond != "blender":
            layout.label(text="Other look")
            if _looks_are_equal(item, kind):
                tell(layout, EQUAL_LOOKS, context.region.width, icon="INFO")
            _show_look(layout, getattr(item.rsibr.other, kind, None))


def _looks_are_equal(item: bpy.types.Object, kind: str) -> bool:
    look = look_types()[kind]
    return said_by(look, getattr(item.rsibr, kind)) == said_by(look, getattr(item.rsibr.other, kind))


def _show_look(layout: bpy.types.UILayout, settings: bpy.types.PropertyGroup | None) -> None:
    """Every setting of how a kind of map set is shaded; there are kinds without."""
    for setting in settings.bl_rna.properties if settings else ():
        if setting.identifier in bpy.types.PropertyGroup.bl_rna.properties:
            continue
        if setting.type == "ENUM" and setting.is_enum_flag:
            # In a row there would be room for one letter of each
            layout.label(text=setting.name)
            flow = layout.column_flow(columns=2, align=True)
            flow.use_property_split = False
            flow.prop(settings, setting.identifier)
        else:
            layout.prop(settings, setting.identifier)
