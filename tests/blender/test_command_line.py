"""The command line: what it promises scripts that call it, and people."""

import ctypes
import json
import os
import re
import subprocess
import sys
import warnings
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from rsibr.rsibr_addon.command_line import info
from rsibr.rsibr_addon.command_line.commands import parsed
from rsibr.rsibr_addon.command_line.endings import interrupted
from rsibr.rsibr_addon.command_line.main import run
from rsibr.rsibr_addon.core.errors import RsibrError, RsibrWarning
from rsibr.rsibr_addon.core.progress import Progress
from rsibr.rsibr_addon.files.radiance_pictures import write_radiance

CAPTURE = ["capture", "--environment", "forest", "--material", "copper", "-o", "out.rsibr.exr"]


@pytest.mark.parametrize(
    ("argv", "told"),
    [
        ([], "COMMAND"),
        (["bake"], "bake"),
        (["info"], "NAME.rsibr.exr"),
        (["capture", "--environment", "forest"], "--material"),
        ([*CAPTURE, "--views", "13"], "13"),
        ([*CAPTURE, "--size", "0.5"], "'0.5' is not a whole number"),
        ([*CAPTURE, "--size", "²"], "'²' is not a whole number"),
        (["preview", "a.exr", "-o", "b.png", "--view", "1,2"], "'1,2' is neither a number nor 3 numbers"),
        (["preview", "a.exr", "-o", "b.png", "--mode", "magic"], "magic"),
        (["inof", "a.exr"], "there is no inof (did you mean info?): choose one of bake, "),
        (["bake", "mip-chian"], "there is no mip-chian (did you mean mip-chain?): choose one of "),
        (
            ["bake", "mip-chain", "--enviroment", "a.exr"],
            "no option --enviroment (did you mean --environment?)",
        ),
        (["bake", "mip-chain", "--filter", "bax"], "there is no bax (did you mean box?): choose one of "),
        (["info", "a.exr", "--josn"], "there is no option --josn (did you mean --json?)"),
        (["info", "a.exr", "b.exr"], "unknown arguments: b.exr"),
        (["info", "a.exr", "-x"], "unknown arguments: -x"),
    ],
)
def test_wrong_usage_is_2_and_says_what(
    argv: list[str], told: str, capfd: pytest.CaptureFixture[str]
) -> None:
    assert run(argv) == 2
    out, err = capfd.readouterr()
    assert out == ""
    assert err.startswith("usage: rsibr")
    assert told in err.splitlines()[-1]


@pytest.mark.parametrize(
    "words", [["info", "a.exr", "--nothing"], ["info", "a", "b"], ["bake", "mip-chain", "--x=1"]]
)
def test_wrong_usage_shows_the_usage_of_its_own_command(
    words: list[str], capfd: pytest.CaptureFixture[str]
) -> None:
    assert run(words) == 2
    command = " ".join(words[: 2 if words[0] == "bake" else 1])
    assert capfd.readouterr().err.startswith(f"usage: rsibr {command} [-h]")


