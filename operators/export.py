"""Write the active object's map set for other programs: for each format, for engines, and as a web page."""

import os
from collections import ChainMap
from contextlib import suppress
from pathlib import Path
from textwrap import wrap
from typing import Any

import bpy

from ..rsibr_addon.core.options import declared_options
from ..rsibr_addon.core.progress import Steps, drain
from ..rsibr_addon.files.kinds.registry import look_types
from ..rsibr_addon.files.output_paths import bare_name
from ..rsibr_addon.host.map_sets import planned_path, written_path
from ..rsibr_addon.host.meshes import TriangleMesh, mesh_of_objects
from ..rsibr_addon.host.option_properties import options_of, properties_of
from ..rsibr_addon.settings.page import PageOptions
from ..rsibr_addon.tasks.export.engines.engines import ENGINES
from ..rsibr_addon.tasks.export.engines.export import export_for_engine
from ..rsibr_addon.tasks.export.export import export
from ..rsibr_addon.tasks.export.format import Format
from ..rsibr_addon.tasks.export.formats import FORMATS
from ..rsibr_addon.tasks.export.page.own_material import in_own_materials
from ..rsibr_addon.tasks.export.page.own_objects import OwnObject
from ..rsibr_addon.tasks.export.page.page import export_page
from ..rsibr_addon.tasks.methods.kinds import kind_of
from ..rsibr_addon.tasks.viewport.looks import wants_own
from .file_properties import file_path
from .reporting import reporting


