"""Wrong usage: what is told of it, to people and to programs."""

import json

import pytest
from rsibr.rsibr_addon.command_line.main import run
from rsibr.rsibr_addon.files.version import rsibr


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


def test_all_commands_are_listed_and_all_kinds(capfd: pytest.CaptureFixture[str]) -> None:
    assert run(["--help"]) == run(["bake", "--help"]) == 0
    out = capfd.readouterr().out
    for name in ("bake", "info", "convert", "mip-chain", "kernel-bank"):
        assert f"\n    {name} " in out


def test_the_version_is_told(capfd: pytest.CaptureFixture[str]) -> None:
    assert run(["--version"]) == 0
    assert capfd.readouterr().out == f"{rsibr()}\n"


@pytest.mark.parametrize("word", ["0", "-2", "many", "1025", "9" * 5000])
def test_what_is_no_number_of_threads(
    word: str, capfd: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("RSIBR_THREADS", "2")
    monkeypatch.setenv("OPENBLAS_NUM_THREADS", "2")
    assert run(["info", "light.exr", f"--threads={word}"]) == 2
    assert f"argument --threads: {word} is no number of threads from 1 to 1024" in capfd.readouterr().err
