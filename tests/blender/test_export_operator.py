"""Exporting a map set from Blender's menu writes what the command writes."""

from pathlib import Path

import bpy
import pytest
import rsibr
from rsibr.rsibr_addon.command_line.main import run
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
