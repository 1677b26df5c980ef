"""Exporting a map set from Blender's menu writes what the command writes."""

from pathlib import Path
from types import SimpleNamespace

import bpy
import pytest
import rsibr
from rsibr.operators.export_for_engine import RSIBR_OT_export_for_engine
from rsibr.rsibr_addon.command_line.main import run
from rsibr.rsibr_addon.core.options import declared_options
from rsibr.rsibr_addon.tasks.export.engines.engines import ENGINES
from rsibr.tests.files.test_export import chain_file
from rsibr.tests.open_file import open_file_state


def test_the_operator_writes_what_the_command_writes(tmp_path: Path) -> None:
    source, by_command = chain_file(tmp_path), tmp_path / "command.ktx2"
    assert run(["export", str(source), "-o", str(by_command), "--up", "y"]) == 0
    rsibr.register()
    try:
        with pytest.raises(RuntimeError, match=r"The active object has no map set: bake or assign one"):
            bpy.ops.rsibr.export_ktx2(filepath=str(tmp_path / "none.ktx2"))
        bpy.ops.rsibr.assign(filepath=str(source))
        before = open_file_state()
        exported = {"filepath": str(tmp_path / "operator.ktx2"), "up": "y"}
        assert bpy.ops.rsibr.export_ktx2(**exported) == {"FINISHED"}
        assert open_file_state() == before
        with pytest.raises(RuntimeError, match=r"operator\.ktx2 exists"):
            bpy.ops.rsibr.export_ktx2(**exported)
    finally:
        rsibr.unregister()
    assert (tmp_path / "operator.ktx2").read_bytes() == by_command.read_bytes()
    assert not (tmp_path / "none.ktx2").exists()


def test_the_operator_for_engines_writes_what_the_command_writes(tmp_path: Path) -> None:
    source = chain_file(tmp_path)
    command = ["export", str(source), "--for", "three", "--size", "16", "-o", str(tmp_path / "command.dds")]
    assert run(command) == 0
    rsibr.register()
    try:
        bpy.ops.rsibr.assign(filepath=str(source))
        before = open_file_state()
        exported = {"filepath": str(tmp_path / "operator.dds"), "engine": "three", "size": 16}
        assert bpy.ops.rsibr.export_for_engine(**exported) == {"FINISHED"}
        assert open_file_state() == before
        with pytest.raises(RuntimeError, match=r"operator\.dds exists"):
            bpy.ops.rsibr.export_for_engine(**exported)
        with pytest.raises(RuntimeError, match=r"three\.js takes cubes from 16 texels on, not of 8"):
            bpy.ops.rsibr.export_for_engine(**{**exported, "filepath": str(tmp_path / "new.dds"), "size": 0})
        engines = bpy.ops.rsibr.export_for_engine.get_rna_type().properties["engine"].enum_items
        assert {each.identifier: each.name for each in engines} == {
            name: engine.label for name, engine in ENGINES.items()
        }
    finally:
        rsibr.unregister()
    assert (tmp_path / "operator.dds").read_bytes() == (tmp_path / "command.dds").read_bytes()
    assert not (tmp_path / "new.dds").exists()


@pytest.mark.parametrize(
    ("engine", "name", "wanted"),
    [
        ("three", "court.ktx2", "court.ktx2"),
        ("three", "court.env", "court.dds"),
        ("gltf", "a.b.dds", "a.b.glb"),
        ("three", "court.v2", "court.v2.dds"),
        ("three", "/folder/", "/folder/"),
        ("three", "/", "/"),
    ],
)
def test_the_name_in_the_dialog_ends_as_the_engine_wants(engine: str, name: str, wanted: str) -> None:
    dialog = SimpleNamespace(engine=engine, filepath=name)
    dialog.ending = lambda: RSIBR_OT_export_for_engine.ending(dialog)
    assert RSIBR_OT_export_for_engine.check(dialog, bpy.context) == (name != wanted)
    assert dialog.filepath == wanted


@pytest.mark.usefixtures("registered")
@pytest.mark.parametrize("engine", ENGINES)
def test_the_dialog_shows_what_the_engine_takes_and_what_to_do_there(engine: str) -> None:
    shown, told = [], []
    layout = SimpleNamespace(prop=lambda _, name: shown.append(name), label=lambda text: told.append(text))
    RSIBR_OT_export_for_engine.draw(SimpleNamespace(engine=engine, layout=layout), bpy.context)
    options = {each.name for each in declared_options(ENGINES[engine].settings)}
    assert shown[0] == "engine"
    assert set(shown[1:]) == options
    assert set(shown) <= set(bpy.ops.rsibr.export_for_engine.get_rna_type().properties.keys())
    assert ENGINES[engine].use in " ".join(told)
    # As wide as a sidebar of Blender's file dialog shows
    assert max(map(len, told)) <= 40
