"""What *Compare* in the panel asks for."""

from pathlib import Path

import bpy
import pytest
from rsibr.rsibr_addon.command_line.commands import parsed
from rsibr.rsibr_addon.command_line.options import given
from rsibr.rsibr_addon.core.errors import MapSetError, SceneError
from rsibr.rsibr_addon.files.map_set import write_map_set
from rsibr.rsibr_addon.job import CommandJob, read_job
from rsibr.rsibr_addon.session.running import session
from rsibr.rsibr_addon.settings.kernel_pyramid import PyramidComparison
from rsibr.rsibr_addon.tasks.queue.bake_request import (
    comparison_of,
)
from rsibr.tests.bake_jobs import run_job
from rsibr.tests.blender.bake_orders import order, output
from rsibr.tests.faults.small_map_sets import map_sets
from rsibr.tests.flat_capture import write_flat_capture

pytestmark = pytest.mark.usefixtures("panel")


def test_a_comparison_is_queued_once_and_its_page_opens_again(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(
        "rsibr.rsibr_addon.tasks.queue.bake_request.blender_program", lambda: "no-such-program"
    )
    write_flat_capture(tmp_path / "flat.rsibr.exr", (0.5, 0.0, 0.5))
    bpy.context.object.rsibr.map_set = str(tmp_path / "flat.rsibr.exr")
    with pytest.raises(RuntimeError, match=r"There is no comparison of flat\.rsibr\.exr: press Compare"):
        bpy.ops.rsibr.open_comparison()
    bakes = session().bakes
    monkeypatch.setattr(type(bakes), "update", lambda queue: [])  # all wait
    for _ in range(2):
        assert bpy.ops.rsibr.compare() == {"FINISHED"}
    assert [bake.output for bake in bakes.bakes] == [tmp_path / "flat-compared" / "index.html"]
    bakes.close()


def test_a_comparison_is_a_job_with_a_page(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("rsibr.rsibr_addon.tasks.queue.bake_request.blender_program", lambda: "blender")
    path = tmp_path / "flat.rsibr.exr"
    write_flat_capture(path, (0.5, 0.0, 0.5))
    comparison = comparison_of(bpy.context.scene, bpy.context.object, path)
    job = read_job(Path(comparison.command[11]).read_text(), "job")
    comparison.tidy()
    assert comparison.output == tmp_path / "flat-compared" / "index.html"
    assert isinstance(job, CommandJob)
    assert parsed(job.arguments).output == comparison.output.parent
    chosen = bpy.context.scene.rsibr_bake
    chosen.kind, chosen.kernel_bank.size = "kernel_bank", "64"
    bank = output()
    assert run_job(order().job(bank), tmp_path) == 0
    with pytest.raises(MapSetError, match="is of a kind without a truth to compare with"):
        comparison_of(bpy.context.scene, bpy.context.object, bank)


def test_one_material_is_compared_as_it_is_shown_and_own_ones_are_not(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("rsibr.rsibr_addon.tasks.queue.bake_request.blender_program", lambda: "blender")
    (pyramid,) = (each for each in map_sets() if each.kind == "kernel_pyramid")
    path, item = tmp_path / "light.rsibr.exr", bpy.context.object
    write_map_set(path, pyramid)
    item.rsibr.map_set = str(path)
    assert not bpy.ops.rsibr.compare.poll()
    with pytest.raises(SceneError, match="Object Cube is shaded with its own materials"):
        comparison_of(bpy.context.scene, item, path)
    look = item.rsibr.kernel_pyramid
    look.own, look.metallic, look.base_color = False, 1.0, (0.9, 0.6, 0.3)
    assert bpy.ops.rsibr.compare.poll()
    comparison = comparison_of(bpy.context.scene, item, path)
    job = read_job(Path(comparison.command[11]).read_text(), "job")
    comparison.tidy()
    assert isinstance(job, CommandJob)
    settings = given(parsed(job.arguments), PyramidComparison)
    assert settings.text == "principled:base_color=0.9/0.6/0.3,metallic=1.0"
