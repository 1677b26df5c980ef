"""Batches through a manager of Flamenco, as a strict stub of it sees them."""

import json
import subprocess
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from rsibr.rsibr_addon.command_line.main import run
from rsibr.rsibr_addon.core.errors import FarmError, NotNowError
from rsibr.rsibr_addon.core.progress import drain
from rsibr.rsibr_addon.files.map_set import read_map_set
from rsibr.rsibr_addon.files.radiance_pictures import write_radiance
from rsibr.rsibr_addon.tasks.farm import send
from rsibr.rsibr_addon.tasks.farm.flamenco import SCRIPT, SETTINGS, Manager
from rsibr.tests.flamenco_stub import Stub, job_type_settings, manager

TABLES = {"kind": "reflection-tables", "diffuse_rows": 4, "rows": 4}


@pytest.fixture
def farm(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Stub]:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(send, "LOOK_SECONDS", 0.0)
    monkeypatch.setattr(send, "STEP_SECONDS", 0.0)
    for number, name in enumerate(("dawn", "dusk")):
        write_radiance(Path(f"{name}.exr"), np.random.default_rng(number).random((8, 16, 3)))
    (tmp_path / "shared").mkdir()
    with manager(tmp_path / "shared") as stub:
        yield stub
    assert not stub.refused


def batch(**changed: Any) -> str:
    plain = {"environments": ["*.exr"], "materials": ["chrome"], "methods": [TABLES]}
    Path("metals.json").write_text(json.dumps(plain | changed))
    return "metals.json"


def told(capfd: pytest.CaptureFixture[str], *words: str, code: int = 0) -> Any:
    capfd.readouterr()
    assert run([*words, "--json", "--progress", "none"]) == code
    return json.loads(capfd.readouterr().out.splitlines()[-1])


def test_a_batch_is_sent_whole_with_every_setting(farm: Stub, capfd: pytest.CaptureFixture[str]) -> None:
    sent = told(capfd, "submit", batch(), "--flamenco", farm.url)
    [job] = farm.jobs
    assert job["settings"].keys() == SETTINGS == {each["key"] for each in job_type_settings()}
    assert job["settings"]["parts"] == "dawn-reflection-tables dusk-reflection-tables"
    assert job["settings"]["program"].startswith("{blender} ")
    folder = Path(job["settings"]["folder"])
    assert folder.parent == farm.shared
    assert Path(sent["maps"]) == folder / "maps"
    assert str(Path.cwd()) not in (folder / "inputs" / "metals.json").read_text()


def test_what_is_waited_for_is_fetched_and_what_failed_is_named(
    farm: Stub, capfd: pytest.CaptureFixture[str]
) -> None:
    Path(batch(materials=["chrome", "wood"])).rename("metals.v2.json")
    words = ("submit", "metals.v2.json", "--flamenco", farm.url, "--wait")
    failed = told(capfd, *words, code=1)
    assert failed["error"].startswith("2 of 4 bakes failed")
    assert not failed["try_again"]
    assert any("There is no preset wood" in warning for warning in failed["warnings"])
    assert Path("metals.v2-batch/index.html").read_text() == "the page"
    before = Path("dawn-chrome.rsibr.exr").stat().st_ino
    read_map_set(Path("dawn-chrome.rsibr.exr"))
    # Given again, it finds what is on shared storage, and leaves what was fetched
    told(capfd, *words, code=1)
    assert len(list(farm.shared.iterdir())) == 1
    assert Path("dawn-chrome.rsibr.exr").stat().st_ino == before
    # What was made with other settings stays, and that is told
    Path("dawn-chrome.rsibr.exr").write_bytes(Path("dusk-chrome.rsibr.exr").read_bytes())
    warnings = told(capfd, *words, code=1)["warnings"]
    assert any("dawn-chrome.rsibr.exr exists, made with other settings" in each for each in warnings)


def test_what_is_damaged_here_is_replaced_by_what_the_farm_made(
    farm: Stub, capfd: pytest.CaptureFixture[str]
) -> None:
    words = ("submit", batch(output="{environment}.rsibr.exr"), "--flamenco", farm.url, "--wait")
    told(capfd, *words)
    whole = {name: Path(name).read_bytes() for name in ("dawn.rsibr.exr", "dusk.rsibr.exr")}
    Path("dawn.rsibr.exr").write_bytes(whole["dawn.rsibr.exr"][:-9])
    Path("dusk.rsibr.exr").write_bytes(b"")
    assert told(capfd, *words)["warnings"] == []
    assert {name: Path(name).read_bytes() for name in whole} == whole


