"""Batches: each bake is done once, whatever happens to others."""

import json
import os
import random
import signal
import subprocess
import sys
import time
from html.parser import HTMLParser
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from rsibr.rsibr_addon.command_line.main import run
from rsibr.rsibr_addon.core.lobes.kept_fits import fits_kept
from rsibr.rsibr_addon.core.progress import drain
from rsibr.rsibr_addon.core.warned import recorded_warnings
from rsibr.rsibr_addon.files.environments import environment_kept
from rsibr.rsibr_addon.files.map_set import read_map_set
from rsibr.rsibr_addon.files.radiance_pictures import write_radiance
from rsibr.rsibr_addon.tasks.batch.description import read_batch
from rsibr.rsibr_addon.tasks.batch.index import write_index
from rsibr.rsibr_addon.tasks.batch.notes import Note
from rsibr.rsibr_addon.tasks.light.environments import load_environment
from rsibr.rsibr_addon.tasks.methods import lobe_stack
from rsibr.rsibr_addon.tasks.methods.bake import bake
from rsibr.tests.batches import ENVIRONMENTS, MATERIALS, write_batch

pytestmark = pytest.mark.usefixtures("light_folder")

PATIENCE_SECONDS = 120
"""For a process that should have ended long before."""


@pytest.fixture(autouse=True)
def _two_threads(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("RSIBR_THREADS", "2")


def done(capfd: pytest.CaptureFixture[str], code: int = 0) -> dict[str, Any]:
    capfd.readouterr()
    assert run(["batch", "metals.json", "--json", "--progress", "none"]) == code
    result: dict[str, Any] = json.loads(capfd.readouterr().out.splitlines()[-1])
    return result


def maps() -> dict[str, tuple[bytes, int]]:
    return {path.name: (path.read_bytes(), path.stat().st_ino) for path in Path("maps").glob("*.exr")}


def test_a_dry_run_lists_and_bakes_nothing(capfd: pytest.CaptureFixture[str]) -> None:
    write_batch()
    assert run(["batch", "metals.json", "--dry-run"]) == 0
    lines = capfd.readouterr().out.splitlines()
    assert [line for line in lines if not line.startswith(" ")] == [
        *(f"{light}-reflection-tables: 3 bakes, about 2 s of processors" for light in sorted(ENVIRONMENTS)),
        "9 bakes in 3 parts: about 5 s of processors and 40 MB on disk",
    ]
    assert len(lines) == 13
    assert not Path("maps").exists()


@pytest.mark.parametrize("method", ["lobe-stack", "radiance-views"])
def test_misspelt_materials_are_told_of_before_any_bake(
    method: str, capfd: pytest.CaptureFixture[str]
) -> None:
    names = ["Brushed coper", "Zzz", "gold-leaf:kd=1", "ward:alpha=0.3,ks=0.5", "Brushed copper", "copper"]
    write_batch(environments=["light/dawn.exr"], methods=[method], materials=[*names, "some.blend:Cup"])
    assert run(["batch", "metals.json", "--dry-run", "--json"]) == 0
    faults = json.loads(capfd.readouterr().out.splitlines()[-1])["faults"]
    assert [Path(output).name for output in faults] == [
        f"dawn-{name}.rsibr.exr" for name in ("Brushed-coper", "Zzz", "gold-leaf-kd-1")
    ]
    near = faults["maps/dawn-Brushed-coper.rsibr.exr"]
    assert near == (
        'There is no material "Brushed coper" (did you mean Brushed copper?): name a preset, a reflectance '
        "model, or one of the gallery."
    )
    assert "Yellow acrylic" in faults["maps/dawn-Zzz.rsibr.exr"]
    run(["batch", "metals.json", "--dry-run"])
    lines = capfd.readouterr().out.splitlines()
    assert sum(line.endswith(", will fail") for line in lines) == 3
    assert sum("There is no material" in line for line in lines) == 3


def test_submit_tells_each_reason_once(capfd: pytest.CaptureFixture[str]) -> None:
    write_batch(
        environments=["light/dawn.exr", "light/gone.exr", "light/lost.exr"],
        methods=["lobe-stack"],
        materials=["Brushed coper", "Brushed copper", "none.binary"],
    )
    assert run(["submit", "metals.json", "--openjd", "bundle", "--json"]) == 0
    warnings = json.loads(capfd.readouterr().out)["warnings"]
    assert [warning.rpartition("exr: ")[2] for warning in warnings] == [
        'There is no material "Brushed coper" (did you mean Brushed copper?): name a preset, a reflectance '
        "model, or one of the gallery.",
        "none.binary does not exist: check the name and the folder.",
        "light/gone.exr does not exist: check the name and the folder.",
        "light/lost.exr does not exist: check the name and the folder.",
    ]
    outputs = ", ".join(f"maps/{light}-Brushed-coper.rsibr.exr" for light in ("dawn", "gone", "lost"))
    assert warnings[0].startswith(f"{outputs}: There is")


def test_a_bake_of_a_misspelt_material_fails_with_the_name_that_is_meant(
    capfd: pytest.CaptureFixture[str],
) -> None:
    write_batch(environments=["light/dawn.exr"], methods=["lobe-stack"], materials=["Brushed coper"])
    assert run(["batch", "metals.json"]) == 1
    assert "did you mean Brushed copper?" in capfd.readouterr().err


class Page(HTMLParser):
    """What of a page is checked."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.links: list[str] = []
        self.pictures: list[str] = []
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        values = {name: value or "" for name, value in attrs}
        if tag == "a":
            self.links.append(values["href"])
        if tag == "img":
            self.pictures.append(values["src"])


def test_broken_bakes_are_named_and_stop_no_other(capfd: pytest.CaptureFixture[str]) -> None:
    write_batch(materials=[*MATERIALS, "wood"])
    failed = done(capfd, code=1)
    names = [f"maps/{light}-wood.rsibr.exr" for light in sorted(ENVIRONMENTS)]
    assert all(name in failed["error"] for name in names)
    assert failed["error"].startswith("3 of 12 bakes failed (")
    assert (failed["ok"], failed["try_again"]) == (False, False)
    [warning] = failed["warnings"]
    assert warning.startswith(f"{', '.join(names)}: There is no preset wood")
    assert len(maps()) == 9
    text = Path("metals-batch/index.html").read_text()
    page = Page(text)
    assert len(page.links) == 12
    assert sum((Path("metals-batch") / link).is_file() for link in page.links) == 9
    assert len(page.pictures) == 9
    assert all(picture.startswith("data:image/png;base64,iVBOR") for picture in page.pictures)
    assert text.count("There is no preset wood") == 3
    told = json.loads(Path("metals-batch/summary.json").read_text())["bakes"]
    assert [bake["map_set"] for bake in told] == page.links
    assert [bake["state"] for bake in told] == 3 * ["done", "done", "done", "failed"]
    assert all(bake["error"].startswith("There is no preset wood") for bake in told[3::4])
    assert "://" not in text  # no sign of base 64, as letters of "http" are


def test_a_page_counts_its_bakes_and_folds_their_warnings() -> None:
    write_batch(environments=["light/dawn.exr"], materials=["chrome", "matte"])
    one, other = read_batch(Path("metals.json"))
    told = ["Its maps are too coarse & dark.", "Another."]
    errors = {"relative_to_peak": 0.125}
    note = Note(stamp="", told="tables", seconds=1.0, processor=1.0, errors=errors, warnings=told, picture="")
    write_index(Path("page.html"), "metals", [one], [note], {})
    text = Path("page.html").read_text()
    assert "<p>1 bake, 0 failed;" in text
    assert "<details><summary>Its maps are too coarse &amp; dark.</summary></details>" in text
    assert text.count("<details>") == 2
    assert "relative to peak 0.12" in text
    write_index(Path("page.html"), "metals", [one, other], [note, None], {})
    assert "<p>2 bakes, 0 failed;" in Path("page.html").read_text()


def test_the_greatest_errors_that_map_sets_state_are_told(capfd: pytest.CaptureFixture[str]) -> None:
    mips = {"kind": "mip-chain", "size": 4}
    write_batch(
        environments=["light/dawn.exr", "light/noon.exr"],
        materials=[],
        methods=[mips],
        output="{environment}.exr",
    )
    assert run(["batch", "metals.json"]) == 0
    lines = capfd.readouterr().out.splitlines()
    stated = {}
    for light in ("dawn", "noon"):
        bound = read_map_set(Path(f"{light}.exr")).header["error_bound"]
        stated[light] = max(np.ravel(bound["relative_to_peak"]))
    worst = max(stated, key=lambda light: stated[light])
    assert lines[0] == f"Mip Chain, greatest error, relative to peak: {stated[worst]:.2g}, {worst}.exr"
    told = json.loads(Path("metals-batch/summary.json").read_text())["bakes"]
    assert [bake["errors"] for bake in told] == [{"relative_to_peak": stated[name]} for name in stated]


def test_parts_and_their_page_are_the_batch(capfd: pytest.CaptureFixture[str]) -> None:
    path = write_batch(environments=["light/dawn.exr", "light/dusk.exr"], materials=["chrome", "wood"])
    command = ["batch", str(path), "--output", "there", "--json", "--progress", "none"]
    # What is wrong for good fails the page and no part, as another try would not help
    assert run([*command, "--part", "dawn-reflection-tables"]) == 0
    assert run([*command, "--page"]) == 1
    told = json.loads(capfd.readouterr().out.splitlines()[-1])
    assert told["error"].startswith("3 of 4 bakes failed")
    assert "It has not been done" in Path("there/metals-batch/index.html").read_text()
    assert run([*command, "--part", "dusk-reflection-tables"]) == 0
    assert run([*command, "--page"]) == 1
    assert json.loads(capfd.readouterr().out.splitlines()[-1])["error"].startswith("2 of 4 bakes failed")
    assert sorted(each.name for each in Path("there/maps").iterdir()) == [
        "dawn-chrome.rsibr.exr",
        "dusk-chrome.rsibr.exr",
    ]
    assert run([*command, "--part", "dusk-reflection-table"]) == 1
    assert "did you mean dusk-reflection-tables" in capfd.readouterr().out


def test_progress_for_farms_is_told_in_lines(capfd: pytest.CaptureFixture[str]) -> None:
    write_batch(environments=["light/dawn.exr"], materials=["matte"])
    assert run(["batch", "metals.json", "--progress", "lines"]) == 0
    told = capfd.readouterr().err.splitlines()
    assert told[0].startswith("0 of 1: matte in dawn")
    assert told[-1] == "1 of 1: done"


def test_a_batch_given_again_keeps_all_and_its_page(capfd: pytest.CaptureFixture[str]) -> None:
    path = write_batch()
    first = done(capfd)
    assert (first["made"], first["found"]) == (9, 0)
    before, page = maps(), Path("metals-batch/index.html").read_text()
    second = done(capfd)
    assert (second["made"], second["found"]) == (0, 9)
    assert maps() == before
    assert Path("metals-batch/index.html").read_text() == page
    # What a batch makes is what its bakes make alone
    for each in read_batch(path):
        data = before[Path(each.job.output).name][0]
        Path(each.job.output).unlink()
        drain(bake(each.job))
        assert Path(each.job.output).read_bytes() == data


def test_a_batch_reads_again_only_what_has_changed(capfd: pytest.CaptureFixture[str]) -> None:
    write_batch(environments=["light/dawn.exr"], materials=["chrome"])
    done(capfd)
    [path] = Path("maps").iterdir()
    known = path.stat()
    path.write_bytes(path.read_bytes()[:-9] + bytes(9))
    os.utime(path, ns=(known.st_atime_ns, known.st_mtime_ns))
    assert done(capfd)["found"] == 1
    path.touch()
    assert run(["batch", "metals.json"]) == 1
    assert f"{path} exists, but is no whole map set" in capfd.readouterr().err


def test_an_environment_is_read_once_for_bakes_that_follow(monkeypatch: pytest.MonkeyPatch) -> None:
    dark = np.ones((4, 8, 3), np.float32)
    dark[0, 0] = -1.0
    write_radiance(Path("dark.exr"), dark)
    with environment_kept():
        with pytest.warns(match="negative"):
            first = load_environment("dark.exr")
        with pytest.warns(match="negative"):
            assert load_environment("dark.exr") is first
        write_radiance(Path("dark.exr"), np.zeros((8, 16, 3)), force=True)
        assert load_environment("dark.exr").radiance.shape == (8, 16, 3)
    assert load_environment("light/dawn.exr") is not load_environment("light/dawn.exr")


@pytest.mark.slow
def test_a_material_is_fitted_once_for_all_environments(monkeypatch: pytest.MonkeyPatch) -> None:
    makes, made = lobe_stack.fitted, []

    def fitted(*asked: Any) -> Any:
        made.append(asked)
        return makes(*asked)

    def baked() -> list[tuple[bytes, list[str]]]:
        done = []
        for each in bakes:
            with recorded_warnings() as warnings:
                drain(bake(each.job))
            done.append((Path(each.job.output).read_bytes(), warnings))
            Path(each.job.output).unlink()
        return done

    monkeypatch.setattr(lobe_stack, "fitted", fitted)
    stack = {"kind": "lobe-stack", "method": "single", "slices": 2, "size": 8}
    # The environments are too coarse for it, so that it is fitted twice
    bakes = read_batch(write_batch(methods=[stack], materials=["ward:alpha=0.05,ks=0.5"]))
    Path("maps").mkdir()
    alone = baked()
    assert len(made) == 2 * len(bakes)
    made.clear()
    with fits_kept():
        assert baked() == alone
    assert len(made) == 2
    assert all(any("too coarse" in each for each in warnings) for _, warnings in alone)


@pytest.mark.slow
@pytest.mark.skipif(sys.platform == "win32", reason="has no SIGKILL")
def test_a_killed_batch_goes_on_and_does_nothing_twice(capfd: pytest.CaptureFixture[str]) -> None:
    moments = int(os.environ.get("RSIBR_MOMENTS", 3))
    path, chance = write_batch(), random.Random(1)
    command = [Path(sys.executable).with_name("rsibr"), "batch", str(path), "--progress", "none"]
    finished: dict[str, tuple[bytes, int]] = {}
    for _ in range(moments):
        with subprocess.Popen(command, start_new_session=True) as batch:
            time.sleep(chance.uniform(0.5, 3.0))
            batch.send_signal(signal.SIGKILL)
        there = maps()
        assert finished.items() <= there.items()
        finished = there
    result = done(capfd)
    assert result["made"] + result["found"] == 9
    assert finished.items() <= maps().items()
    assert len(maps()) == 9
    for name in maps():
        read_map_set(Path("maps") / name)
    assert {each.name for each in Path("maps").iterdir()} == maps().keys()


def test_a_worker_that_dies_costs_its_bake_alone(
    capfd: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    code = (
        "import os; from pathlib import Path\n"
        "from rsibr.rsibr_addon.command_line import worker\n"
        "did = worker._baked\n"
        "def baked(job, *more, **named):\n"
        "    if 'noon-matte' in job.output: os.abort()\n"
        "    return did(job, *more, **named)\n"
        "worker._baked = baked\n"
        "worker.serve()"
    )
    monkeypatch.setattr(
        "rsibr.rsibr_addon.command_line.batch._worker_command", lambda: [sys.executable, "-c", code]
    )
    write_batch()
    failed = done(capfd, code=75)
    assert failed["error"].startswith("1 of 9 bakes failed (maps/noon-matte.rsibr.exr)")
    assert failed["try_again"]
    assert len(maps()) == 8
