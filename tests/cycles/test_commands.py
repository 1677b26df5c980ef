"""The commands one after the other, as a user gives them."""

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from rsibr.rsibr_addon.files.map_set import read_map_set
from rsibr.rsibr_addon.files.pictures import read_exr
from rsibr.tests.json_command import json_result

pytestmark = [pytest.mark.needs("gl"), pytest.mark.usefixtures("quick_furnace")]

CAPTURE = ["capture", "--environment", "forest", "--material", "copper", "--size", "16", "--samples", "2"]
CAPTURE += ["-o", "copper.rsibr.exr"]

Command = Callable[..., dict[str, Any]]


@pytest.fixture
def rsibr(capfd: pytest.CaptureFixture[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Command:
    """Run a command in a folder of its own, and return its JSON result."""
    monkeypatch.chdir(tmp_path)

    def command(*argv: str) -> dict[str, Any]:
        return json_result(capfd, *argv, "--progress", "json")

    return command


def test_capture_info_preview_compare(rsibr: Command, tmp_path: Path) -> None:
    captured = rsibr(*CAPTURE)
    assert captured["map_set"] == "copper.rsibr.exr"
    # The forest holds negative pixels, but nobody can mend what Blender brings
    assert captured["warnings"] == []
    assert (captured["views"], captured["size"]) == (12, 16)
    assert len(read_map_set("copper.rsibr.exr", "radiance_views").maps) == 2 + 2 * 12

    header = rsibr("info", "copper.rsibr.exr")["header"]
    assert header["settings"] == {"views": 12, "size": 16, "samples": 2, "denoise": False, "seed": 0}

    # --view may begin with a minus; "--view X" and "--view=X" are the same
    first = rsibr("preview", "copper.rsibr.exr", "--view", "-1,0,0.5", "--size", "8", "-o", "a.exr")
    rsibr("preview", "copper.rsibr.exr", "--view=-1,0,0.5", "--size", "8", "-o", "b.exr")
    assert first["picture"] == "a.exr"
    assert read_exr("a.exr").shape == (8, 8, 4)
    assert (read_exr("a.exr") == read_exr("b.exr")).all()

    turned = rsibr("preview", "copper.rsibr.exr", "--size", "32", "--turntable", "2", "-o", "turn.png")
    assert turned["movie"] == "turn.mp4"
    assert {"turn.png", "turn.mp4"} <= {path.name for path in tmp_path.iterdir()}

    limits = ["--views", "1", "--size", "8", "--samples", "4", "--mode", "fragment", "--warp", "split"]
    compared = rsibr("compare", "copper.rsibr.exr", *limits, "-o", "compare")
    assert Path(compared["page"]).exists()
    assert compared["comparison"] == json.loads(Path("compare/comparison.json").read_text())
    assert len(compared["comparison"]["errors"]) == 1


def test_an_output_that_exists_is_refused_before_any_work(rsibr: Command) -> None:
    Path("copper.rsibr.exr").write_text("precious")
    refused = rsibr(*CAPTURE)
    assert "copper.rsibr.exr" in refused["error"]
    assert "--force" in refused["error"]
    assert Path("copper.rsibr.exr").read_text() == "precious"
