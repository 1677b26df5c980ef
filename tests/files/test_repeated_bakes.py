"""Bakes that are given twice: the same is kept, another is told of, and of two at once one works."""

import errno
import json
import subprocess
import sys
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from rsibr.rsibr_addon.command_line.main import run
from rsibr.rsibr_addon.core.errors import MapSetError, OutputFileError
from rsibr.rsibr_addon.core.lobes.bank import KernelBank
from rsibr.rsibr_addon.core.progress import drain
from rsibr.rsibr_addon.files import memory, outputs
from rsibr.rsibr_addon.files.fits import write_fit
from rsibr.rsibr_addon.files.map_set import read_map_set, read_map_set_header, write_map_set
from rsibr.rsibr_addon.files.radiance_pictures import write_radiance
from rsibr.rsibr_addon.files.work_folder import held_work_folder, work_folder_beside
from rsibr.rsibr_addon.job import BakeJob, read_job
from rsibr.rsibr_addon.settings.kernel_bank import KernelBankSettings
from rsibr.rsibr_addon.settings.light import Light
from rsibr.rsibr_addon.settings.lobe_stack import LobeStackSettings
from rsibr.rsibr_addon.settings.mip_chain import MipChainSettings
from rsibr.rsibr_addon.settings.reflection_tables import ReflectionTablesSettings
from rsibr.rsibr_addon.tasks.methods import bake as bakes
from rsibr.rsibr_addon.tasks.methods.bake import bake
from rsibr.rsibr_addon.tasks.methods.method import Baked
from rsibr.rsibr_addon.tasks.methods.recipe import with_files_named
from rsibr.tests.bake_jobs import run_job
from rsibr.tests.lobe_stacks import random_fit

OUTPUT = Path("out.rsibr.exr")
SMALL = MipChainSettings(filter="box", size=8)
PATIENCE_SECONDS = 60
"""For a process that should be done long before."""


