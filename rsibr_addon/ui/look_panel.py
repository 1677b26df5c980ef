"""How the active object is shaded."""

from contextlib import suppress

import bpy

from ..core.errors import RsibrError
from ..core.kinds.principled_material import PrincipledMaterial
from ..core.options import Declared, Options, declared_options
from ..files.kinds.registry import look_types
from ..host.live_light import is_readable
from ..host.option_properties import options_of, property_name, replaced_options, said_by
from ..host.world_light import has_environment, holds_world, world_light
from ..session.running import session
from ..tasks.methods.kinds import KINDS
from .model_options import draw_model
from .sentences import LONG_LABEL_SHARE, LONGEST_LABEL, SOLID, panel_width, tell
from .sidebar import InSidebar

NOT_FOLLOWED = (
    "The world is more than a Background and an Environment Texture with a Mapping that rotates: bake in "
    "the world itself instead of following it."
)

STUDIO_LIGHT = (
    "Blender lights its own shading by a studio light here: turn on Scene World in the menu of Viewport "
    "Shading to compare in the scene's world."
)

NOT_READABLE = (
    "What Cycles renders in a viewport cannot be read, so it is shown itself. Choose Material Preview or "
    "EEVEE for a difference; Compare, below Advanced, measures against Cycles."
)

SLIDERS = {each.name for each in declared_options(PrincipledMaterial)} - {"roughness"}
"""Options of a material by sliders that say nothing of a model by its text."""

PICTURE_SCALE = 4.0
"""Height of a material's picture; a button is 1 high."""

NOT_LIGHT = (
    "Live Light cannot read what this viewport renders: choose Material Preview or EEVEE, here or in another "
    "viewport."
)

LITTLE_LIGHT = (
    "Live Light sees the studio light only as far as World Opacity shows it: raise it in the menu of "
    "Viewport Shading."
)

EQUAL_LOOKS = "Both looks are the same, and so nothing differs: change the other look below."


