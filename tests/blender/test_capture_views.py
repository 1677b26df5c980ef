"""The operator: what the task does, from Blender's own interface."""

from collections.abc import Iterator
from pathlib import Path

import bpy
import pytest
import rsibr
from rsibr.rsibr_addon.core.progress import drain
from rsibr.rsibr_addon.job import BakeJob
from rsibr.rsibr_addon.settings.radiance_views import RadianceViewsSettings
from rsibr.rsibr_addon.tasks.methods.bake import bake
from rsibr.rsibr_addon.tasks.queue.bake_request import request_for
from rsibr.tests.open_file import open_file_state

pytestmark = [pytest.mark.needs("cycles"), pytest.mark.usefixtures("quick_furnace")]


@pytest.fixture(autouse=True)
def _registered(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    monkeypatch.setattr("rsibr.rsibr_addon.tasks.light.environments.WORLD_HEIGHT", 16)
    rsibr.register()
    yield
    rsibr.unregister()


@pytest.mark.slow
def test_the_operator_writes_what_the_task_writes(tmp_path: Path) -> None:
    by_operator, by_task = tmp_path / "operator.exr", tmp_path / "task.exr"
    before = open_file_state()
    result = bpy.ops.rsibr.bake_radiance_views(
        filepath=str(by_operator), size=8, samples=2, denoise=False, seed=5
    )
    assert result == {"FINISHED"}
    assert open_file_state() == before
    settings = RadianceViewsSettings(material=":Material", size=8, samples=2, denoise=False, seed=5)
    drain(bake(BakeJob(settings, str(by_task))))
    assert by_operator.read_bytes() == by_task.read_bytes()


@pytest.mark.slow
def test_a_material_can_be_named(tmp_path: Path) -> None:
    bpy.data.materials["Material"].copy().name = "Paint"
    path = tmp_path / "paint.exr"
    bpy.ops.rsibr.bake_radiance_views(filepath=str(path), material=":Paint", size=8, samples=2)
    assert path.exists()


def test_errors_are_reports(tmp_path: Path) -> None:
    path = tmp_path / "out.exr"
    path.write_text("precious")
    before = open_file_state()
    with pytest.raises(RuntimeError, match=r"out\.exr exists: .*"):
        bpy.ops.rsibr.bake_radiance_views(filepath=str(path))
    with pytest.raises(RuntimeError, match="This file holds no material Gold: choose one of"):
        bpy.ops.rsibr.bake_radiance_views(filepath=str(tmp_path / "new.exr"), material=":Gold")
    assert open_file_state() == before
    bpy.context.view_layer.objects.active = bpy.data.objects["Camera"]
    with pytest.raises(RuntimeError, match="There is no material to bake: select an object"):
        bpy.ops.rsibr.bake_radiance_views(filepath=str(tmp_path / "new.exr"))
    assert path.read_text() == "precious"
    assert list(tmp_path.iterdir()) == [path]


@pytest.mark.slow
def test_warnings_are_reports_too(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    bsdf = bpy.data.materials["Material"].node_tree.nodes["Principled BSDF"]
    bsdf.inputs["Anisotropic"].default_value = 0.5
    bpy.ops.rsibr.bake_radiance_views(filepath=str(tmp_path / "out.exr"), size=8, samples=2)
    assert "No radiance map can hold :Material" in "".join(capfd.readouterr())


def test_the_panel_takes_a_model_or_a_measurement_for_radiance_views(tmp_path: Path) -> None:
    chosen = bpy.context.scene.rsibr_bake
    chosen.kind, group = "radiance_views", chosen.radiance_views
    assert group.source == "OWN"

    def material() -> str:
        return request_for(chosen, bpy.context.scene, bpy.context.object).settings.material

    assert material() == ":Material"
    group.source, group.material = "MODEL", "ward:alpha=0.1,ks=0.8"
    assert material() == "ward:alpha=0.1,ks=0.8"
    measured = tmp_path / "paint.binary"
    measured.touch()
    group.source, group.path = "FILE", str(measured)
    assert material() == f"merl:path={measured}"
