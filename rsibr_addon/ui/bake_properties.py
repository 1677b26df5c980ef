"""What a scene keeps of ours: what is to be baked, and how; and each object, of what it is shaded from."""

import bpy

from ..core.brdf.gallery import GALLERY
from ..core.kinds.reflection_tables.material import PRESETS as TABLE_PRESETS
from ..host.bake_settings import chosen_picture, use_picture
from ..host.presets import PRESETS
from ..host.worlds import studio_environments
from ..properties import keep_in_overrides
from ..tasks.methods.methods import MEASURED_FORMATS
from .map_pictures import Item

_OWN_SOURCE = ("OWN", "Object's Own", "The active object's active material, whatever its nodes")


class RSIBR_PG_bake_views(bpy.types.PropertyGroup):
    """The fields of `tasks.methods.methods.Views`; and so with every method."""

    source = bpy.props.EnumProperty(
        name="Material",
        description="Which material is captured",
        items=[_OWN_SOURCE, ("PRESET", "Preset", "One that comes with the extension")],
    )
    preset = bpy.props.EnumProperty(
        name="Preset",
        description="Material that comes with the extension",
        items=[(name, name.replace("-", " ").title(), each.summary) for name, each in PRESETS.items()],
        default="copper",
    )
    views = bpy.props.EnumProperty(
        name="Views",
        description="Directions to capture the material from; more show its changing look more truly",
        items=[(count, count, f"{count} views, {degrees} degrees apart") for count, degrees in
               (("12", 63), ("42", 36), ("162", 18))],
    )  # fmt: skip
    size = bpy.props.IntProperty(
        name="Size",
        description="Width and height of a view in texels; sharp materials need more",
        default=256,
        min=4,
        max=8192,
    )
    samples = bpy.props.IntProperty(
        name="Samples", description="Samples of Cycles a texel; more make less noise", default=32, min=2
    )
    denoise = bpy.props.BoolProperty(
        name="Denoise",
        description="Denoise each view: good for rough materials, bad for mirrors",
        default=True,
    )


class RSIBR_PG_bake_stack(bpy.types.PropertyGroup):
    """The fields of `tasks.methods.methods.Lobes`."""

    source = bpy.props.EnumProperty(
        name="Material",
        description="Where the material's reflectance comes from",
        items=[
            ("OWN", "Object's Own", "The active object's active material, measured by Cycles"),
            ("MODEL", "Model", "A reflectance model and its parameters"),
            ("FILE", "Measured", "A file of measurements"),
        ],
        default="MODEL",
    )
    brdf = bpy.props.StringProperty(
        name="Model",
        description="Model and its parameters, as ggx:alpha=0.3,metal=copper",
        default=GALLERY["Metals"]["Brushed copper"],
    )
    path = bpy.props.StringProperty(
        name="File",
        description=f"Measurement of the MERL, Cornell or RGL database: {', '.join(MEASURED_FORMATS)}",
        subtype="FILE_PATH",
        options={"PATH_SUPPORTS_BLEND_RELATIVE"},
    )
    lobes = bpy.props.IntProperty(
        name="Lobes",
        description="Lobes for each layer of the material; more follow its reflectance more closely",
        default=3,
        min=1,
        max=12,
    )
    slices = bpy.props.IntProperty(
        name="Elevations", description="View elevations to make maps for", default=16, min=1, max=256
    )
    size = bpy.props.IntProperty(
        name="Size", description="Width of a map in texels; 0 for what the lobes need", min=0, max=2048
    )
    half = bpy.props.BoolProperty(
        name="Half Floats", description="Half the space on disk, with 11 significant bits", default=True
    )


class RSIBR_PG_bake_tables(bpy.types.PropertyGroup):
    """The fields of `tasks.methods.methods.Tables`."""

    preset = bpy.props.EnumProperty(
        name="Material",
        description="Parts that the material is made of",
        items=[
            (
                name,
                name.replace("-", " ").title(),
                ", ".join(f"{part} {text}" for part, text in parts.items()),
            )
            for name, parts in TABLE_PRESETS.items()
        ],
    )
    diffuse_rows = bpy.props.IntProperty(
        name="Diffuse Rows",
        description="Height of the diffuse table in texels; diffuse light changes slowly",
        default=36,
        min=1,
        max=8192,
    )
    rows = bpy.props.IntProperty(
        name="Rows",
        description="Height of the other tables in texels; 0 for what the material needs",
        min=0,
        max=8192,
    )