def test_a_picture_that_is_no_map_set_is_not_replaced(farm: Stub, capfd: pytest.CaptureFixture[str]) -> None:
    plain = batch(environments=["dusk.exr"], output="picture.exr")
    Path("picture.exr").write_bytes(b"mine")
    warnings = told(capfd, "submit", plain, "--flamenco", farm.url, "--wait")["warnings"]
    assert any("picture.exr exists, but is no whole map set" in each for each in warnings)
    assert Path("picture.exr").read_bytes() == b"mine"


def test_what_will_fail_is_told_once(farm: Stub, capfd: pytest.CaptureFixture[str]) -> None:
    plain = batch(environments=["dawn.exr"], methods=["lobe-stack"], materials=["Brushed coper"])
    [warning] = told(capfd, "submit", plain, "--flamenco", farm.url)["warnings"]
    assert "did you mean Brushed copper?" in warning


def test_map_sets_and_the_page_are_fetched_and_nothing_else(
    farm: Stub, capfd: pytest.CaptureFixture[str]
) -> None:
    Path(".hidden").mkdir()
    words = ("submit", batch(), "--flamenco", farm.url, "--shared", ".hidden")
    there = Path(told(capfd, *words)["maps"])
    # What a capture leaves that has ended early
    (there / "other.rsibr.exr.partial").mkdir()
    (there / "other.rsibr.exr.partial" / "view1.exr").touch()
    before = set(Path().rglob("*"))
    told(capfd, *words, "--wait")
    fetched = {path for path in set(Path().rglob("*")) - before if path.parts[0] != ".hidden"}
    assert {path.as_posix() for path in fetched if path.is_file()} == {
        "dawn-chrome.rsibr.exr",
        "dusk-chrome.rsibr.exr",
        "metals-batch/index.html",
    }


def test_a_job_is_one_bake_whose_error_is_told(farm: Stub, capfd: pytest.CaptureFixture[str]) -> None:
    (Path.cwd() / "baked").mkdir()
    job = {
        "format": 2,
        "kind": "reflection_tables",
        "settings": {"material": "chrome", "rows": 4, "diffuse_rows": 4},
        "light": {"environment": "dawn.exr"},
        "output": str(Path("baked/here.rsibr.exr").resolve()),
    }
    Path("job.json").write_text(json.dumps(job))
    told(capfd, "submit", "job.json", "--flamenco", farm.url, "--wait")
    assert [each.name for each in Path("baked").iterdir()] == ["here.rsibr.exr"]
    job["settings"] = {"material": "wood"}
    Path("job.json").write_text(json.dumps(job))
    Path("baked/here.rsibr.exr").unlink()
    assert told(capfd, "submit", "job.json", "--flamenco", farm.url, "--wait", code=1)["error"].startswith(
        "There is no preset wood"
    )


def test_a_job_of_another_command_is_refused(farm: Stub, capfd: pytest.CaptureFixture[str]) -> None:
    Path("job.json").write_text(json.dumps({"format": 1, "arguments": ["inputs", "Suzanne", "-o", "a.exr"]}))
    error = told(capfd, "submit", "job.json", "--flamenco", farm.url, code=1)["error"]
    assert error.startswith("job.json is the job of rsibr inputs, which a farm does not do")
    assert not list(farm.shared.iterdir())


def test_a_farm_that_starts_no_task_says_why(farm: Stub, capfd: pytest.CaptureFixture[str]) -> None:
    farm.broken = "exec: blender: not found"
    failed = told(
        capfd, "submit", batch(environments=["dawn.exr"]), "--flamenco", farm.url, "--wait", code=75
    )
    assert failed["error"].startswith("The farm's job failed (exec: blender: not found): see http://")
    assert failed["try_again"]


def test_a_watch_that_ends_early_cancels_the_job(farm: Stub) -> None:
    asked = Manager(farm.url)
    sent = send.Sent(asked.submit("t", dict.fromkeys(SETTINGS, "a"), asked.etag()), "t", "", farm.shared, [])
    watched = send.watch(asked, sent)
    farm._tasks = {"a": "active", "page": "queued"}
    next(watched)
    watched.close()
    assert farm.status == "canceled"


