"""Write the active object's map set as textures: one operator for each format."""

from pathlib import Path
from typing import Any

import bpy

from ..rsibr_addon.core.progress import Steps
from ..rsibr_addon.host.option_properties import options_of
from ..rsibr_addon.tasks.export.export import export
from ..rsibr_addon.tasks.export.format import Format
from ..rsibr_addon.tasks.export.formats import FORMATS
from .exports_map_set import ExportsMapSet


class _ExportFormat(ExportsMapSet):
    """Base of the operators; their properties are the options of the format."""

    SETTINGS = ()
    exported: Format

    def ending(self) -> str:
        """See `ExportsMapSet`."""
        return self.exported.suffix

    def exporting(self, map_set: Path, output: Path, force: bool) -> Steps[list[Path]]:
        """See `export`."""
        return export(map_set, output, options_of(self.exported.settings, self), force)


def _operator(name: str, exported: Format) -> type[bpy.types.Operator]:
    members: dict[str, Any] = {
        "__doc__": "Write the active object's map set for game engines and the web",
        "bl_idname": f"rsibr.export_{name}",
        "exported": exported,
        "filter_glob": bpy.props.StringProperty(default=f"*{exported.suffix}", options={"HIDDEN"}),
        "SETTINGS": (exported.settings,),
    }
    return type(f"RSIBR_OT_export_{name}", (_ExportFormat, bpy.types.Operator), members)


CLASSES = tuple(_operator(name, exported) for name, exported in FORMATS.items())
"""Every operator's class."""