class RSIBR_PG_bake_mips(bpy.types.PropertyGroup):
    """The fields of `tasks.methods.methods.Mips`."""

    filter = bpy.props.EnumProperty(
        name="Filter",
        description="How each mip is made",
        items=[
            ("ggx", "GGX", "The highlight of a rough surface, as engines use it"),
            ("bordered", "Bordered", "Means of neighbouring texels, across the cube's edges"),
            ("box", "Box", "Means within each face of the cube, as in the paper of 2004"),
        ],
    )
    size = bpy.props.EnumProperty(
        name="Size",
        description="Width of the sharpest mip's faces in texels",
        items=[(str(size), str(size), "") for size in (64, 128, 256, 512, 1024)],
        default="256",
    )
    roughness = bpy.props.EnumProperty(
        name="Roughness",
        description="How roughness grows from mip to mip",
        items=[
            ("linear", "Linear", "The same step from each mip to the next"),
            ("quadratic", "Quadratic", "Finer steps where highlights are sharp, as in Filament"),
        ],
    )


class RSIBR_PG_bake_bank(bpy.types.PropertyGroup):
    """The fields of `tasks.methods.methods.Bank`."""

    size = bpy.props.EnumProperty(
        name="Size",
        description="Width of a map in texels; sharper materials need more",
        items=[(str(size), str(size), "") for size in (64, 128, 256, 512)],
        default="128",
    )


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


class RSIBR_PG_bake(bpy.types.PropertyGroup):
    """What is to be baked for the active object."""

    light = bpy.props.EnumProperty(
        name="Light",
        description="Where the light that is baked comes from",
        items=[
            ("WORLD", "World", "The scene's world as it is"),
            ("STUDIO", "Blender's", "One of the environments that come with Blender"),
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
        name="Layer", description="Of an OpenEXR picture with several; empty for the one that is the picture"
    )
    clamp = bpy.props.FloatProperty(
        name="Clamp",
        description="Take brighter radiance, also where it is infinite, as this; 0 to keep what is finite",
        min=0.0,
        max=1e30,
        soft_max=1e5,
    )
    kind = bpy.props.EnumProperty(
        name="Method",
        description="What is baked",
        items=[
            ("radiance_views", "Radiance Views", "Any material, rendered by Cycles from all around"),
            ("lobe_stack", "Lobe Stack", "A glossy material's highlights, for each view elevation"),
            ("reflection_tables", "Reflection Tables", "Simple materials: diffuse, mirror, varnish, glass"),
            ("mip_chain", "Mip Chain", "Light alone, for any roughness: as game engines use it"),
            ("kernel_bank", "Kernel Bank", "Light alone, for any reflectance model: chosen while you look"),
        ],
    )
    radiance_views = bpy.props.PointerProperty(type=RSIBR_PG_bake_views)
    lobe_stack = bpy.props.PointerProperty(type=RSIBR_PG_bake_stack)
    reflection_tables = bpy.props.PointerProperty(type=RSIBR_PG_bake_tables)
    mip_chain = bpy.props.PointerProperty(type=RSIBR_PG_bake_mips)
    kernel_bank = bpy.props.PointerProperty(type=RSIBR_PG_bake_bank)


CLASSES = (
    RSIBR_PG_bake_views,
    RSIBR_PG_bake_stack,
    RSIBR_PG_bake_tables,
    RSIBR_PG_bake_mips,
    RSIBR_PG_bake_bank,
    RSIBR_PG_bake,
)
"""In the order of registration."""

keep_in_overrides(CLASSES)

POINTERS = {
    "rsibr_bake": (bpy.types.Scene, RSIBR_PG_bake),
    "rsibr_baked": (bpy.types.Object, RSIBR_PG_bake),
}
"""Name of a property -> what has it, and the group it points to: what is to be baked, and what was."""
