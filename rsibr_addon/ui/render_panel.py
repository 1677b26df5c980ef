"""Panels of the render engine, in Blender's own Properties."""

from contextlib import ExitStack
from typing import Any

import bpy

from ..host.option_properties import group_of, properties_of
from ..host.visible_surfaces import RENDER_ENGINE
from ..properties import keep_in_overrides
from ..session.running import session
from ..settings.render import RenderOptions
from .render_engine import SWITCHES
from .sentences import panel_width, tell

RENDER_GROUP = group_of("RSIBR_PG_render", "How RSIBR renders.", properties_of(RenderOptions))

keep_in_overrides([RENDER_GROUP])

POINTERS = {"rsibr_render": (bpy.types.Scene, RENDER_GROUP)}
"""Name of a property -> its owner, and the group it points to."""

LEFT_OUT = (
    "RSIBR leaves out lamps, shadows but those on shadow catchers, and reflections of objects in each other: "
    "an object is lit by the world, or by the light that its map set was baked in."
)

OTHERS = "BLENDER_EEVEE"
"""The engine whose panels show what is the same for us: materials, worlds, cameras."""

NOT_OURS = (
    *("RENDER_PT_eevee", "RENDER_PT_freestyle", "VIEWLAYER_PT_", "DATA_PT_EEVEE", "DATA_PT_lightprobe"),
    *("EEVEE_WORLD_PT_lightprobe", "EEVEE_WORLD_PT_sun", "SCENE_PT_eevee", "VIEW3D_PT_"),
)
"""How names of panels begin that show what we do not have."""


class _OfEngine:
    """Base of panels that the engine alone has."""

    bl_space_type = "PROPERTIES"
    bl_region_type = "WINDOW"
    COMPAT_ENGINES = {RENDER_ENGINE}  # noqa: RUF012  (Blender reads the class)

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Whether the scene is rendered with it."""
        return bool(context.scene.render.engine == RENDER_ENGINE)


class RSIBR_PT_render(_OfEngine, bpy.types.Panel):
    """How pictures are drawn, and what they leave out"""  # noqa: D400  (a tooltip)

    bl_label = "Sampling"
    bl_context = "render"

    def draw(self, context: bpy.types.Context) -> None:
        """Show the options, and sentences."""
        self.layout.use_property_split = True
        self.layout.prop(context.scene.rsibr_render, "samples")
        tell(self.layout, LEFT_OUT, panel_width(context), icon="INFO")
        if message := session().previews.worlds.message:
            tell(self.layout, message, panel_width(context))


class RSIBR_PT_film(_OfEngine, bpy.types.Panel):
    """What lies behind all objects"""  # noqa: D400  (a tooltip)

    bl_label = "Film"
    bl_context = "render"

    def draw(self, context: bpy.types.Context) -> None:
        """Show what is seen there."""
        self.layout.use_property_split = True
        scene, previews = context.scene, session().previews
        self.layout.prop(scene.render, "film_transparent", text="Transparent")
        column = self.layout.column()
        column.active = not scene.render.film_transparent
        column.prop(scene.rsibr_render, "background", text="Background")
        blur = column.column()
        blur.active = not scene.rsibr_render.background
        blur.prop(scene.rsibr_render, "background_blur")
        column.prop(scene.rsibr_render, "background_exposure")
        for message in filter(None, (previews.behind.backgrounds.message, *previews.behind.floors.messages)):
            tell(self.layout, message, panel_width(context))


class RSIBR_PT_mask(_OfEngine, bpy.types.Panel):
    """What an object is in the picture"""  # noqa: D400  (a tooltip)

    bl_label = "RSIBR"
    bl_context = "object"
    bl_parent_id = "OBJECT_PT_visibility"

    def draw(self, context: bpy.types.Context) -> None:
        """Show the switch that Blender itself shows for Cycles alone."""
        self.layout.use_property_split = True
        self.layout.column(heading="Mask").prop(context.object, "is_shadow_catcher")


class RSIBR_PT_passes(_OfEngine, bpy.types.Panel):
    """What is written beside the picture"""  # noqa: D400  (a tooltip)

    bl_label = "Passes"
    bl_context = "view_layer"

    def draw(self, context: bpy.types.Context) -> None:
        """Show the switches."""
        self.layout.use_property_split = True
        column = self.layout.column(heading="Include")
        for name, switch in SWITCHES.items():
            column.prop(context.view_layer, switch, text=name)


def start(undo: ExitStack) -> None:
    """Have Blender show the panels of what is the same for all engines.

    Parameters
    ----------
    undo : ExitStack
        Takes what ends it.
    """
    for panel in _shared_panels():
        panel.COMPAT_ENGINES.add(RENDER_ENGINE)
        undo.callback(panel.COMPAT_ENGINES.discard, RENDER_ENGINE)


def _shared_panels() -> list[Any]:
    found, left = [], list(bpy.types.Panel.__subclasses__())
    while left:
        panel = left.pop()
        left += panel.__subclasses__()
        engines = getattr(panel, "COMPAT_ENGINES", ())
        if OTHERS in engines and not panel.__name__.startswith(NOT_OURS):
            found.append(panel)
    return found
