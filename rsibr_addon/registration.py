"""What the extension adds to Blender, and how it is taken away again."""

from collections.abc import Sequence
from contextlib import ExitStack

_registered = ExitStack()
"""Undoes what `register` did, last first."""


def register() -> None:
    """Register properties, operators, panels, previews and the command `rsibr`; refused one, none stays."""
    import bpy

    from .. import operators
    from ..operators import background
    from . import properties, ui
    from .ui import bake_properties, viewport

    with ExitStack() as undo:
        for cls in (*properties.CLASSES, *operators.CLASSES, *ui.CLASSES):
            bpy.utils.register_class(cls)
            undo.callback(bpy.utils.unregister_class, cls)
        for name, (owner, group) in (properties.POINTERS | bake_properties.POINTERS).items():
            setattr(owner, name, bpy.props.PointerProperty(type=group))
            undo.callback(delattr, owner, name)
        viewport.start(undo)
        background.start(undo)
        command = bpy.utils.register_cli_command("rsibr", _run_command)
        undo.callback(bpy.utils.unregister_cli_command, command)
        _registered.push(undo.pop_all())


def unregister() -> None:
    """Take away everything that `register` added."""
    _registered.close()


def _run_command(argv: Sequence[str]) -> int:
    """Run `blender --command rsibr ARGV`; loads the commands only then."""
    from .command_line.main import run

    return run(argv)
