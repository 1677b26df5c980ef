"""Which light objects are seen in."""

from contextlib import suppress
from pathlib import Path

import bpy

from ..core.errors import RsibrError
from ..host.bake_settings import chosen_environment
from ..settings.environment import LAYOUTS
from ..tasks.light.light_pictures import light_remarks, offered_layouts
from .sentences import panel_width, tell
from .sidebar import InSidebar

THUMBNAIL_SCALE = 4.0
"""Height of an environment's picture; a button is 1 high."""


def draw_light(layout: bpy.types.UILayout, context: bpy.types.Context) -> None:
    """Show where light comes from, with its picture."""
    chosen = context.scene.rsibr_bake
    layout.row().prop(chosen, "light", expand=True)
    match chosen.light:
        case "WORLD":
            layout.template_ID(context.scene, "world", new="world.new")
        case "STUDIO":
            layout.template_icon_view(chosen, "studio", show_labels=True, scale=THUMBNAIL_SCALE)
            layout.prop(chosen, "studio", text="")
        case _:
            if chosen.image is not None:
                layout.template_icon(bpy.types.UILayout.icon(chosen.image), scale=THUMBNAIL_SCALE)
            layout.prop(chosen, "picture", text="")
            if chosen.image is not None:
                layout.prop(chosen, "layer")
                # The line below the button tells why it cannot be used
                with suppress(RsibrError):
                    picture = Path(chosen_environment(chosen, context.scene) or "")
                    for remark in light_remarks(picture):
                        tell(layout, remark, panel_width(context))
                    _offer_layouts(layout, picture)


def _offer_layouts(layout: bpy.types.UILayout, picture: Path) -> None:
    """Offer to convert a picture that is no latitude-longitude map."""
    for name in offered_layouts(picture):
        row = layout.operator("rsibr.convert_light", text=f"Convert from {LAYOUTS[name].label}")
        row.filepath, row.source_layout, row.use, row.force = str(picture), name, True, True


class RSIBR_MT_pictures(bpy.types.Menu):
    """Make an environment from photographs or a painting"""  # noqa: D400  (a tooltip)

    bl_label = "Make from Pictures"

    def draw(self, context: bpy.types.Context) -> None:
        """List the ways. The result becomes the light, but merged exposures need not be an environment."""
        self.layout.operator("rsibr.merge_brackets", text="Merge Brackets...")
        self.layout.operator("rsibr.unwrap_ball", text="Unwrap Mirror Ball...").use = True
        self.layout.operator("rsibr.assemble_faces", text="Assemble Faces...").use = True
        self.layout.operator("rsibr.lift_painting", text="Lift Painting...").use = True


class RSIBR_PT_light(InSidebar, bpy.types.Panel):
    """Other sources of light, and its limit"""  # noqa: D400  (a tooltip)

    bl_label = "Light"
    bl_parent_id = "RSIBR_PT_advanced"

    def draw(self, context: bpy.types.Context) -> None:
        """Show the limit of radiance, and the ways to make light."""
        chosen, layout = context.scene.rsibr_bake, self.layout
        layout.prop(chosen, "clamp")
        capture = layout.operator(
            "rsibr.capture_environment", text="Capture from Scene...", icon="RENDER_STILL"
        )
        capture.source, capture.use = "OBJECT" if context.object else "CURSOR", True
        layout.menu("RSIBR_MT_pictures", icon="IMAGE_DATA")
