"""What the active object is shaded from."""

import math

import bpy

from ..core.errors import RsibrError
from ..files.kinds.registry import look_types
from ..files.output_paths import comparison_page
from ..host.map_sets import written_path
from ..host.option_properties import options_of
from ..session.running import session
from ..tasks.compare.measured_error import measured_sentence
from ..tasks.report.facts import is_picture, map_set_facts, map_set_fit, map_set_header
from .bakes import draw_progress
from .map_set_file import draw_file, draw_painting
from .sentences import letters_in, panel_width, tell
from .sidebar import InSidebar

MAP_SCALE, LOBES_SCALE = 9.0, 9.0
"""Heights of pictures in panels; a button is 1 high."""


class RSIBR_PT_result(InSidebar, bpy.types.Panel):
    """The active object's map set"""  # noqa: D400  (a tooltip)

    bl_label = "Result"
    bl_parent_id = "RSIBR_PT_advanced"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Whether there is a map set: a picture of an environment has nothing to tell."""
        if context.object is None or not context.object.rsibr.map_set:
            return False
        try:
            return not is_picture(written_path(context.object.rsibr))
        except RsibrError:
            return True

    def draw(self, context: bpy.types.Context) -> None:
        """Show its file, how far off it is, what can be done with it and, on demand, its facts."""
        layout, item = self.layout, context.object
        try:
            path = written_path(item.rsibr)
            facts = map_set_facts(path)
            header = map_set_header(path)
            kind = header["kind"]
            measured = measured_sentence(path, options_of(look_types()[kind], getattr(item.rsibr, kind)))
        except RsibrError as error:
            tell(layout, str(error), panel_width(context))
            return
        draw_file(layout, item, path, panel_width(context))
        draw_painting(layout, item, header)
        if measured:
            tell(layout, measured, panel_width(context), icon="INFO")
        row = layout.row(align=True)
        row.operator("rsibr.open_report", icon="URL")
        row.operator("rsibr.compare", icon="MOD_DATA_TRANSFER")
        layout.operator("rsibr.export_page", icon="WORLD")
        page = comparison_page(path)
        if (comparing := session().bakes.unfinished(page)) is not None:
            draw_progress(layout, comparing, panel_width(context))
        elif measured and page.is_file():
            layout.operator("rsibr.open_comparison", icon="URL")
        title, opened = layout.panel("RSIBR_result_details", default_closed=True)
        title.label(text="Details")
        if opened:
            _draw_facts(opened.column(align=True), facts, panel_width(context))


def _draw_facts(column: bpy.types.UILayout, facts: dict[str, str], width: int) -> None:
    """Show what there is to tell beside its name, or below that where a line is too short for both."""
    for what, which in facts.items():
        row = column.row()
        row.label(text=what)
        if len(what) + len(which) < letters_in(width):
            value = row.row()
            value.alignment = "RIGHT"
            value.label(text=which)
        else:
            tell(column, which, width, icon="BLANK1")


class RSIBR_PT_result_maps(InSidebar, bpy.types.Panel):
    """The maps that the map set holds, as pictures"""  # noqa: D400  (a tooltip)

    bl_label = "Maps"
    bl_parent_id = "RSIBR_PT_result"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Whether there is a map set that can be read."""
        try:
            map_set_facts(written_path(context.object.rsibr))
        except RsibrError:
            return False
        return True

    def draw(self, context: bpy.types.Context) -> None:
        """Show one of them large; a click on it shows all."""
        map_pictures = session().map_pictures
        map_pictures.show(written_path(context.object.rsibr))
        if map_pictures.fault:
            tell(self.layout, map_pictures.fault, panel_width(context))
            return
        if not map_pictures.items:
            self.layout.label(text="Reading...", icon="TIME")
            return
        shown = context.window_manager.rsibr_result
        self.layout.template_icon_view(shown, "part", show_labels=True, scale=MAP_SCALE, scale_popup=5.0)
        self.layout.prop(shown, "part", text="")


class RSIBR_PT_result_lobes(InSidebar, bpy.types.Panel):
    """The lobes that the map set's reflectance was made of"""  # noqa: D400  (a tooltip)

    bl_label = "Lobes"
    bl_parent_id = "RSIBR_PT_result"
    bl_options = {"DEFAULT_CLOSED"}  # noqa: RUF012  (Blender reads the class)

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Whether the file tells of lobes."""
        try:
            return map_set_fit(written_path(context.object.rsibr)) is not None
        except RsibrError:
            return False

    def draw(self, context: bpy.types.Context) -> None:
        """Show them for one view."""
        path, layout = written_path(context.object.rsibr), self.layout
        fit = map_set_fit(path)
        if fit is None:  # The file has been replaced since `poll`
            return
        shown = context.window_manager.rsibr_result
        map_pictures = session().map_pictures
        map_pictures.show(path)
        layout.template_icon(map_pictures.lobes(fit, math.cos(shown.angle)), scale=LOBES_SCALE)
        row = layout.row()
        row.use_property_split = True
        row.prop(shown, "angle", slider=True)
        layout.label(text="Colours: the lobes; black: their sum.")
