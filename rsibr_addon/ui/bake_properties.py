"""Properties of a scene, what to bake and how, and of an object, how its map set was baked."""

import bpy

from ..files.kinds.registry import AS_ADDED, STORED
from ..host.bake_settings import chosen_picture, use_picture
from ..host.installation import studio_environments
from ..host.option_properties import group_of, properties_of
from ..properties import keep_in_overrides
from ..session.map_pictures import Item
from ..settings.light import Clamp

METHOD_GROUPS = {
    kind: group_of(f"RSIBR_PG_bake_{kind}", f"{settings.LABEL}: {settings.SUMMARY}.", properties_of(settings))
    for kind, settings in ((kind, stored.settings) for kind, stored in STORED.items())
}
"""Kind of map sets -> the settings of what makes it."""


def _with_methods(cls: type[bpy.types.PropertyGroup]) -> type[bpy.types.PropertyGroup]:
    """Give a class the settings of each method, and of all of them."""
    for name, clamp in properties_of(Clamp).items():
        setattr(cls, name, clamp)
    for kind, group in METHOD_GROUPS.items():
        setattr(cls, kind, bpy.props.PointerProperty(type=group))
    return cls


_studios: list[Item] = []
"""Blender needs the texts of a property's items to stay."""


def _studio_items(group: bpy.types.PropertyGroup, context: bpy.types.Context | None) -> list[Item]:
    """Blender's own environments, with the pictures that it has of them."""
    if not _studios:
        lights = bpy.context.preferences.studio_lights
        icons = {light.name: bpy.types.UILayout.icon(light) for light in lights if light.type == "WORLD"}
        for number, (name, path) in enumerate(studio_environments().items()):
            _studios.append((name, name.title(), str(path), icons.get(path.name, 0), number))
    return _studios


@_with_methods
class RSIBR_PG_bake(bpy.types.PropertyGroup):
    """What to bake for the active object."""

    light = bpy.props.EnumProperty(
        name="Light",
        description="Where the light that is baked comes from",
        items=[
            ("WORLD", "World", "The scene's world as it is"),
            ("STUDIO", "Built-in", "One of the environments that Blender has for Material Preview"),
            ("PICTURE", "Picture", "A latitude-longitude picture, OpenEXR or Radiance HDR"),
        ],
    )
    studio = bpy.props.EnumProperty(
        name="Environment", description="Environment that comes with Blender", items=_studio_items
    )
    image = bpy.props.PointerProperty(
        type=bpy.types.Image,
        name="Image",
        description="The picture as Blender keeps track of it: its path, or its packed bytes",
    )
    picture = bpy.props.StringProperty(
        name="Picture",
        description="Latitude-longitude picture of the light, OpenEXR (or FILE.exr:LAYER) or Radiance HDR",
        subtype="FILE_PATH",
        options={"PATH_SUPPORTS_BLEND_RELATIVE"},
        get=chosen_picture,
        set=use_picture,
    )
    layer = bpy.props.StringProperty(
        name="Layer", description="Layer of an OpenEXR picture that has several; empty for its main picture"
    )
    bare_world = bpy.props.BoolProperty(
        name="Bare World",
        description="Whether the world was baked without its strength and rotation",
        options={"HIDDEN"},
    )
    kind = bpy.props.EnumProperty(
        name="Method",
        description="What is baked",
        items=[
            (kind, stored.settings.LABEL, stored.settings.SUMMARY, AS_ADDED.index(kind))
            for kind, stored in STORED.items()
        ],
        default=next(iter(STORED)),
    )


CLASSES = (*METHOD_GROUPS.values(), RSIBR_PG_bake)
"""In the order of registration."""

keep_in_overrides(CLASSES)

POINTERS = {
    "rsibr_bake": (bpy.types.Scene, RSIBR_PG_bake),
    "rsibr_baked": (bpy.types.Object, RSIBR_PG_bake),
}
"""Name of a property -> its owner, and the group it points to: what to bake, and what was baked."""