@pytest.mark.parametrize(
    ("argv", "told"),
    [
        (["bake", "radiance-views", "--environment", "forest", "--material", "coper"], "copper"),
        (["bake", "radiance-views", "--environment", "forst", "--material", "copper"], "forest"),
        (["bake", "reflection-tables", "--environment", "forest", "--material", "varnish"], "varnished-wood"),
        (["bake", "lobe-stack", "--environment", "forest", "--brdf", "gxg:alpha=0.3"], "ggx"),
        (["bake", "lobe-stack", "--environment", "forest", "--brdf", "ggx:alpha=0.3,metal=cooper"], "copper"),
        (["bake", "reflection-tables", "--environment", "forest", "--specular", "fong:n=5"], "phong"),
    ],
)
def test_a_mistyped_name_is_answered_with_a_like_one(
    argv: list[str], told: str, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    assert run([*argv, "-o", str(tmp_path / "out.rsibr.exr")]) == 1
    assert f"(did you mean {told}?)" in capfd.readouterr().err


@pytest.mark.parametrize("command", ["bake mip-chain", "preview", "compare", "info"])
def test_every_command_explains_itself(command: str, capfd: pytest.CaptureFixture[str]) -> None:
    assert run([*command.split(), "--help"]) == 0
    out, _ = capfd.readouterr()
    assert out.startswith(f"usage: rsibr {command}")
    assert "--json" in out
    assert "--progress" in out


@pytest.mark.parametrize(
    "argv",
    [
        ["info", "missing.exr"],
        ["preview", "missing.exr", "-o", "out.png"],
        ["compare", "missing.exr", "-o", "out"],
        ["capture", "--environment", "missing.exr", "--material", "copper", "-o", "out.rsibr.exr"],
        ["capture", "--environment", "forest", "--material", "missing.exr.blend:M", "-o", "out.rsibr.exr"],
    ],
    ids=lambda argv: "-".join(argv[:3]),
)
def test_a_missing_file_is_1_and_one_sentence_that_names_it(
    argv: list[str], capfd: pytest.CaptureFixture[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    assert run([*argv, "--progress", "none"]) == 1
    out, err = capfd.readouterr()
    assert out == ""
    (line,) = (line for line in err.splitlines() if line.startswith("rsibr: error: "))
    assert "missing.exr" in line
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("name", ["out", "out.png.txt", "exr"])
@pytest.mark.parametrize(
    ("argv", "endings"),
    [
        (["bake", "radiance-views", "--material", "copper"], ".rsibr.exr or .exr"),
        (["bake", "lobe-stack", "--brdf", "ggx:alpha=0.3,f0=1"], ".rsibr.exr or .exr"),
        (["bake", "reflection-tables", "--material", "matte"], ".rsibr.exr or .exr"),
        (["bake", "mip-chain"], ".rsibr.exr or .exr"),
        (["bake", "kernel-bank"], ".rsibr.exr or .exr"),
        (["fit", "--brdf", "ggx:alpha=0.3,f0=1"], ".json"),
        (["report", "missing.exr"], ".html"),
        (["convert", "missing.exr", "--from", "equirect", "--to", "equirect", "--size", "2"], ".exr or .hdr"),
        (["illuminate", "painted", "missing.png", "--white", "9"], ".exr or .hdr"),
    ],
)
def test_a_file_whose_name_ends_otherwise_is_not_made(
    argv: list[str], endings: str, name: str, capfd: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    output = ["-o"] if argv[0] != "convert" else []
    assert run([*argv, *output, str(tmp_path / name)]) == 1
    assert f"{name} does not end in {endings}: give a name that does." in capfd.readouterr().err
    assert list(tmp_path.iterdir()) == []


@pytest.fixture
def work(monkeypatch: pytest.MonkeyPatch) -> Iterator[list[str]]:
    """Replace `rsibr info` by long work with every kind of noise; says how it was left."""
    left: list[str] = []

    def steps():
        try:
            os.write(1, b"noise at the descriptor\n")
            ctypes.CDLL(None).puts(b"noise in C's buffer")
            yield Progress(0, 2, "beginning")
            for _ in range(2):
                warnings.warn("The sky is dark: light it.", RsibrWarning, stacklevel=1)
            yield Progress(1, 2, "ending")
            if "fail" in left:
                raise RsibrError("The sky fell: hold it up.")
            if "system" in left:
                Path("missing.txt").read_text()
        finally:
            left.append("cleaned up")
        return 42

    def work(arguments, report):
        print("noise of Python")  # noqa: T201
        answer = report.steps(steps())
        report.say(f"The answer is {answer}.")
        return {"answer": answer}

    monkeypatch.setattr(info, "run", work)
    yield left
    assert left[-1] == "cleaned up"


@pytest.mark.usefixtures("work")
@pytest.mark.parametrize("verbose", [False, True])
def test_what_others_say_is_heard_only_when_asked_for(
    verbose: bool, capfd: pytest.CaptureFixture[str]
) -> None:
    assert run(["info", "x", "--progress", "none", *["--verbose"] * verbose]) == 0
    out, err = capfd.readouterr()
    assert out == "The answer is 42.\n"
    noise = ["noise at the descriptor", "noise in C's buffer", "noise of Python"]
    # The same warning twice is told once
    warning = "rsibr: warning: The sky is dark: light it."
    assert sorted(err.splitlines()) == [*(noise if verbose else []), warning]


@pytest.mark.usefixtures("work")
def test_json_result_holds_warnings(capfd: pytest.CaptureFixture[str]) -> None:
    assert run(["info", "x", "--json"]) == 0
    out, _ = capfd.readouterr()
    assert json.loads(out) == {"ok": True, "answer": 42, "warnings": ["The sky is dark: light it."]}


@pytest.mark.parametrize(
    ("how", "sentence"),
    [
        ("fail", "The sky fell: hold it up."),
        (
            "system",
            "missing.txt cannot be used (No such file or directory): check what is there, or give another.",
        ),
    ],
)
def test_failure_is_1_on_both_streams(
    how: str, sentence: str, work: list[str], capfd: pytest.CaptureFixture[str]
) -> None:
    work.append(how)
    assert run(["info", "x", "--json"]) == 1
    out, err = capfd.readouterr()
    told = {"ok": False, "error": sentence, "try_again": False, "warnings": ["The sky is dark: light it."]}
    assert json.loads(out) == told
    assert f"rsibr: error: {sentence}" in err.splitlines()


@pytest.mark.usefixtures("work")
def test_progress_as_json_lines(capfd: pytest.CaptureFixture[str]) -> None:
    assert run(["info", "x", "--progress", "json"]) == 0
    _, err = capfd.readouterr()
    assert [json.loads(line) for line in err.splitlines() if line.startswith("{")] == [
        {"progress": {"done": 0, "total": 2, "what": "beginning"}},
        {"progress": {"done": 1, "total": 2, "what": "ending"}},
    ]


@pytest.mark.usefixtures("work")
def test_progress_bar_fills_and_is_wiped(capfd: pytest.CaptureFixture[str]) -> None:
    assert run(["info", "x", "--progress", "bar"]) == 0
    _, err = capfd.readouterr()
    assert "[........................] 0/2 beginning" in err
    assert "[############............] 1/2 ending" in err
    assert err.endswith("\r\x1b[2K")


@pytest.mark.parametrize(("progress", "told"), [("bar", True), ("none", False)])
def test_errors_that_were_measured_are_told_to_whoever_watches(
    progress: str, told: bool, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    write_radiance(tmp_path / "light.exr", np.ones((8, 16, 3), np.float32))
    words = ["--environment", str(tmp_path / "light.exr"), "--material", "lambert:kd=0.5", "--size", "4"]
    output = str(tmp_path / "views.rsibr.exr")
    assert run(["bake", "radiance-views", *words, "-o", output, "--progress", progress]) == 0
    assert ("rsibr: 12 views are 1 % off for clay" in capfd.readouterr().err) is told


def test_a_bug_keeps_its_traceback(monkeypatch: pytest.MonkeyPatch) -> None:
    def steps():
        yield Progress(0, 1, "stumbling")
        raise ZeroDivisionError

    monkeypatch.setattr(info, "run", lambda arguments, report: report.steps(steps()))
    with pytest.raises(ZeroDivisionError):
        run(["info", "x"])


def test_help_loads_no_blender() -> None:
    script = (
        "import sys; from rsibr.rsibr_addon.command_line.main import run; run(['--help'])\n"
        "print({'bpy', 'gpu', 'OpenEXR', 'OpenImageIO'} & set(sys.modules), file=sys.stderr)"
    )
    process = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=False)
    assert process.stderr == "set()\n"


def test_console_is_the_installed_command() -> None:
    command = Path(sys.executable).with_name("rsibr")
    process = subprocess.run([command, "info", "missing.exr"], capture_output=True, text=True, check=False)
    assert process.returncode == 1
    assert process.stderr.startswith("rsibr: error: missing.exr")


@pytest.mark.parametrize(
    ("words", "goes_on"),
    [
        (["capture", "-o", "a.exr"], "and it goes on"),
        (["bake", "radiance-views", "-o", "a.exr"], "and it goes on"),
        (["bake", "job.json"], "a capture goes on"),
        (["job", "job.json"], "a capture goes on"),
        (["batch", "a.json"], "it goes on with the bakes"),
        (["bake", "mip-chain", "-o", "a.exr"], ""),
        (["bake", "--brdf", "ggx:alpha=1"], ""),
        (["info", "a.exr"], ""),
        ([], ""),
    ],
)
def test_what_is_interrupted_says_whether_it_goes_on(words: list[str], goes_on: str) -> None:
    sentence = interrupted(words)
    assert goes_on in sentence
    assert ("goes on" in sentence) is bool(goes_on)


@pytest.mark.parametrize(
    "words",
    [
        ["mip-chain", "--size", "8"],
        ["reflection-tables", "--material", "matte", "--diffuse-rows", "4"],
        ["kernel-bank", "--size", "16"],
        ["kernel-pyramid", "--size", "32"],
        ["lobe-stack", "--brdf", "phong:n=8,ks=0.5", "--lobes", "1", "--slices", "3", "--size", "16"],
    ],
)
def test_json_of_a_bake_has_the_figures_of_its_text(
    words: list[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    write_radiance("light.exr", np.ones((32, 64, 3)))
    command = ["bake", *words, "--environment", "light.exr", "-o", "out.exr", "--force"]
    assert run(command) == 0
    told = set(re.findall(r"[0-9]+", capfd.readouterr().out.partition(": ")[2]))
    assert run([*command, "--json"]) == 0
    found = json.loads(capfd.readouterr().out)
    assert told
    assert told <= set(re.findall(r"[0-9]+", json.dumps(found)))


def test_old_names_keep_their_defaults() -> None:
    capture = parsed(["capture", "--material", "copper", "-o", "a.rsibr.exr"])
    assert (capture.samples, capture.denoise) == (64, False)
    assert parsed(["capture", "--material", "copper", "--denoise", "--samples=9", "-o", "a.exr"]).denoise
    assert parsed(["bake", "--brdf", "lambert:kd=1", "-o", "a.rsibr.exr"]).half is False
    assert "half" not in parsed(["bake", "lobe-stack", "--brdf", "lambert:kd=1", "-o", "a.rsibr.exr"])
