"""Properties of an object: its map set, and how it is shaded."""

from collections.abc import Iterable
from typing import Any

import bpy

from .files.kinds.registry import look_types
from .host.map_sets import chosen_path, use_map_set
from .host.option_properties import group_of, properties_of
from .host.overrides import complete_override


def _notice(group: bpy.types.PropertyGroup, context: bpy.types.Context | None) -> None:
    """Have overrides kept. That a property has a callback is why Blender draws anew, also for a script."""
    complete_override(group.id_data)


LOOK_GROUPS = {
    kind: group_of(
        f"RSIBR_PG_{kind}", f"How a map set of the kind {kind} is shaded.", properties_of(look, _notice)
    )
    for kind, look in look_types().items()
}
"""Kind of map sets -> the options of its look."""


def _with_looks(cls: type[bpy.types.PropertyGroup]) -> type[bpy.types.PropertyGroup]:
    """Give a class the look of each kind."""
    for kind, group in LOOK_GROUPS.items():
        setattr(cls, kind, bpy.props.PointerProperty(type=group))
    return cls


class RSIBR_PG_live(bpy.types.PropertyGroup):
    """Light rendered around the object while one looks."""

    on = bpy.props.BoolProperty(
        name="Live Light",
        description="Shade the object from its surroundings as the viewport shows them, without a map set",
        update=_notice,
    )
    size = bpy.props.EnumProperty(
        name="Size",
        description="Width of each of the six faces, in pixels",
        update=_notice,
        items=[(str(size), str(size), "") for size in (32, 64, 128, 256)],
        default="64",
    )
    mips = bpy.props.BoolProperty(
        name="Mips and Harmonics",
        description="Shade one material by sliders from mips and harmonics, as in Kautz, Daubert and Seidel "
        "2004, instead of the object's own materials from kernels of all widths",
        update=_notice,
    )
    degree = bpy.props.IntProperty(
        name="Degree",
        description="Degree of the harmonics of diffuse light: 2 is the paper's nine numbers; more follow "
        "small lamps",
        update=_notice,
        default=2,
        min=0,
        max=8,
    )
    budget = bpy.props.IntProperty(
        name="Budget (ms)",
        description="Time that a frame may spend on new light after a change; it renders at least one of six "
        "faces. Less keeps Blender quick, more lets the light follow sooner",
        default=20,
        min=1,
        soft_max=200,
        max=10000,
    )


class RSIBR_PG_painted(bpy.types.PropertyGroup):
    """A map that is being painted; its name is that of the map set's part."""

    image = bpy.props.PointerProperty(
        type=bpy.types.Image, name="Image", description="What is painted in place of the map", update=_notice
    )


@_with_looks
class RSIBR_PG_looks(bpy.types.PropertyGroup):
    """How an object is shaded, for each kind of map set."""


@_with_looks
class RSIBR_PG_preview(bpy.types.PropertyGroup):
    """What shades an object in the viewport, and how."""

    image = bpy.props.PointerProperty(
        type=bpy.types.Image,
        name="Image",
        description="The map set's file as Blender keeps track of it: its path, or its packed bytes",
        update=_notice,
    )
    content = bpy.props.StringProperty(
        name="Content", description="Hash of what the map set held when it was chosen"
    )
    map_set = bpy.props.StringProperty(
        name="Map Set",
        description="File that shades the object in the viewport; a picture of an environment is mirrored",
        update=_notice,
        subtype="FILE_PATH",
        options={"PATH_SUPPORTS_BLEND_RELATIVE"},
        get=chosen_path,
        set=use_map_set,
    )
    painted = bpy.props.CollectionProperty(type=RSIBR_PG_painted)
    show = bpy.props.BoolProperty(
        name="Show", description="Shade the object from its map set", update=_notice, default=True
    )
    follow_world = bpy.props.BoolProperty(
        name="Follow World",
        description="Turn and scale the light as the world's Mapping and Background do with its Environment "
        "Texture; and bake the world's light anew when something else of it changes",
        update=_notice,
        default=True,
    )
    other = bpy.props.PointerProperty(type=RSIBR_PG_looks)
    live = bpy.props.PointerProperty(type=RSIBR_PG_live)


class RSIBR_PG_view(bpy.types.PropertyGroup):
    """How viewports show previews, for as long as Blender runs."""

    split = bpy.props.BoolProperty(
        name="Split",
        description="Show Blender's shading, another look or a difference right of a line",
        update=_notice,
    )
    beyond = bpy.props.EnumProperty(
        name="Right of It",
        update=_notice,
        items=[
            ("blender", "Blender's Shading", "What the viewport shows without previews"),
            ("other", "Another Look", "The same map sets, shaded in another way"),
            ("difference", "Difference", "From black over red to white; the scale has numbers"),
        ],
    )
    compared = bpy.props.EnumProperty(
        name="Difference From",
        update=_notice,
        items=[
            ("blender", "Blender's Shading", "What the viewport shows without previews"),
            ("other", "Another Look", "The same map sets, shaded in another way"),
        ],
    )
    difference = bpy.props.FloatProperty(
        name="Full Scale",
        description="Difference that is shown white, as a share of the display's range",
        update=_notice,
        default=0.1,
        min=0.001,
        max=1.0,
    )
    line = bpy.props.FloatProperty(
        name="Line",
        description="Position of the line",
        update=_notice,
        subtype="FACTOR",
        default=0.5,
        min=0.0,
        max=1.0,
    )


CLASSES = (
    *LOOK_GROUPS.values(),
    RSIBR_PG_live,
    RSIBR_PG_painted,
    RSIBR_PG_looks,
    RSIBR_PG_preview,
    RSIBR_PG_view,
)
"""In the order of registration."""

OVERRIDABLE = {"LIBRARY_OVERRIDABLE"}
"""Library overrides keep only the properties that are told to be kept."""


def keep_in_overrides(classes: Iterable[type[bpy.types.PropertyGroup]]) -> None:
    """Have library overrides keep what groups store; to be called before they are registered."""
    for cls in classes:
        for declared in _declared(cls).values():
            if "get" not in declared.keywords:
                declared.keywords["override"] = OVERRIDABLE


def annotate(cls: type) -> None:
    """Say a class's properties as Blender asks for them: `size: IntProperty()`.

    We write `size = IntProperty()`, which tells mypy that `self.size` is an int.

    Parameters
    ----------
    cls : type
        To be registered; what it derives from is seen to as well.
    """
    for owner in cls.__mro__:
        if declared := _declared(owner):
            owner.__annotations__ = {**owner.__annotations__, **declared}
            for name in declared:
                delattr(owner, name)


def _declared(cls: type) -> dict[str, Any]:
    return {
        name: value for name, value in vars(cls).items() if isinstance(value, bpy.props._PropertyDeferred)
    }


keep_in_overrides(CLASSES)

POINTERS = {
    "rsibr": (bpy.types.Object, RSIBR_PG_preview),
    "rsibr_view": (bpy.types.WindowManager, RSIBR_PG_view),
}
"""Name of a property -> what has it, and the group it points to."""
