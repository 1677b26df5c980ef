"""A bake of the open scene that other machines do is the bake of the open file."""

import json
import re
import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import bpy
import pytest
import rsibr
from rsibr.rsibr_addon.command_line.main import run
from rsibr.rsibr_addon.core.errors import RsibrError
from rsibr.rsibr_addon.core.progress import drain
from rsibr.rsibr_addon.files.output_paths import portable_name
from rsibr.rsibr_addon.job import BakeJob
from rsibr.rsibr_addon.settings.baked_inputs import BakedInputsSettings, ObjectInputsSettings
from rsibr.rsibr_addon.tasks.batch.bakes import parts_of
from rsibr.rsibr_addon.tasks.farm import send
from rsibr.rsibr_addon.tasks.farm.folder import bakes_to_send
from rsibr.rsibr_addon.tasks.light import environments
from rsibr.rsibr_addon.tasks.methods.bake import bake
from rsibr.rsibr_addon.tasks.queue.bake_request import request_for
from rsibr.rsibr_addon.tasks.queue.input_bakes import input_job
from rsibr.tests.bake_jobs import run_job
from rsibr.tests.cycles.test_background_bake import HEIGHT, linked, second_scene
from rsibr.tests.flamenco_stub import manager

WORKER = [
    sys.executable,
    "-c",
    "from rsibr.rsibr_addon.tasks.light import environments\n"
    f"environments.WORLD_HEIGHT = {HEIGHT}\n"
    "from rsibr.rsibr_addon.command_line.worker import serve\n"
    "serve()",
]


@pytest.fixture(autouse=True)
def _registered(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    monkeypatch.setattr("rsibr.rsibr_addon.command_line.batch._worker_command", lambda: WORKER)
    monkeypatch.setattr(environments, "WORLD_HEIGHT", HEIGHT)
    rsibr.register()
    yield
    rsibr.unregister()


@pytest.fixture
def sent_inputs(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The job of the inputs of a material of a library, whose bake here is beside it, as ours.exr."""
    settings = BakedInputsSettings(size=16, samples=1)
    monkeypatch.setattr("rsibr.rsibr_addon.tasks.queue.input_bakes.inputs_settings", lambda: settings)
    (tmp_path / "studio").mkdir()
    linked(tmp_path / "studio")
    item, job = bpy.context.object, tmp_path / "inputs.json"
    drain(bake(input_job(item, tmp_path / "ours.exr")))
    job.write_text(input_job(item, tmp_path / "theirs.exr").to_json())
    return job


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore:Material .* depends on the view")
def test_sent_materials_give_the_same_textures(sent_inputs: Path, tmp_path: Path) -> None:
    assert run(["submit", str(sent_inputs), "--openjd", str(tmp_path / "bundle")]) == 0
    (tmp_path / "studio").rename(tmp_path / "gone")
    [batch] = map(str, (tmp_path / "bundle" / "inputs").glob("*.json"))
    command = ["batch", batch, "--output", str(tmp_path)]
    for which in (["--part", "open-inputs"], ["--part", "open-inputs"], ["--page"]):
        assert run([*command, *which]) == 0
    assert (tmp_path / "theirs.exr").read_bytes() == (tmp_path / "ours.exr").read_bytes()
    [page] = tmp_path.glob("*-batch/index.html")
    assert "data:image/png;base64,iVBOR" in page.read_text()


@pytest.mark.filterwarnings("ignore:Material .* depends on the view")
def test_textures_come_back_from_a_farm(
    sent_inputs: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(send, "LOOK_SECONDS", 0.0)
    monkeypatch.setattr(send, "STEP_SECONDS", 0.0)
    (tmp_path / "shared").mkdir()
    with manager(tmp_path / "shared") as farm:
        command = ["submit", str(sent_inputs), "--flamenco", farm.url, "--wait", "--json"]
        for there in (None, b"mine"):
            if there:
                (tmp_path / "theirs.exr").write_bytes(there)
            assert run(command) == 0
            told = json.loads(capfd.readouterr().out.splitlines()[-1])["warnings"]
            # What is there already stays, and that is told
            found = (tmp_path / "theirs.exr").read_bytes()
            assert found == (there or (tmp_path / "ours.exr").read_bytes())
            assert any("theirs.exr exists, and holds something else" in each for each in told) == bool(there)
        assert not farm.refused
        assert [job["settings"]["parts"] for job in farm.jobs] == 2 * ["open-inputs"]
        assert len(list(farm.shared.iterdir())) == 1


def test_a_pattern_sends_all_objects_that_need_a_bake(tmp_path: Path) -> None:
    bpy.ops.wm.read_homefile(use_factory_startup=True)
    cube = bpy.context.object
    copy, plain = cube.copy(), cube.copy()
    copy.name, plain.name = "Cup: old", "Cup: plain"
    plain.data = plain.data.copy()
    plain.data.materials[0] = plain.data.materials[0].copy()
    for each in (copy, plain):
        bpy.context.collection.objects.link(each)
    tree = cube.active_material.node_tree
    noise = tree.nodes.new("ShaderNodeTexNoise").outputs["Color"]
    tree.links.new(noise, tree.nodes["Principled BSDF"].inputs["Base Color"])
    job, outputs = tmp_path / "cups.json", "{object}.exr"
    for name, wanted in (("*", ["Cube", "Cup: old"]), ("Cup*", ["Cup: old"]), ("Cup: old", ["Cup: old"])):
        job.write_text(BakeJob(ObjectInputsSettings(object=name), str(tmp_path / outputs)).to_json())
        _, folder, bakes = bakes_to_send(job)
        assert folder == tmp_path
        assert [each.job.settings.object for each in bakes] == wanted
        assert [each.job.output for each in bakes] == [f"{portable_name(name)}.exr" for name in wanted]
        assert list(parts_of(bakes)) == ["scene-inputs"]
    for name, output, told in (("Mug*", outputs, "No object Mug*"), ("*", "one.exr", "tell objects apart")):
        job.write_text(BakeJob(ObjectInputsSettings(object=name), output).to_json())
        with pytest.raises(RsibrError, match=re.escape(told)):
            bakes_to_send(job)


@pytest.mark.slow
@pytest.mark.parametrize("make", [linked, second_scene])
def test_a_sent_scene_gives_the_same_bake(make: Callable[[Path], None], tmp_path: Path) -> None:
    (tmp_path / "studio").mkdir()
    make(tmp_path / "studio")
    chosen, item, scene = bpy.context.scene.rsibr_bake, bpy.context.object, bpy.context.scene
    chosen.kind, views = "radiance_views", chosen.radiance_views
    views.size, views.samples, views.denoise = 8, 4, False
    request = request_for(scene.rsibr_bake, scene, item)
    ours = tmp_path / "ours.rsibr.exr"
    assert run_job(request.job(ours), tmp_path) == 0
    job = tmp_path / "scene.json"
    job.write_text(request.job(tmp_path / "theirs.rsibr.exr").to_json())
    assert run(["submit", str(job), "--openjd", str(tmp_path / "bundle")]) == 0
    (tmp_path / "studio").rename(tmp_path / "gone")
    [batch] = map(str, (tmp_path / "bundle" / "inputs").glob("*.json"))
    assert run(["batch", batch, "--output", str(tmp_path), "--part", "world-radiance-views"]) == 0
    assert (tmp_path / "theirs.rsibr.exr").read_bytes() == ours.read_bytes()
