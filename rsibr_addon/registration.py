"""What the extension adds to Blender, and how it is taken away again."""

from collections.abc import Sequence
from contextlib import ExitStack

_registered = ExitStack()
"""Undoes what `register` did, last first."""


def register() -> None:
    """Register properties, operators, panels, previews and the command `rsibr`; refused one, none stays."""
    import bpy

    from .. import operators
    from ..operators import background, keep_fresh
    from . import properties, ui
    from .host.baked_beside import bring_baked_files
    from .host.handlers import add_handlers
    from .host.map_sets import unpacked
    from .host.overrides import complete_overrides
    from .host.painted import keep_paint, painted_files
    from .session.running import begun_session
    from .ui import (
        bake_properties,
        export_menu,
        render_engine,
        render_panel,
        result_properties,
        viewport_handlers,
    )

    with ExitStack() as undo:
        undo.enter_context(begun_session(has_windows=not bpy.app.background))
        for cls in (*properties.CLASSES, *operators.CLASSES, *ui.CLASSES):
            properties.annotate(cls)
            bpy.utils.register_class(cls)
            undo.callback(bpy.utils.unregister_class, cls)
        pointers = properties.POINTERS | bake_properties.POINTERS | result_properties.POINTERS
        pointers = pointers | render_panel.POINTERS
        for name, (owner, group) in pointers.items():
            pointer = bpy.props.PointerProperty(type=group, override=properties.OVERRIDABLE)
            setattr(owner, name, pointer)
            undo.callback(delattr, owner, name)
        add_handlers(dict.fromkeys(("load_post", "blend_import_post", "save_pre"), complete_overrides), undo)
        add_handlers({"save_pre": keep_paint}, undo)
        add_handlers({"save_pre": bring_baked_files}, undo)
        undo.callback(unpacked.remove)
        undo.callback(painted_files.remove)
        viewport_handlers.start(undo)
        render_engine.start(undo)
        render_panel.start(undo)
        export_menu.start(undo)
        keep_fresh.start(undo)
        undo.callback(background.stop)
        command = bpy.utils.register_cli_command("rsibr", _run_command)
        undo.callback(bpy.utils.unregister_cli_command, command)
        _registered.push(undo.pop_all())


def unregister() -> None:
    """Take away everything that `register` added."""
    _registered.close()


def _run_command(argv: Sequence[str]) -> int:
    """Run `blender --command rsibr ARGV`; loads the commands only then."""
    import bpy

    from .command_line.main import run_alone

    return run_alone(argv, bpy.app.tempdir)
