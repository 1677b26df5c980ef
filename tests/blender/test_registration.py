"""The extension comes and goes without a trace."""

import bpy
import pytest
import rsibr
from rsibr.operators import CLASSES
from rsibr.rsibr_addon import properties, registration


def of_ours() -> set[str]:
    """What Blender holds that carries the project's name."""
    types = {name for name in dir(bpy.types) if name.lower().startswith("rsibr")}
    properties = {
        f"{owner.__name__}.{name}"
        for owner in (bpy.types.Scene, bpy.types.Object, bpy.types.Material, bpy.types.WindowManager)
        for name in owner.bl_rna.properties.keys()  # noqa: SIM118  (a bpy collection iterates its values)
        if name.startswith("rsibr")
    }
    handlers = {
        f"{kind}.{function.__name__}"
        for kind in dir(bpy.app.handlers)
        if isinstance(functions := getattr(bpy.app.handlers, kind), list)
        for function in functions
        if "rsibr" in function.__module__
    }
    return types | properties | handlers | {f"rsibr.{name}" for name in dir(bpy.ops.rsibr)}


def test_enable_disable_enable_leaves_nothing_behind(capfd: pytest.CaptureFixture[str]) -> None:
    assert of_ours() == set()
    for _ in range(2):
        rsibr.register()
        try:
            assert {f"rsibr.{cls.bl_idname.partition('.')[2]}" for cls in CLASSES} <= of_ours()
        finally:
            rsibr.unregister()
        assert of_ours() == set()
    # Blender only prints a warning when a command's name is taken
    assert "rsibr" not in "".join(capfd.readouterr())


def test_blender_would_warn_of_a_command_left_behind(capfd: pytest.CaptureFixture[str]) -> None:
    rsibr.register()
    try:
        taken = bpy.utils.register_cli_command("rsibr", lambda argv: 0)
        bpy.utils.unregister_cli_command(taken)
        assert "rsibr" in "".join(capfd.readouterr())
    finally:
        rsibr.unregister()


def test_a_refused_class_leaves_none_registered(monkeypatch: pytest.MonkeyPatch) -> None:
    class RSIBR_OT_first(bpy.types.Operator):  # noqa: N801
        bl_idname = "rsibr.first"
        bl_label = "First"

    class NotOfBlender:
        pass

    monkeypatch.setattr("rsibr.operators.CLASSES", (RSIBR_OT_first, NotOfBlender))
    with pytest.raises(RuntimeError, match="bl_rna"):
        registration.register()
    assert of_ours() == set()


def test_properties_of_a_class_and_of_its_mixins_are_blenders() -> None:
    class Sized:
        size = bpy.props.IntProperty(default=3)

    class RSIBR_OT_measure(Sized, bpy.types.Operator):  # noqa: N801
        bl_idname = "rsibr.measure"
        bl_label = "Measure"
        unit = bpy.props.StringProperty(default="m")

        def execute(self, context: bpy.types.Context) -> set[str]:
            seen.append((self.size, self.unit))
            return {"FINISHED"}

    seen: list[tuple[int, str]] = []
    for size in (7, 8):  # The second time, they are annotated already
        properties.annotate(RSIBR_OT_measure)
        bpy.utils.register_class(RSIBR_OT_measure)
        bpy.ops.rsibr.measure(size=size)
        bpy.utils.unregister_class(RSIBR_OT_measure)
    assert seen == [(7, "m"), (8, "m")]
