"""How operators do long work: at a stretch, or step by step while Blender goes on."""

from collections.abc import Callable
from typing import Any, ClassVar

import bpy

from ..rsibr_addon.core.options import Options
from ..rsibr_addon.core.progress import Steps, drain
from ..rsibr_addon.host.option_properties import properties_of
from .reporting import reporting


class Stepwise:
    """Base of operators that do long work, beside `bpy.types.Operator`; adds the property `filepath`.

    Called from a script it works at a stretch; from the interface it asks for the file and takes one step per
    tick of a timer, until Escape.

    Attributes
    ----------
    interrupted : str
        What to say after Escape.
    proposed : str
        Name that the file browser begins with; none where a file is to be chosen.
    SETTINGS : type
        Dataclass of options that the operator has as properties; none where it is not said.
    """

    interrupted: str
    proposed = ""
    SETTINGS: ClassVar[type[Options]]
    filepath: str
    force = bpy.props.BoolProperty(name="Replace", description="Replace the file if it exists")
    report: Callable[[set[str], str], None]
    _asks = False
    _steps: Steps[Any] | None = None

    def __init_subclass__(cls) -> None:
        """Give an operator the properties of its settings."""
        super().__init_subclass__()
        if "SETTINGS" in vars(cls):
            for name, made in properties_of(cls.SETTINGS, by_text=True).items():
                setattr(cls, name, made)

    def work(self, context: bpy.types.Context) -> Steps[Any]:
        """The work, from the operator's properties; may raise our errors at once."""
        raise NotImplementedError

    def finish(self, result: Any) -> None:
        """Take the result, and say that it is there."""
        raise NotImplementedError

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Work at a stretch; or, when the file has been asked for, step by step."""
        if self._asks:
            return self._start(context)
        with reporting(self):
            self.finish(drain(self.work(context)))
            return {"FINISHED"}
        return {"CANCELLED"}

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Ask for a file, or take one step per tick of a timer when it is given."""
        if self.filepath:
            return self._start(context)
        self._asks = True
        if self.proposed:
            # Where a file is to be chosen, the browser must find no name that is set, not even an empty one
            self.filepath = self.proposed
        context.window_manager.fileselect_add(self)
        return {"RUNNING_MODAL"}

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Take a step; Escape ends the work."""
        if event.type == "ESC":
            self.report({"WARNING"}, self.interrupted)
            self.cancel(context)
            return {"CANCELLED"}
        if event.type != "TIMER" or self._steps is None:
            return {"PASS_THROUGH"}
        result = {"CANCELLED"}
        try:
            with reporting(self):
                result = self._step(self._steps, context)
        finally:
            if result != {"RUNNING_MODAL"}:
                self.cancel(context)
        return result

    def cancel(self, context: bpy.types.Context) -> None:
        """Stop; Blender calls this too, when it closes the window or the file, or no file is chosen."""
        if self._steps is None:
            return
        self._steps.close()
        context.window_manager.event_timer_remove(self._timer)
        context.workspace.status_text_set(None)

    def _start(self, context: bpy.types.Context) -> set[str]:
        with reporting(self):
            self._steps = self.work(context)
            self._timer = context.window_manager.event_timer_add(0.01, window=context.window)
            context.window_manager.modal_handler_add(self)
            return {"RUNNING_MODAL"}
        return {"CANCELLED"}

    def _step(self, steps: Steps[Any], context: bpy.types.Context) -> set[str]:
        try:
            progress = next(steps)
        except StopIteration as end:
            self.finish(end.value)
            return {"FINISHED"}
        context.workspace.status_text_set(f"{progress.what} (Esc: interrupt)")
        return {"RUNNING_MODAL"}
