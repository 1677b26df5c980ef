"""What operators share that write the active object's map set for other programs."""

from collections import ChainMap
from pathlib import Path
from typing import Any, ClassVar

import bpy

from ..rsibr_addon.core.options import Options
from ..rsibr_addon.core.progress import Steps, drain
from ..rsibr_addon.files.output_paths import bare_name
from ..rsibr_addon.host.map_sets import planned_path, written_path
from ..rsibr_addon.host.option_properties import properties_of
from .file_properties import file_path
from .reporting import reporting


class ExportsMapSet:
    """Base of operators that export, beside `bpy.types.Operator`.

    Attributes
    ----------
    SETTINGS : tuple of type
        Dataclasses of options that the operator has as properties; of what several have, the first counts.
    """

    SETTINGS: ClassVar[tuple[type[Options], ...]]
    bl_label = "Export Reflection Maps"

    filepath = file_path("File")
    check_existing = bpy.props.BoolProperty(default=True, options={"HIDDEN"})

    def __init_subclass__(cls) -> None:
        """Give an operator the properties of its settings."""
        super().__init_subclass__()
        for name, made in ChainMap(*map(properties_of, cls.SETTINGS)).items():
            setattr(cls, name, made)

    def ending(self) -> str:
        """Of the files' names."""
        raise NotImplementedError

    def exporting(self, map_set: Path, output: Path, force: bool) -> Steps[list[Path]]:
        """Write the files, and give their paths; may raise our errors."""
        raise NotImplementedError

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
