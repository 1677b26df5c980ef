"""Save the active object's painted tables as a map set."""

from pathlib import Path

import bpy

from ..rsibr_addon.files.output_paths import HASH_LETTERS, bare_name
from ..rsibr_addon.host.map_sets import planned_path, stored_path, use_map_set, written_file
from ..rsibr_addon.host.painted import end_painting, write_painted
from ..rsibr_addon.host.preferences import baked_folder, make_writable
from ..rsibr_addon.tasks.queue.bake_request import plain_name
from .at_once import Undoable

PAINTED = "-painted"
"""What the file's name has before its hash."""


class RSIBR_OT_save_back(Undoable, bpy.types.Operator):
    """Write the painted tables as a map set that tells what it was painted of, and shade the object from it. The old file stays"""  # noqa: D400, E501  (a tooltip)

    bl_idname = "rsibr.save_back"
    bl_label = "Save Back"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Whether tables are painted."""
        item = context.object
        return item is not None and item.is_editable and bool(item.rsibr.painted)

    def work(self, context: bpy.types.Context) -> None:
        """Write it into the folder of baked files."""
        settings = context.object.rsibr
        shown = Path(planned_path(settings))
        before = bare_name(Path(plain_name(shown))).removesuffix(PAINTED)
        digest = shown.parent.name[:HASH_LETTERS]
        path = baked_folder() / f"{before}{PAINTED}-{digest}.rsibr.exr"
        if not path.is_file():  # else the same was saved before, and undone since
            make_writable(path.parent)
            write_painted(path, settings, written_file(settings))
        end_painting(settings)
        use_map_set(settings, stored_path(path))
        self.report({"INFO"}, f"Wrote {path}")
