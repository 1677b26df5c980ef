"""What a Blender file keeps of ours: each object's map set, and how it is to be shaded."""

from collections.abc import Iterable
from typing import Any

import bpy

from .host.map_sets import chosen_path, use_map_set
from .host.overrides import complete_override


def _notice(group: bpy.types.PropertyGroup, context: bpy.types.Context) -> None:
    """Have overrides kept. That a property has a callback is why Blender draws anew, also for a script."""
    complete_override(group.id_data)


class RSIBR_PG_radiance_views(bpy.types.PropertyGroup):
    """The fields of `core.kinds.radiance_views.shading.ViewsLook`; so with every kind of map set."""

    mode = bpy.props.EnumProperty(
        name="Mode",
        description="Where views are warped and blended",
        update=_notice,
        items=[
            ("fragment", "Fragment", "For each fragment with its own view: right in perspective"),
            ("texel", "Texel", "Once a frame, for each texel of a sphere map"),
            ("paper", "Paper", "Once a frame, on a tessellated disk, as in the paper of 1999"),
        ],
    )
    warping = bpy.props.EnumProperty(
        name="Warp",
        description="What is warped how",
        update=_notice,
        items=[
            ("albedo", "Albedo", "Diffuse and glossy apart, over the material's directional albedo"),
            ("split", "Split", "Diffuse light by the normal, glossy light by the mirror direction"),
            ("single", "Single", "All light by the mirror direction, as in the paper of 1999"),
        ],
    )
    antialiased = bpy.props.BoolProperty(
        name="Antialiased",
        description="Average glossy light over what each pixel reflects, so that small lamps do not shimmer",
        update=_notice,
        default=True,
    )


def _weight(name: str, description: str) -> float:
    """A slider for what multiplies a table."""
    return bpy.props.FloatProperty(
        name=name, description=description, update=_notice, default=1.0, min=0.0, soft_max=2.0
    )


class RSIBR_PG_reflection_tables(bpy.types.PropertyGroup):
    """The fields of `core.kinds.reflection_tables.shading.TablesLook`."""

    shown = bpy.props.EnumProperty(
        name="Tables",
        description="Those that count",
        update=_notice,
        options={"ENUM_FLAG"},
        items=[
            ("diffuse", "Diffuse", "Looked up by the normal"),
            ("specular", "Specular", "Looked up by the mirror direction"),
            ("coat", "Coat", "A clear varnish, looked up by the mirror direction"),
            ("retro", "Retro", "Light sent back, looked up by the view direction"),
            ("refraction", "Refraction", "Light let through, looked up by the refracted direction"),
        ],
        default={"diffuse", "specular", "coat", "retro", "refraction"},
    )
    w_diffuse = _weight("Diffuse ×", "Multiplies the diffuse table's weight, Wd of the paper of 1984")
    w_specular = _weight("Specular ×", "Multiplies the specular table's weight, Ws of the paper of 1984")
    w_coat = _weight("Coat ×", "Multiplies the coat's weight")
    w_retro = _weight("Retro ×", "Multiplies the weight of light that is sent back")
    w_refraction = _weight("Refraction ×", "Multiplies the weight of light that is let through")
    antialiased = bpy.props.BoolProperty(
        name="Antialiased",
        description="Average specular and coat over what each pixel reflects: small lamps do not shimmer",
        update=_notice,
    )


class RSIBR_PG_lobe_stack(bpy.types.PropertyGroup):
    """The fields of `core.kinds.lobe_stack.shading.StackLook`."""

    use_lobes = bpy.props.BoolProperty(
        name="Single Lobe", description="Show one of the lobes that the material is a sum of", update=_notice
    )
    lobes = bpy.props.IntProperty(
        name="Lobe", description="Number of the lobe that is shown, from 0", update=_notice, min=0, soft_max=7
    )
    antialiased = bpy.props.BoolProperty(
        name="Antialiased",
        description="Average light over what each pixel reflects, so that small lamps do not shimmer",
        update=_notice,
        default=True,
    )


class RSIBR_PG_mip_chain(bpy.types.PropertyGroup):
    """The fields of `core.kinds.mip_chain.shading.MipLook`."""

    f_lambda = bpy.props.FloatVectorProperty(
        name="Reflectance",
        description="Of the glossy part, at normal incidence",
        update=_notice,
        subtype="COLOR",
        default=(0.04, 0.04, 0.04),
        min=0.0,
        max=1.0,
    )
    k_d = bpy.props.FloatVectorProperty(
        name="Diffuse",
        description="Albedo of the diffuse part",
        update=_notice,
        subtype="COLOR",
        default=(0.8, 0.8, 0.8),
        min=0.0,
        max=1.0,
    )
    bias = bpy.props.FloatProperty(
        name="Mip",
        description="That glossy light comes from; linear between two",
        update=_notice,
        min=0.0,
        soft_max=10.0,
    )
    use_roughness = bpy.props.BoolProperty(
        name="By Roughness",
        description="Choose the mip of a roughness; the other one has to be 0. For chains of GGX lobes",
        update=_notice,
    )
    roughness = bpy.props.FloatProperty(
        name="Roughness", description="That glossy light is of", update=_notice, default=0.3, min=0.0, max=1.0
    )
    borders = bpy.props.EnumProperty(
        name="Borders",
        description="What a lookup near a face's border interpolates with",
        update=_notice,
        items=[
            ("seamless", "Seamless", "The neighbouring face's texels"),
            ("clamped", "Clamped", "The face's own texels, as the hardware of 2004"),
        ],
    )
    antialiased = bpy.props.BoolProperty(
        name="Antialiased",
        description="Average glossy light over what each pixel reflects, so that small lamps do not shimmer",
        update=_notice,
        default=True,
    )


