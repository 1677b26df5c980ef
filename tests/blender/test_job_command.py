"""Jobs from files do what their commands do, and what they leave out is taken from the open file."""

import json
from pathlib import Path

import bpy
import numpy as np
import pytest
from rsibr.rsibr_addon.command_line.main import run
from rsibr.rsibr_addon.files.map_set import read_map_set
from rsibr.rsibr_addon.job import BakeJob, CommandJob
from rsibr.rsibr_addon.settings.baked_inputs import ObjectInputsSettings


@pytest.fixture(autouse=True)
def _small_world(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("rsibr.rsibr_addon.tasks.light.environments.WORLD_HEIGHT", 16)


def write_job(*arguments: str) -> None:
    Path("job.json").write_text(CommandJob(arguments).to_json())


def test_a_job_does_what_its_command_does(capfd: pytest.CaptureFixture[str]) -> None:
    command = ("mips", "--filter", "bordered", "--size", "4", "-o")
    write_job(*command, "job.rsibr.exr")
    assert run(["bake", "job.json", "--json", "--progress", "json"]) == 0
    out, err = capfd.readouterr()
    result = json.loads(out.splitlines()[-1])
    assert result["ok"]
    assert result["map_set"] == "job.rsibr.exr"
    assert '{"progress": ' in err
    assert run([*command, "command.rsibr.exr"]) == 0
    assert Path("job.rsibr.exr").read_bytes() == Path("command.rsibr.exr").read_bytes()


@pytest.mark.parametrize(
    "command", [("mips", "--size", "4"), ("tables", "--material", "matte", "--diffuse-rows", "4")]
)
def test_without_an_environment_it_is_the_world(command: tuple[str, ...]) -> None:
    tree = bpy.context.scene.world.node_tree
    tree.nodes["Background"].inputs["Color"].default_value = (0.25, 0.5, 0.75, 1.0)
    assert run([*command, "-o", "out.rsibr.exr", "--progress", "none"]) == 0
    map_set = read_map_set(Path("out.rsibr.exr"))
    header = map_set.header["environment"]
    assert header["name"] == "World"
    # The world is sampled into single precision, and nothing but that
    name = next(part["name"] for part in map_set.header["parts"])
    np.testing.assert_allclose(map_set.maps[name][0, 0, 2] / map_set.maps[name][0, 0, 0], 3.0, rtol=1e-5)


def test_the_output_of_a_job_of_an_object_may_have_its_name(capfd: pytest.CaptureFixture[str]) -> None:
    item = bpy.context.object
    item.name = "Cup: old"
    tree = item.active_material.node_tree
    noise = tree.nodes.new("ShaderNodeTexNoise").outputs["Color"]
    tree.links.new(noise, tree.nodes["Principled BSDF"].inputs["Base Color"])
    settings = ObjectInputsSettings(object=item.name, size=256, samples=1)
    Path("job.json").write_text(BakeJob(settings, "textures-{object}.exr").to_json())
    for found in (None, True):
        assert run(["bake", "job.json", "--json"]) == 0
        result = json.loads(capfd.readouterr().out)
        assert (result["baked_inputs"], result.get("found")) == ("textures-Cup-old.exr", found)
    assert Path("textures-Cup-old.exr").exists()


def test_the_world_that_blender_starts_with_is_warned_of(
    tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    told = "the world that Blender starts with is baked: give --environment"
    command = ["mips", "--size", "2", "--filter", "box", "-o", "out.rsibr.exr", "--force"]
    assert run(command) == 0
    assert told in capfd.readouterr().err
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "mine.blend"))
    assert run(command) == 0
    assert told not in capfd.readouterr().err


def test_without_a_world_there_is_a_sentence(capfd: pytest.CaptureFixture[str]) -> None:
    bpy.context.scene.world = None
    assert run(["mips", "--size", "4", "-o", "out.rsibr.exr", "--progress", "none"]) == 1
    assert "Scene Scene has no world: add one in its World properties." in capfd.readouterr().err
    assert not Path("out.rsibr.exr").exists()


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        (None, "job.json does not exist: check the name and the folder."),
        (b"\xff\xfe\xfd", "job.json is no text"),
        ("{}", "job.json is no job"),
        (
            CommandJob(("mips",)),
            "job.json cannot be done (the following arguments are required: -o",
        ),
        (CommandJob(("mips", "--help")), "job.json cannot be done (it asks for help)"),
        (CommandJob(("bake", "job.json")), "job.json is a job whose work is another job"),
    ],
)
def test_bad_jobs_are_a_sentence(
    text: str | bytes | CommandJob | None, sentence: str, capfd: pytest.CaptureFixture[str]
) -> None:
    if isinstance(text, CommandJob):
        text = text.to_json()
    if text is not None:
        Path("job.json").write_bytes(text if isinstance(text, bytes) else text.encode())
    assert run(["bake", "job.json", "--json", "--progress", "none"]) == 1
    result = json.loads(capfd.readouterr().out)
    assert result["error"].startswith(sentence)
