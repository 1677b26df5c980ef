"""The operator that bakes lobe stacks does what the command does, and leaves the open file as it was."""

from pathlib import Path

import bpy
import numpy as np
import pytest
from rsibr.rsibr_addon.command_line.main import run
from rsibr.rsibr_addon.files.radiance_pictures import write_radiance
from rsibr.tests.open_file import open_file_state

SPEC = "ggx:alpha=0.4,f0=0.9/0.6/0.3"


@pytest.mark.slow
@pytest.mark.usefixtures("registered")
def test_the_operator_writes_what_the_command_writes(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    write_radiance(tmp_path / "light.exr", np.random.default_rng(7).random((64, 128, 3), dtype=np.float32))
    command = ["bake", "--environment", "light.exr", "--brdf", SPEC, "--lobes", "2", "--slices", "4"]
    assert run([*command, "--size", "16", "--half", "-o", "command.exr"]) == 0
    options = {"environment": "light.exr", "brdf": SPEC, "lobes": 2, "slices": 4, "size": 16, "half": True}
    before = open_file_state()
    assert bpy.ops.rsibr.bake_lobe_stack(filepath="operator.exr", **options) == {"FINISHED"}
    assert open_file_state() == before
    assert Path("operator.exr").read_bytes() == Path("command.exr").read_bytes()
    with pytest.raises(RuntimeError, match=r"operator\.exr exists: .*"):
        bpy.ops.rsibr.bake_lobe_stack(filepath="operator.exr", **options)