class RSIBR_PT_look(InSidebar, bpy.types.Panel):
    """How the active object is shaded"""  # noqa: D400  (a tooltip)

    bl_label = "Look"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Whether there is an object to be shaded."""
        return context.object is not None

    def draw_header(self, context: bpy.types.Context) -> None:
        """Show the switch."""
        self.layout.prop(context.object.rsibr, "show", text="")

    def draw(self, context: bpy.types.Context) -> None:
        """Show how it is shaded, and what is beside it."""
        item, layout = context.object, self.layout
        layout.use_property_split = True
        layout.use_property_decorate = False
        world = context.scene.world
        if item.rsibr.live.on:
            if hint := _why_unlit(context.space_data):
                tell(layout, hint, panel_width(context), icon="INFO")
        elif item.rsibr.map_set and not holds_world(item):
            layout.prop(item.rsibr, "follow_world")
            if item.rsibr.follow_world and has_environment(world) and world_light(world) is None:
                tell(layout, NOT_FOLLOWED, panel_width(context))
        kind = session().previews.kind(item)
        if kind is None:
            return
        if KINDS[kind].menu:
            layout.menu(KINDS[kind].menu, text="Choose a Material", icon="MATERIAL")
        _show_look(layout, item, kind, other=False)
        view = context.window_manager.rsibr_view
        row = layout.row(heading="Split Screen")
        row.prop(view, "split", text="")
        row.prop(view, "line", text="", slider=True)
        row.operator("rsibr.drag_split", text="", icon="ARROW_LEFTRIGHT")
        if not view.split:
            return
        layout.prop(view, "beyond")
        beside_blender = view.beyond == "blender" or (view.beyond, view.compared) == ("difference", "blender")
        if beside_blender and (hint := _other_light(context.space_data.shading)):
            tell(layout, hint, panel_width(context), icon="INFO")
        if view.beyond == "difference":
            layout.prop(view, "compared")
            layout.prop(view, "difference")
        if view.beyond == "difference" and view.compared == "blender":
            if not is_readable(context.space_data):
                tell(layout, NOT_READABLE, panel_width(context))
        elif view.beyond != "blender":
            layout.label(text="Other look")
            if _looks_are_equal(item, kind):
                tell(layout, EQUAL_LOOKS, panel_width(context), icon="INFO")
            _show_look(layout, item, kind, other=True)


def _other_light(shading: bpy.types.View3DShading) -> str:
    """What light Blender's own shading has instead of the scene's world, in words; empty if it has that."""
    if shading.type == "SOLID":
        return SOLID
    in_world = {"MATERIAL": shading.use_scene_world, "RENDERED": shading.use_scene_world_render}
    return "" if in_world.get(shading.type, True) else STUDIO_LIGHT


def _why_unlit(space: bpy.types.SpaceView3D) -> str:
    """Why a viewport keeps light from live light, in words; empty if it gives it all."""
    shading = space.shading
    if shading.type == "RENDERED" and not is_readable(space):
        return NOT_LIGHT
    told = _other_light(shading)
    if told == STUDIO_LIGHT:
        return LITTLE_LIGHT if shading.studiolight_background_alpha < 1.0 else ""
    return told


def _looks_are_equal(item: bpy.types.Object, kind: str) -> bool:
    look = look_types()[kind]
    return said_by(look, getattr(item.rsibr, kind)) == said_by(look, getattr(item.rsibr.other, kind))


def _show_look(layout: bpy.types.UILayout, item: bpy.types.Object, kind: str, other: bool) -> None:
    """Show how a kind of map set is shaded; in its own materials, an object needs no other."""
    group = getattr(item.rsibr.other if other else item.rsibr, kind)
    options = list(declared_options(look_types()[kind]))
    if hasattr(group, "own"):
        layout.prop(group, "own")
        unused = {"own", "roughness", *SLIDERS} if group.own else {"own"}
        options = [each for each in options if each.name not in unused]
    _show_material(layout, look_types()[kind], group)
    if getattr(group, "brdf", ""):  # a model by its text, instead of sliders
        for each in options:
            if each.name not in SLIDERS:
                _show_option(layout, group, each)
        return
    replaced = replaced_options(look_types()[kind], group)

    def show(place: bpy.types.UILayout, each: Declared) -> None:
        column = place.column()
        column.active = each.name not in replaced
        _show_option(column, group, each)

    for each in options:
        if not each.option.advanced:
            show(layout, each)
    if any(each.option.models and getattr(group, each.name) for each in options):
        layout.operator("rsibr.bake_look", icon="FILE_REFRESH")
    if more := [each for each in options if each.option.advanced]:
        header, opened = layout.panel(f"RSIBR_look_{kind}_{other}", default_closed=True)
        header.label(text="More")
        for each in more if opened else ():
            show(opened, each)


def _show_material(layout: bpy.types.UILayout, look: type[Options], group: bpy.types.PropertyGroup) -> None:
    """Show the picture of a material by sliders, or by a model's text."""
    if not issubclass(look, PrincipledMaterial) or getattr(group, "own", False):
        return
    with suppress(RsibrError):  # of a text that is none, which is told below the buttons
        picture = session().material_pictures.icon(options_of(look, group).spec)
        layout.template_icon(picture, scale=PICTURE_SCALE)


def _show_option(layout: bpy.types.UILayout, group: bpy.types.PropertyGroup, declared: Declared) -> None:
    name = property_name(declared)
    if declared.option.models:
        draw_model(layout, group, declared)
    elif declared.option.switch is not None:
        row = layout.row(heading=declared.option.label)
        row.prop(group, f"use_{name}", text="")
        value = row.row()
        value.active = getattr(group, f"use_{name}")
        value.prop(group, name, text="")
    elif isinstance(getattr(group, name), set):
        # In a row there would be room for one letter of each
        layout.label(text=declared.option.label)
        flow = layout.column_flow(columns=2, align=True)
        flow.use_property_split = False
        flow.prop(group, name)
    elif len(declared.option.label) > LONGEST_LABEL and not isinstance(getattr(group, name), bool):
        split = layout.split(factor=LONG_LABEL_SHARE)
        label = split.row()
        label.alignment = "RIGHT"
        label.label(text=declared.option.label)
        split.prop(group, name, text="")
    else:
        layout.prop(group, name)