def test_a_manager_that_is_away_for_a_while_is_waited_for(
    farm: Stub, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked = Manager(farm.url)
    sent = send.Sent("1", "t", "", farm.shared, [])
    farm._tasks, farm.status = {"page": "completed"}, "completed"

    status = Manager.status

    def away(self: Manager, job: str) -> str:
        monkeypatch.setattr(Manager, "status", status)
        raise NotNowError("It is away.")

    monkeypatch.setattr(Manager, "status", away)
    watched = send.watch(asked, sent)
    assert next(watched).what == "It is away."
    assert drain(watched) == "completed"


def test_a_missing_job_type_says_where_it_belongs(farm: Stub, capfd: pytest.CaptureFixture[str]) -> None:
    farm.has_job_type = False
    error = told(capfd, "submit", batch(), "--flamenco", farm.url, code=1)["error"]
    assert f"copy {SCRIPT} into the folder scripts beside flamenco-manager" in error
    assert not list(farm.shared.iterdir())


def test_storage_that_is_not_here_is_told(farm: Stub, capfd: pytest.CaptureFixture[str]) -> None:
    (farm.shared.parent / "here").mkdir()
    told(capfd, "submit", batch(), "--flamenco", farm.url, "--shared", "here")
    assert Path(farm.jobs[0]["settings"]["folder"]).parent == Path("here").resolve()
    words = ("submit", batch(), "--flamenco", farm.url, "--shared", "nowhere")
    assert "shared storage nowhere is no folder here: mount it" in told(capfd, *words, code=1)["error"]


def test_addresses_that_answer_otherwise_are_told(farm: Stub, monkeypatch: pytest.MonkeyPatch) -> None:
    for url in ("file:///etc/passwd", "http://", "http://farm/path", "farm 8080"):
        with pytest.raises(FarmError, match="is no address of a Flamenco manager"):
            Manager(url)
    assert Manager("farm:8080/").url == "http://farm:8080"
    with pytest.raises(NotNowError, match="does not answer"):
        Manager("http://127.0.0.1:9").etag()
    monkeypatch.setattr(farm, "answer", lambda *asked: (200, "<html>"))
    with pytest.raises(FarmError, match="answers as no manager of Flamenco 3 does"):
        Manager(farm.url).etag()
    monkeypatch.setattr(farm, "answer", lambda *asked: (503, {"code": 503, "message": "too busy"}))
    with pytest.raises(NotNowError, match=r"is busy \(too busy\)"):
        Manager(farm.url).etag()
    monkeypatch.setattr(farm, "answer", lambda *asked: (412, {"code": 412, "message": "outdated"}))
    with pytest.raises(FarmError, match=r"refuses \(outdated\)"):
        Manager(farm.url).submit("t", {}, "old")


@pytest.mark.needs("node")
def test_the_job_type_makes_a_task_of_each_part_and_one_of_the_page() -> None:
    script = f"""
    const author = {{
      Task: (name, type) => ({{
        name, type, commands: [], after: [],
        addCommand(command) {{ this.commands.push(command); }},
        addDependency(task) {{ this.after.push(task.name); }},
      }}),
      Command: (name, parameters) => ({{name, ...parameters}}),
    }};
    const shellSplit = (text) => text.split(" ");
    {SCRIPT.read_text()}
    const settings = {{folder: "{{jobs}}/m", batch: "m", parts: "a b", program: "{{blender}} -b"}};
    const job = {{settings, tasks: [], addTask(task) {{ this.tasks.push(task); }}}};
    compileJob(job);
    console.log(JSON.stringify(job.tasks));
    """
    done = subprocess.run(["node", "-e", script], capture_output=True, text=True, check=True)
    tasks = json.loads(done.stdout)
    assert [(each["name"], each["after"]) for each in tasks] == [("a", []), ("b", []), ("page", ["a", "b"])]
    assert tasks[0]["commands"] == [
        {
            "name": "exec",
            "exe": "{blender}",
            "args": [
                *("-b", "batch", "{jobs}/m/inputs/m.json", "--output", "{jobs}/m/maps"),
                *("--progress", "lines", "--part", "a"),
            ],
        }
    ]
    assert tasks[2]["commands"][0]["args"][-1] == "--page"
