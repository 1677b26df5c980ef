"""Write one web page of the selected objects."""

from contextlib import suppress
from pathlib import Path
from typing import Any

import bpy

from ..rsibr_addon.core.progress import Steps
from ..rsibr_addon.files.kinds.registry import look_types
from ..rsibr_addon.host.map_sets import planned_path
from ..rsibr_addon.host.meshes import TriangleMesh, mesh_of_objects
from ..rsibr_addon.host.option_properties import options_of
from ..rsibr_addon.settings.page import PageOptions
from ..rsibr_addon.tasks.export.page.own_material import in_own_materials
from ..rsibr_addon.tasks.export.page.own_objects import OwnObject
from ..rsibr_addon.tasks.export.page.page import export_page
from ..rsibr_addon.tasks.methods.kinds import kind_of
from ..rsibr_addon.tasks.viewport.looks import wants_own
from .exports_map_set import ExportsMapSet


class RSIBR_OT_export_page(ExportsMapSet, bpy.types.Operator):
    """Write one web page that shows the selected objects in the active object's map set"""  # noqa: D400  (a tooltip)

    bl_idname = "rsibr.export_page"
    bl_label = "Export Web Page"
    SETTINGS = (PageOptions,)

    filter_glob = bpy.props.StringProperty(default="*.html", options={"HIDDEN"})

    def ending(self) -> str:
        """See `ExportsMapSet`."""
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
