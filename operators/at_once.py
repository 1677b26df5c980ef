"""What operators share that do their work at once."""

from collections.abc import Callable

import bpy

from .reporting import reporting


class AtOnce:
    """Base of an operator whose `work` takes a moment; our errors and warnings become reports."""

    report: Callable[[set[str], str], None]

    def work(self, context: bpy.types.Context) -> None:
        """Do it; may raise our errors."""
        raise NotImplementedError

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Do the work."""
        with reporting(self):
            self.work(context)
            return {"FINISHED"}
        return {"CANCELLED"}


class Undoable(AtOnce):
    """The same, of an operator that changes the open file."""

    bl_options = {"REGISTER", "UNDO"}  # noqa: RUF012  (Blender reads the class)