class _Export:
    """Write the active object's map set for game engines and the web"""  # noqa: D400  (a tooltip)

    bl_label = "Export Reflection Maps"

    filepath = file_path("File")
    check_existing = bpy.props.BoolProperty(default=True, options={"HIDDEN"})

    @classmethod
    def poll(cls: Any, context: bpy.types.Context) -> bool:
        """Whether there is a map set."""
        if context.object is None or not context.object.rsibr.map_set:
            cls.poll_message_set("The active object has no map set: bake or assign one.")
            return False
        return True

    def execute(self: Any, context: bpy.types.Context) -> set[str]:
        """Export; who has chosen a file in Blender's dialog has agreed to replace it."""
        with reporting(self):
            map_set, output = written_path(context.object.rsibr), Path(bpy.path.abspath(self.filepath))
            for texture in drain(self.exporting(map_set, output, self.options.is_invoke)):
                self.report({"INFO"}, f"Wrote {texture}")
            return {"FINISHED"}
        return {"CANCELLED"}

    def invoke(self: Any, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Ask for the file."""
        name = bare_name(Path(planned_path(context.object.rsibr)))
        self.filepath = f"{name}{self.ending()}"
        context.window_manager.fileselect_add(self)
        return {"RUNNING_MODAL"}


class _ExportFormat(_Export):
    exported: Format

    def ending(self) -> str:
        """Of the files' names."""
        return self.exported.suffix

    def exporting(self: Any, map_set: Path, output: Path, force: bool) -> Steps[list[Path]]:
        """See `export`."""
        return export(map_set, output, options_of(self.exported.settings, self), force)


def _operator(name: str, exported: Format) -> type:
    filter_glob = bpy.props.StringProperty(default=f"*{exported.suffix}", options={"HIDDEN"})
    own = {
        "__doc__": _Export.__doc__,
        "bl_idname": f"rsibr.export_{name}",
        "exported": exported,
        "filter_glob": filter_glob,
    }
    return type(
        f"RSIBR_OT_export_{name}", (_ExportFormat, bpy.types.Operator), own | properties_of(exported.settings)
    )


class _ExportForEngine(_Export):
    """Write the light of the active object's mip chain for one engine, exactly as that loads it"""  # noqa: D400

    bl_idname = "rsibr.export_for_engine"
    bl_label = "Export Light for an Engine"

    engine = bpy.props.EnumProperty(
        name="Engine",
        description="Engine that will load the file",
        items=[(name, each.label, each.use[:1].upper() + each.use[1:]) for name, each in ENGINES.items()],
    )

    def ending(self: Any) -> str:
        """Of the files' names: the one that the name has, if the engine takes it, else its first."""
        endings = ENGINES[self.engine].endings
        has = Path(self.filepath).suffix.lower()
        return has if has in endings else endings[0]

    def exporting(self: Any, map_set: Path, output: Path, force: bool) -> Steps[list[Path]]:
        """See `export_for_engine`."""
        return export_for_engine(
            map_set, output, self.engine, options_of(ENGINES[self.engine].settings, self), force
        )

    def check(self: Any, context: bpy.types.Context) -> bool:
        """Have the name end as the engine wants it; where there is none yet, the folder stays."""
        path = Path(self.filepath)
        if not os.path.basename(self.filepath):
            return False
        bare = path.with_suffix("") if path.suffix.lower() in ENDINGS else path
        wanted = f"{bare}{self.ending()}"
        changed = bool(wanted != self.filepath)
        self.filepath = wanted
        return changed

    def draw(self: Any, context: bpy.types.Context) -> None:
        """Show the options, and what to do with the file in the engine."""
        self.layout.prop(self, "engine")
        for line in wrap(f"There, {ENGINES[self.engine].use}.", COLUMNS, break_on_hyphens=False):
            self.layout.label(text=line)
        for declared in declared_options(ENGINES[self.engine].settings):
            self.layout.prop(self, declared.name)


ENDINGS = {ending for each in ENGINES.values() for ending in each.endings}
"""What the dialog takes away; other names may have dots in them."""

COLUMNS = 40
"""Letters in a line of the file dialog's options."""

EXPORT_FOR_ENGINE = type(
    "RSIBR_OT_export_for_engine",
    (_ExportForEngine, bpy.types.Operator),
    {
        "__doc__": _ExportForEngine.__doc__,
        **ChainMap(*(properties_of(each.settings) for each in ENGINES.values())),
    },
)


class _ExportPage(_Export):
    """Write one web page that shows the selected objects in the active object's map set"""  # noqa: D400

    bl_idname = "rsibr.export_page"
    bl_label = "Export Web Page"

    filter_glob = bpy.props.StringProperty(default="*.html", options={"HIDDEN"})

    def ending(self) -> str:
        """Of the file's name."""
        return ".html"

    def invoke(self: Any, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Ask for the file; the dialog shows the scene's view."""
        self.show_as_scene(context.scene)
        return super().invoke(context, event)

    def show_as_scene(self: Any, scene: bpy.types.Scene) -> None:
        """Have what nobody chose be the scene's; a view transform that pages do not know stays ours."""
        if not self.properties.is_property_set("exposure", ghost=False):
            self.exposure = scene.view_settings.exposure
        if not self.properties.is_property_set("view_transform", ghost=False):
            with suppress(TypeError):
                self.view_transform = scene.view_settings.view_transform

    def exporting(self: Any, map_set: Path, output: Path, force: bool) -> Steps[list[Path]]:
        """See `export_page`."""
        active = bpy.context.object
        shading = planned_path(active.rsibr)
        alike = [
            item
            for item in bpy.context.selected_objects
            if item.rsibr.map_set and planned_path(item.rsibr) == shading
        ]
        items, depsgraph = alike or [active], bpy.context.evaluated_depsgraph_get()
        kind = kind_of(map_set)
        look = options_of(look_types()[kind], getattr(active.rsibr, kind))
        self.show_as_scene(bpy.context.scene)
        shown: TriangleMesh | list[OwnObject]
        if wants_own(active, kind):
            shown, look = in_own_materials(items, depsgraph, look)
        else:
            shown = mesh_of_objects(items, depsgraph)
        return export_page(map_set, output, options_of(PageOptions, self), shown, look, force)


EXPORT_PAGE = type(
    "RSIBR_OT_export_page",
    (_ExportPage, bpy.types.Operator),
    {
        "__doc__": _ExportPage.__doc__,
        **properties_of(PageOptions),
    },
)

CLASSES = (
    *(_operator(name, exported) for name, exported in FORMATS.items()),
    EXPORT_FOR_ENGINE,
    EXPORT_PAGE,
)
