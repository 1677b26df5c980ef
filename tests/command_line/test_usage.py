"""Wrong usage: what is told of it, to people and to programs."""

import json
from pathlib import Path

import numpy as np
import pytest
from rsibr.rsibr_addon.command_line.main import run
from rsibr.rsibr_addon.files import memory
from rsibr.rsibr_addon.files.radiance_pictures import write_radiance
from rsibr.rsibr_addon.files.version import rsibr
from rsibr.rsibr_addon.tasks.export.engines.engines import ENGINES


@pytest.mark.parametrize(
    "argv", [["convrt"], ["info"], ["bake", "mip-chian"], ["convert", "a.exr", "b.exr", "--sise", "4"]]
)
def test_wrong_usage_is_told_as_json_too(argv: list[str], capfd: pytest.CaptureFixture[str]) -> None:
    assert run([*argv, "--json"]) == 2
    out, err = capfd.readouterr()
    result = json.loads(out)
    assert (result["ok"], result["warnings"]) == (False, [])
    assert err.splitlines()[-1].endswith(f": error: {result['error']}")
    assert run(argv) == 2
    assert capfd.readouterr().out == ""


@pytest.mark.parametrize(
    ("words", "name"),
    [
        (("info", ""), "NAME.rsibr.exr|PICTURE"),
        (("bake", "mip-chain", "--environment", "", "-o", "x.exr"), "--environment"),
        (("preview", "x.rsibr.exr", "--tables", "", "-o", "x.png"), "--tables"),
    ],
)
def test_an_empty_word_is_refused(
    words: tuple[str, ...], name: str, capfd: pytest.CaptureFixture[str]
) -> None:
    assert run(list(words)) == 2
    assert f"argument {name}: it is empty: give a value, or leave it out" in capfd.readouterr().err


@pytest.mark.parametrize(
    ("words", "told"),
    [
        (("",), "COMMAND: it is empty: choose one of bake, "),
        (("bake", " "), "KIND: it is empty: choose one of kernel-pyramid, "),
        (("backe",), "COMMAND: there is no backe (did you mean bake?): choose one of bake, "),
    ],
)
def test_a_name_that_is_none_of_the_known_is_told(
    words: tuple[str, ...], told: str, capfd: pytest.CaptureFixture[str]
) -> None:
    assert run(list(words)) == 2
    assert told in capfd.readouterr().err


@pytest.mark.parametrize("before", [(), ("--environment",)])
def test_a_file_whose_name_begins_like_an_option_is_told_of(
    before: tuple[str, ...], capfd: pytest.CaptureFixture[str]
) -> None:
    command = ["bake", "mip-chain"] if before else ["info"]
    assert run([*command, *before, "-dash.exr"]) == 2
    assert (
        "there is no option -dash.exr: write ./-dash.exr for the file of this name" in capfd.readouterr().err
    )
    assert run(["info", "./-dash.exr"]) == 1
    assert "-dash.exr does not exist" in capfd.readouterr().err


def test_all_commands_are_listed_and_all_kinds(capfd: pytest.CaptureFixture[str]) -> None:
    assert run(["--help"]) == run(["bake", "--help"]) == 0
    out = capfd.readouterr().out
    for name in ("bake", "info", "convert", "mip-chain", "kernel-bank"):
        assert f"\n    {name} " in out


def test_the_version_is_told(capfd: pytest.CaptureFixture[str]) -> None:
    assert run(["--version"]) == 0
    assert capfd.readouterr().out == f"{rsibr()}\n"


def test_an_export_names_every_ending_that_it_would_take(capfd: pytest.CaptureFixture[str]) -> None:
    assert run(["export", "missing.exr", "-o", "out.foo"]) == 1
    said = capfd.readouterr().err
    assert "out.foo does not end in .ktx2 or .html, nor, with --for ENGINE, in .dds or" in said
    assert {ending for each in ENGINES.values() for ending in each.endings} <= set(
        said.replace(":", "").split()
    )


def test_what_lacks_memory_may_succeed_another_time(
    tmp_path: Path, capfd: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(memory, "memory_left", lambda: 1e6)
    light, output = tmp_path / "light.exr", tmp_path / "out.rsibr.exr"
    write_radiance(light, np.ones((8, 16, 3), np.float32), "light")
    argv = ["bake", "mip-chain", "--environment", str(light), "-o", str(output), "--json"]
    assert run(argv) == 75
    assert json.loads(capfd.readouterr().out)["try_again"]


@pytest.mark.parametrize("word", ["0", "-2", "many", "1025", "9" * 5000])
def test_what_is_no_number_of_threads(
    word: str, capfd: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("RSIBR_THREADS", "2")
    monkeypatch.setenv("OPENBLAS_NUM_THREADS", "2")
    assert run(["info", "light.exr", f"--threads={word}"]) == 2
    assert f"argument --threads: {word} is no number of threads from 1 to 1024" in capfd.readouterr().err