class RSIBR_PG_environment(bpy.types.PropertyGroup):
    """The fields of `core.kinds.environment.EnvironmentLook`."""

    f_lambda = bpy.props.FloatVectorProperty(
        name="Reflectance",
        description="Of the mirror, at normal incidence; white is a perfect mirror",
        update=_notice,
        subtype="COLOR",
        default=(1.0, 1.0, 1.0),
        min=0.0,
        max=1.0,
    )
    antialiased = bpy.props.BoolProperty(
        name="Antialiased",
        description="Average the light over what each pixel reflects, so that small lamps do not shimmer",
        update=_notice,
        default=True,
    )


class RSIBR_PG_kernel_bank(bpy.types.PropertyGroup):
    """The fields of `core.kinds.kernel_bank.shading.BankLook`."""

    brdf = bpy.props.StringProperty(
        name="Model",
        description="Reflectance model and its parameters, as ggx:alpha=0.1,metal=gold",
        update=_notice,
        default="ggx:alpha=0.3,metal=copper",
    )
    use_roughness = bpy.props.BoolProperty(
        name="Set Roughness",
        description="Give every layer of the model the roughness below, instead of its own",
        update=_notice,
    )
    roughness = bpy.props.FloatProperty(
        name="Roughness",
        description="Of the model's layers; their alpha is its square",
        update=_notice,
        default=0.5,
        min=0.1,
        max=1.0,
    )
    lobe_count = bpy.props.IntProperty(
        name="Lobes",
        description="For each layer of the model; more follow its reflectance more closely, and take longer",
        update=_notice,
        default=3,
        min=1,
        max=12,
    )


class RSIBR_PG_live(bpy.types.PropertyGroup):
    """Light rendered around the object while one looks."""

    on = bpy.props.BoolProperty(
        name="Live Light",
        description="Shade the object from its surroundings as the viewport shows them, without a map set",
        update=_notice,
    )
    size = bpy.props.EnumProperty(
        name="Size",
        description="Of each of the six faces, in pixels",
        update=_notice,
        items=[(str(size), str(size), "") for size in (32, 64, 128, 256)],
        default="64",
    )
    budget = bpy.props.IntProperty(
        name="Budget (ms)",
        description="What a frame may spend on new light after a change: as many of the six faces as fit, at "
        "least one. Less keeps Blender quick, more lets the light follow sooner",
        default=20,
        min=1,
        soft_max=200,
        max=10000,
    )


class RSIBR_PG_looks(bpy.types.PropertyGroup):
    """How an object is shaded, for each kind of map set."""

    radiance_views = bpy.props.PointerProperty(type=RSIBR_PG_radiance_views)
    reflection_tables = bpy.props.PointerProperty(type=RSIBR_PG_reflection_tables)
    lobe_stack = bpy.props.PointerProperty(type=RSIBR_PG_lobe_stack)
    mip_chain = bpy.props.PointerProperty(type=RSIBR_PG_mip_chain)
    environment = bpy.props.PointerProperty(type=RSIBR_PG_environment)
    kernel_bank = bpy.props.PointerProperty(type=RSIBR_PG_kernel_bank)


class RSIBR_PG_preview(bpy.types.PropertyGroup):
    """What shades an object in the viewport."""

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
    show = bpy.props.BoolProperty(
        name="Show", description="Shade the object from its map set", update=_notice, default=True
    )
    follow_world = bpy.props.BoolProperty(
        name="Follow World",
        description="Turn and scale the light as the world's Mapping and Background do with its Environment "
        "Texture; for map sets that were made in the bare environment",
        update=_notice,
    )
    other = bpy.props.PointerProperty(type=RSIBR_PG_looks)
    radiance_views = bpy.props.PointerProperty(type=RSIBR_PG_radiance_views)
    reflection_tables = bpy.props.PointerProperty(type=RSIBR_PG_reflection_tables)
    lobe_stack = bpy.props.PointerProperty(type=RSIBR_PG_lobe_stack)
    mip_chain = bpy.props.PointerProperty(type=RSIBR_PG_mip_chain)
    environment = bpy.props.PointerProperty(type=RSIBR_PG_environment)
    kernel_bank = bpy.props.PointerProperty(type=RSIBR_PG_kernel_bank)
    live = bpy.props.PointerProperty(type=RSIBR_PG_live)


class RSIBR_PG_view(bpy.types.PropertyGroup):
    """How viewports show previews, for as long as Blender runs."""

    split = bpy.props.BoolProperty(
        name="Split", description="Show something else right of a line", update=_notice
    )
    beyond = bpy.props.EnumProperty(
        name="Right of It",
        update=_notice,
        items=[
            ("blender", "Blender's Shading", "What the viewport shows without previews"),
            ("other", "Another Look", "The same map sets, shaded in another way"),
            ("difference", "Difference", "How far both looks are apart, from black over red to white"),
        ],
    )
    difference = bpy.props.FloatProperty(
        name="Full Scale",
        description="The difference that is white, as a part of what the display shows",
        update=_notice,
        default=0.1,
        min=0.001,
        max=1.0,
    )
    line = bpy.props.FloatProperty(
        name="Line",
        description="Where the one ends and the other begins",
        update=_notice,
        subtype="FACTOR",
        default=0.5,
        min=0.0,
        max=1.0,
    )


CLASSES = (
    RSIBR_PG_radiance_views,
    RSIBR_PG_reflection_tables,
    RSIBR_PG_lobe_stack,
    RSIBR_PG_mip_chain,
    RSIBR_PG_environment,
    RSIBR_PG_kernel_bank,
    RSIBR_PG_live,
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
