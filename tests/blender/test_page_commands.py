"""What pages tell people to type is done, on a small scale."""

import re
from dataclasses import replace
from pathlib import Path

import bpy
import numpy as np
import pytest
import rsibr
from rsibr.rsibr_addon.command_line.main import run
from rsibr.rsibr_addon.files.radiance_pictures import write_radiance
from rsibr.rsibr_addon.job import read_job
from rsibr.tests.pages import blocks, calls

GUIDE = "docs/guide.md"

COMPLETE = [
    "README.md",
    *(
        f"docs/{name}.md"
        for name in ("commands", "export", "kernel-banks", "materials", "mip-chains", "reflection-tables")
    ),
]
"""Pages whose commands want no files but each other's, and `room.exr`."""

SMALL = {
    "radiance-views": {"--views": "12", "--size": "8", "--samples": "2"},
    "lobe-stack": {"--lobes": "1", "--slices": "2", "--size": "16"},
    "reflection-tables": {"--diffuse-rows": "8", "--rows": "8"},
    "mip-chain": {"--size": "64"},
    "kernel-bank": {"--size": "16"},
    "kernel-pyramid": {"--size": "32"},
    "preview": {"--size": "16", "--turntable": "2"},
    "compare": {"--size": "8", "--views": "1", "--samples": "4"},
}
"""Command, or kind that is baked -> its options that make it quick."""

SMALL_SCRIPT = {
    'environment="sunset"': 'environment="sunset", size=128',
    'views="42", samples=128': "size=8, samples=2",
    "size=256": "size=64",
}
"""The same of operators, by what the guide's script says."""


@pytest.fixture(autouse=True)
def _small_world(monkeypatch: pytest.MonkeyPatch, quick_furnace: None) -> None:
    monkeypatch.setattr("rsibr.rsibr_addon.tasks.light.environments.WORLD_HEIGHT", 16)


def made_small(words: list[str]) -> list[str]:
    name = words[1] if words[0] == "bake" else words[0]
    for option, value in SMALL.get(name, {}).items():
        if option in words:
            at = words.index(option)
            words = words[:at] + words[at + 2 :]
        words = [*words, option, value]
    return words


def assert_outputs_are_there(words: list[str]) -> None:
    for output in re.findall(r"-o (\S+)", " ".join(words)):
        assert Path(output).exists()


@pytest.mark.slow
@pytest.mark.needs("gl", "cycles")
@pytest.mark.parametrize("page", COMPLETE)
def test_a_pages_commands_do_what_they_say(
    page: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    write_radiance("room.exr", np.ones((32, 64, 3)))
    for words in calls(page, "rsibr"):
        assert run(made_small(words)) == 0, words
        assert_outputs_are_there(words)


@pytest.mark.slow
@pytest.mark.needs("gl", "cycles")
def test_the_guides_commands_do_what_they_say(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    (text,) = blocks(GUIDE, "json")
    bpy.data.materials.new("Paint")
    bpy.context.object.active_material = bpy.data.materials["Paint"]
    job = read_job(text, "guide")
    job = replace(job, settings=replace(job.settings, views=12, size=8, samples=2))
    Path("job.json").write_text(job.to_json())
    for words in calls(GUIDE, "rsibr"):
        if words[1] == "radiance-views":
            words = [*words, "--force"]  # The job has made the same file
        assert run(made_small(words) if words[1] != "job.json" else words) == 0, words
        assert_outputs_are_there(words)
    assert Path("gold.html").is_file()
    _, reader = blocks(GUIDE, "python")
    exec(compile(reader, "guide", "exec"), {})


@pytest.mark.slow
@pytest.mark.needs("cycles")
def test_the_guides_script_does_what_it_says(tmp_path: Path) -> None:
    script, _ = blocks(GUIDE, "python")
    for large, small in SMALL_SCRIPT.items():
        assert large in script
        script = script.replace(large, small)
    rsibr.register()
    try:
        bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "car.blend"))
        exec(compile(script, "guide", "exec"), {"bpy": bpy})
        assert bpy.context.object.rsibr.map_set == "//chrome.rsibr.exr"
    finally:
        rsibr.unregister()
    made = set(re.findall(r"//([\w.]+)", script))
    assert made <= {path.name for path in tmp_path.iterdir()}


def test_the_job_is_understood() -> None:
    (text,) = blocks(GUIDE, "json")
    assert read_job(text, "guide").settings.material == ":Paint"
