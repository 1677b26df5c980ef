"""Bundles of Open Job Description: the library takes them, and `openjd run` does them anywhere."""

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from rsibr.rsibr_addon.command_line.main import run
from rsibr.rsibr_addon.files.map_set import read_map_set_header
from rsibr.rsibr_addon.files.radiance_pictures import write_radiance

pytest.importorskip("openjd.model", reason="openjd-cli is not installed")

TABLES = {"kind": "reflection-tables", "diffuse_rows": 4, "rows": 4}


@pytest.fixture(autouse=True)
def _light(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    for number, name in enumerate(("dawn", "dusk")):
        write_radiance(Path(f"{name}.exr"), np.random.default_rng(number).random((8, 16, 3)))


def bundle(**changed: Any) -> Path:
    batch = {
        "environments": ["*.exr"],
        "materials": ["chrome", "matte"],
        "methods": [TABLES],
        "output": "sets/{environment}-{material}.exr",
    }
    Path("Metals & more.json").write_text(json.dumps(batch | changed))
    assert run(["submit", "Metals & more.json", "--openjd", "bundle"]) == 0
    return Path("bundle")


def write_ball_list(name: str = "balls/0.exr") -> None:
    """A photograph of a ball, and the list balls.json that names it so."""
    Path("balls").mkdir()
    write_radiance(Path("balls/0.exr"), np.random.default_rng(2).random((8, 16, 3)))
    photograph = {"file": name, "view_dir": [0, -1, 0], "circle": [8, 4, 3]}
    Path("balls.json").write_text(json.dumps({"photographs": [photograph]}))


def template(folder: Path) -> Any:
    from openjd.model import DocumentType, decode_job_template, document_string_to_object

    text = (folder / "template.yaml").read_text(encoding="utf-8")
    return decode_job_template(
        template=document_string_to_object(document=text, document_type=DocumentType.YAML)
    )


def test_a_bundle_has_a_task_for_each_environment_and_method() -> None:
    made = template(
        bundle(
            methods=[TABLES, {"kind": "mip-chain", "size": 4}], output="{method}-{environment}-{material}.exr"
        )
    )
    bakes, page = made.steps
    parts = bakes.parameterSpace.taskParameterDefinitions[0].range
    assert sorted(parts) == [
        "dawn-mip-chain",
        "dawn-reflection-tables",
        "dusk-mip-chain",
        "dusk-reflection-tables",
    ]
    assert [each.dependsOn for each in page.dependencies] == ["Bake"]
    assert {each.name: each.dataFlow.value for each in made.parameterDefinitions} == {
        "Inputs": "IN",
        "Maps": "OUT",
    }


def test_a_bundle_names_nothing_outside() -> None:
    Path("ward.binary").write_bytes(b"no measurement, and sent all the same")
    folder = bundle(materials=["ward.binary", "chrome"], methods=["lobe-stack"]).resolve()
    written = [path for path in folder.rglob("*") if path.is_file()]
    assert sorted(path.name for path in written) == [
        "Metals-more.json", "dawn.exr", "dusk.exr", "parameter_values.json", "template.yaml", "ward.binary"
    ]  # fmt: skip
    texts = [path.read_text() for path in written if path.suffix in (".json", ".yaml")]
    assert all(str(folder.parent) not in text for text in texts)


@pytest.mark.slow
@pytest.mark.parametrize(
    "method",
    [
        {"kind": "radiance-views", "size": 4, "photographs": "balls.json"},
        {"kind": "radiance-views", "size": 4, "view_file": "views.txt", "material": "lambert:kd=0.5"},
        {"kind": "mip-chain", "size": 4, "probes": "box:light=dusk.exr,size=6/5/3;sphere:light=balls/0.exr"},
    ],
    ids=["photographs", "view-file", "probes"],
)
def test_a_bundle_has_the_files_that_others_name(
    method: dict[str, Any], tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    here = tmp_path / "here"
    here.mkdir()
    monkeypatch.chdir(here)
    write_ball_list()
    Path("views.txt").write_text("0 -1 0\n")
    for name in ("dawn.exr", "dusk.exr"):
        (tmp_path / name).rename(name)
    folder = bundle(
        environments=["dawn.exr"], materials=["paint"] if "photographs" in method else [], methods=[method],
        output="one.exr",
    )  # fmt: skip
    assert run(["batch", "Metals & more.json"]) == 0
    assert "will fail" not in capfd.readouterr().err
    alone = read_map_set_header(Path("one.exr"))
    moved = folder.rename(tmp_path / "elsewhere")
    shutil.rmtree(here)
    monkeypatch.chdir(tmp_path)
    assert run(["batch", str(moved / "inputs" / "Metals-more.json"), "--output", "maps"]) == 0
    assert read_map_set_header(Path("maps/one.exr"))["parts"] == alone["parts"]
    assert read_map_set_header(Path("maps/one.exr"))["recipe"] == alone["recipe"]


@pytest.mark.parametrize("name", ["../0.exr", "{here}/balls/0.exr"])
def test_photographs_that_other_machines_lack_are_refused(
    name: str, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    write_ball_list(name.format(here=tmp_path))
    method = {"kind": "radiance-views", "material": "paint", "photographs": "balls.json"}
    Path("away.json").write_text(json.dumps({"environments": ["dawn.exr"], "methods": [method]}))
    assert run(["submit", "away.json", "--openjd", "bundle"]) == 1
    assert "balls.json names " in (told := capfd.readouterr().err)
    assert "put it beside the list, and name it relative to the list's folder" in told


def test_other_words_can_start_it() -> None:
    bundle()
    assert (
        run(["submit", "Metals & more.json", "--openjd", "bundle", "--program", "blender -b --command rsibr"])
        == 0
    )
    action = template(Path("bundle")).steps[1].script.actions.onRun
    assert (action.command, action.args[:4]) == ("blender", ["-b", "--command", "rsibr", "batch"])


def test_outputs_that_other_machines_lack_are_refused(capfd: pytest.CaptureFixture[str]) -> None:
    Path("away.json").write_text(
        json.dumps({"environments": ["dawn.exr"], "methods": ["mip-chain"], "output": "../{environment}.exr"})
    )
    assert run(["submit", "away.json", "--openjd", "bundle"]) == 1
    assert "which other machines may not have: give outputs in the batch's folder" in capfd.readouterr().err
    assert not Path("bundle").exists()


def test_a_world_of_no_file_is_refused(capfd: pytest.CaptureFixture[str]) -> None:
    bpy = pytest.importorskip("bpy")
    bpy.ops.wm.read_homefile(use_factory_startup=True)  # whatever a test before has opened
    Path("job.json").write_text(
        json.dumps({"format": 2, "kind": "mip_chain", "settings": {"size": 4}, "output": "a.rsibr.exr"})
    )
    assert run(["submit", "job.json", "--openjd", "bundle"]) == 1
    assert "No file is open whose world or material could be sent" in capfd.readouterr().err
    assert not Path("bundle").exists()


@pytest.mark.slow
def test_openjd_runs_a_bundle_wherever_it_is(tmp_path: Path) -> None:
    folder = bundle(environments=["dawn.exr"], materials=["chrome", "wood"])
    options = "--environment dawn.exr --material chrome --rows 4 --diffuse-rows 4 --output alone.exr"
    assert run(["bake", "reflection-tables", *options.split()]) == 0
    alone = read_map_set_header(Path("alone.exr"))
    moved = folder.rename(tmp_path / "elsewhere")
    for path in tmp_path.glob("*.exr"):
        path.unlink()
    programs = Path(sys.executable).parent
    done = subprocess.run(
        [programs / "openjd", "run", moved / "template.yaml", "--step", "Page", "--run-dependencies"],
        env={**os.environ, "PATH": f"{programs}{os.pathsep}{os.environ['PATH']}"},
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        check=False,
    )
    # The bake that cannot be done fails the page, and not its part, which would be tried again
    assert done.returncode == 1
    assert "openjd_fail: 1 of 2 bakes failed" in done.stdout
    assert "openjd_progress: 100.0" in done.stdout
    found = read_map_set_header(moved / "maps" / "sets" / "dawn-chrome.exr")
    assert found["recipe"] == alone["recipe"]
    page = (moved / "maps" / "Metals-more-batch" / "index.html").read_text()
    assert "There is no preset wood" in page
