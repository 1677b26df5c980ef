"""Write the light of the active object's map set as an engine loads it."""

import os
from pathlib import Path
from textwrap import wrap
from typing import Any

import bpy

from ..rsibr_addon.core.options import declared_options
from ..rsibr_addon.core.progress import Steps
from ..rsibr_addon.host.option_properties import options_of
from ..rsibr_addon.tasks.export.engines.engines import ENGINES
from ..rsibr_addon.tasks.export.engines.export import export_for_engine
from .exports_map_set import ExportsMapSet

ENDINGS = {ending for each in ENGINES.values() for ending in each.endings}
"""What the dialog takes away; other names may have dots in them."""

COLUMNS = 40
"""Letters in a line of the file dialog's options."""


class RSIBR_OT_export_for_engine(ExportsMapSet, bpy.types.Operator):
    """Write the light of the active object's map set for one engine, exactly as that loads it"""  # noqa: D400  (a tooltip)

    bl_idname = "rsibr.export_for_engine"
    bl_label = "Export Light for an Engine"
    SETTINGS = tuple(each.settings for each in ENGINES.values())

    engine = bpy.props.EnumProperty(
        name="Engine",
        description="Engine that will load the file",
        items=[(name, each.label, each.use[:1].upper() + each.use[1:]) for name, each in ENGINES.items()],
    )

    def ending(self: Any) -> str:
        """The ending that the name has, if the engine takes it, else the engine's first."""
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