@pytest.fixture(autouse=True)
def _light(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(bakes, "WAIT_SECONDS", 0.01)
    write_radiance(Path("light.exr"), np.random.default_rng(7).random((16, 32, 3)))


def job_of(settings: Any = SMALL, light: str = "light.exr", clamp: float | None = None) -> BakeJob[Any]:
    return BakeJob(settings, str(OUTPUT), Light(environment=light, clamp=clamp), if_missing=True)


def state() -> tuple[bytes, int]:
    """What the output holds, and whether it was written again."""
    return OUTPUT.read_bytes(), OUTPUT.stat().st_ino


def names() -> set[str]:
    return {path.name for path in Path().iterdir()}


def test_a_job_given_twice_is_done_once(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    assert run_job(job_of(), tmp_path) == 0
    before = state()
    path = Path("job.json")
    path.write_text(job_of().to_json())
    capfd.readouterr()
    assert run(["bake", str(path), "--json"]) == 0
    result = json.loads(capfd.readouterr().out)
    assert (result["ok"], result["map_set"], result["found"]) == (True, str(OUTPUT), True)
    assert state() == before
    assert names() == {"light.exr", "out.rsibr.exr", "job.json"}


def other_light() -> None:
    write_radiance(Path("light.exr"), np.ones((16, 32, 3)), force=True)


@pytest.mark.parametrize(
    ("job", "change", "told"),
    [
        (job_of(replace(SMALL, size=16)), None, "Size 8, not 16"),
        (job_of(clamp=2.0), None, "Clamp none, not 2.0"),
        (job_of(), other_light, "another environment"),
        (job_of(KernelBankSettings(size=64)), None, "Mip chain, not kernel bank"),
        (job_of(replace(SMALL, size=16), clamp=2.0), None, "Size 8, not 16; Clamp none, not 2.0"),
    ],
)
def test_other_settings_are_told(
    job: BakeJob[Any], change: Callable[[], None] | None, told: str, tmp_path: Path
) -> None:
    drain(bake(job_of()))
    before = state()
    if change:
        change()
    with pytest.raises(OutputFileError) as caught:
        drain(bake(job))
    assert str(caught.value) == (
        f"{OUTPUT} exists, made with other settings ({told}): give another name, or --force to replace it."
    )
    assert state() == before
    assert run_job(job, tmp_path) == 1
    drain(bake(replace(job, force=True, if_missing=False)))
    assert state() != before


def test_another_version_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    drain(bake(job_of()))
    monkeypatch.setattr("rsibr.rsibr_addon.tasks.methods.recipe.rsibr", lambda: "rsibr 9.9.9")
    made_by = read_map_set_header(OUTPUT)["software"]
    with pytest.raises(OutputFileError, match=rf"\({made_by}, not rsibr 9\.9\.9\)"):
        drain(bake(job_of()))


def test_files_that_tell_no_settings_are_not_taken_for_any() -> None:
    drain(bake(job_of()))
    old = read_map_set(OUTPUT)
    del old.header["recipe"]
    write_map_set(OUTPUT, old, force=True)
    with pytest.raises(OutputFileError, match="does not tell the settings it was made with"):
        drain(bake(job_of()))
    OUTPUT.write_bytes(OUTPUT.read_bytes()[:500])
    with pytest.raises(OutputFileError, match="exists, but is no whole map set"):
        drain(bake(job_of()))


@pytest.mark.parametrize("damage", ["pixels", "a missing map"])
def test_a_file_that_nobody_could_use_is_not_kept_for_its_recipe(damage: str) -> None:
    drain(bake(job_of()))
    if damage == "pixels":
        whole = OUTPUT.read_bytes()
        OUTPUT.write_bytes(whole[:-9] + bytes(9))
    else:
        held = read_map_set(OUTPUT)
        held.header["parts"] = [part for part in held.header["parts"] if part["role"] != "harmonics"]
        maps = {part["name"]: held.maps[part["name"]] for part in held.header["parts"]}
        write_map_set(OUTPUT, replace(held, maps=maps), force=True)
    with pytest.raises(OutputFileError, match="exists, but is no whole map set: give another name"):
        drain(bake(job_of()))
    drain(bake(replace(job_of(), force=True, if_missing=False)))
    assert drain(bake(job_of())).figures == {"found": True}


def test_a_file_is_kept_that_there_is_too_little_memory_to_read(monkeypatch: pytest.MonkeyPatch) -> None:
    drain(bake(job_of()))
    monkeypatch.setattr(memory, "memory_left", lambda: 1e3)
    with pytest.raises(MapSetError, match="of memory"):
        read_map_set(OUTPUT)
    assert drain(bake(job_of())).figures == {"found": True}


def test_a_folder_is_no_output_that_could_be_kept() -> None:
    OUTPUT.mkdir()
    with pytest.raises(OutputFileError, match="is a folder: give the name of a file in it"):
        drain(bake(job_of()))


def test_a_job_may_name_its_kind_as_commands_do(tmp_path: Path) -> None:
    plain = json.loads(job_of().to_json())
    job = Path("JOB.JSON")
    job.write_text(json.dumps(plain | {"kind": "mip-chain"}))
    assert read_job(job.read_text(), "job") == job_of()
    assert run(["bake", str(job)]) == 0


def test_a_command_keeps_what_is_there_only_if_asked(capfd: pytest.CaptureFixture[str]) -> None:
    command = ["bake", "mip-chain", "--environment", "light.exr", "--size", "8", "-o", str(OUTPUT)]
    assert run([*command, "--if-missing"]) == 0
    before = state()
    assert run(command) == 1
    assert "out.rsibr.exr exists: give another name, or --force" in capfd.readouterr().err
    assert run([*command, "--if-missing"]) == 0
    assert state() == before
    assert run([*command, "--if-missing", "--force"]) == 2


def test_a_file_counts_by_its_content_wherever_it_is() -> None:
    stack = LobeStackSettings(fit="fit.json", size=16)
    write_fit(Path("fit.json"), random_fit(KernelBank((0.5, 2.0))), {"E": 0.1})
    drain(bake(job_of(stack)))
    Path("other").mkdir()
    for name in ("fit.json", "light.exr"):
        Path(name).rename(Path("other", name))
    moved = job_of(replace(stack, fit=str(Path("other/fit.json").resolve())), "other/light.exr")
    assert drain(bake(moved)).figures == {"found": True}
    write_fit(Path("other/fit.json"), random_fit(KernelBank((0.5, 4.0))), {"E": 0.1}, force=True)
    with pytest.raises(OutputFileError, match=r"\(other files of the material\)"):
        drain(bake(moved))


def test_files_of_measured_models_within_models_count_too() -> None:
    tables = ReflectionTablesSettings(
        diffuse="lambert:kd=0.5", weights="albedo:brdf=(merl:path=/far/gold.binary)"
    )
    stack = LobeStackSettings(brdf="sum:parts=(lambert:kd=0.2)+(merl:path=a.binary)")
    named = [bakes.METHODS[each.KIND].sources(each).files for each in (tables, stack)]
    assert named == [("/far/gold.binary",), ("a.binary",)]


@pytest.mark.parametrize(
    ("text", "named"),
    [
        ("merl", "new"),
        ("merl:path=merl", "merl:path=new"),
        ("merl: path = merl ", "merl: path = new "),
        ("merl:path=far/merl", "merl:path=far/merl"),
        ("merl:path=merl.binary", "merl:path=merl.binary"),
        ("sum:parts=(lambert:kd=0.2)+(merl:path=merl)", "sum:parts=(lambert:kd=0.2)+(merl:path=new)"),
        ("sum:parts=(merl:path=merl)+(merl:path=m.blend)", "sum:parts=(merl:path=new)+(merl:path=b)"),
        ("blend:m.blend:m.blend", "blend:b:m.blend"),
        ("m.blend:Cup", "b:Cup"),
        ("am.blend:Cup", "am.blend:Cup"),
        (
            "box:light=merl,size=1/1/1;sphere:size=2/2/2,light= merl ; ",
            "box:light=new,size=1/1/1;sphere:size=2/2/2,light= new ; ",
        ),
        ("box:light=far/merl", "box:light=far/merl"),
    ],
)
def test_files_have_other_names_where_they_are_values(text: str, named: str) -> None:
    settings = {"brdf": text, "size": 16}
    assert with_files_named(settings, {"merl": "new", "m.blend": "b"}) == {"brdf": named, "size": 16}


def test_one_waits_until_the_other_is_done() -> None:
    steps = bake(job_of())
    with held_work_folder(work_folder_beside(OUTPUT)):
        for _ in range(3):
            assert next(steps).what == "waiting for another process that makes out.rsibr.exr"
        assert not OUTPUT.exists()
    assert drain(steps).figures["size"] == 8
    assert names() == {"light.exr", "out.rsibr.exr"}


HOLD = """
import sys
from pathlib import Path
from rsibr.rsibr_addon.files.work_folder import held_work_folder
with held_work_folder(Path(sys.argv[1])):
    print("held", flush=True)
    sys.stdin.read()
"""


def test_one_takes_over_from_another_that_dies() -> None:
    command = [sys.executable, "-c", HOLD, str(work_folder_beside(OUTPUT))]
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as other:
        assert other.stdout is not None
        assert other.stdout.readline() == "held\n"
        steps = bake(job_of())
        assert "waiting" in next(steps).what
        other.kill()
        other.wait(PATIENCE_SECONDS)
        assert drain(steps).figures["size"] == 8
    assert names() == {"light.exr", "out.rsibr.exr"}


def test_of_several_that_wait_one_works() -> None:
    Path("job.json").write_text(job_of().to_json())
    command = [Path(sys.executable).with_name("rsibr"), "bake", "job.json", "--json", "--progress", "json"]
    with held_work_folder(work_folder_beside(OUTPUT)):
        others = [
            subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
            for _ in range(3)
        ]
        for other in others:
            assert other.stderr is not None
            assert "waiting for another process" in other.stderr.readline()
    told = [json.loads(other.communicate(timeout=PATIENCE_SECONDS)[0]) for other in others]
    assert [other.returncode for other in others] == [0, 0, 0]
    assert sorted("found" in each for each in told) == [False, True, True]


def test_what_a_process_left_that_was_killed_at_its_very_end_is_taken_without_asking() -> None:
    drain(bake(job_of()))
    folder = work_folder_beside(OUTPUT)
    folder.mkdir()
    (folder / "rsibr.lock").touch()
    assert drain(bake(replace(job_of(), if_missing=False))).figures == {"found": True}
    assert not folder.exists()
    with pytest.raises(OutputFileError, match="exists: give another name"):
        drain(bake(replace(job_of(), if_missing=False)))


def test_on_a_disk_without_locks_the_last_finds_what_the_first_has_made(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    method, job = bakes.METHODS["mip_chain"], job_of()

    def late(job: BakeJob[Any], recipe: Any) -> Any:
        drain(method.bake(job, recipe))
        return (yield from method.bake(job, recipe))

    monkeypatch.setitem(bakes.METHODS._rows, "mip_chain", replace(method, bake=late))
    assert drain(bake(job)).figures == {"found": True}


def test_a_read_only_file_is_kept_too() -> None:
    drain(bake(job_of()))
    OUTPUT.chmod(0o400)
    assert isinstance(drain(bake(job_of())), Baked)


@pytest.mark.parametrize(
    ("number", "code"), [(errno.ENOSPC, 75), (errno.ESTALE, 75), (errno.EACCES, 1), (errno.EROFS, 1)]
)
def test_what_may_pass_is_told_from_what_is_wrong_for_good(
    number: int, code: int, monkeypatch: pytest.MonkeyPatch, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    def refuse(*given: Any, **named: Any) -> None:
        raise OSError(number, "refused")

    monkeypatch.setattr(outputs, "_exchange", refuse)
    path = tmp_path / "job.json"
    path.write_text(job_of().to_json())
    assert run(["bake", str(path), "--json"]) == code
    assert json.loads(capfd.readouterr().out)["try_again"] is (code == 75)


def test_a_missing_file_is_wrong_for_good(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "job.json"
    path.write_text(job_of(light="none.exr").to_json())
    assert run(["bake", str(path), "--json"]) == 1
    result = json.loads(capfd.readouterr().out)
    assert (result["try_again"], result["error"]) == (
        False,
        "none.exr does not exist: check the name and the folder.",
    )
