"""What commands read: it is a file, and stays as it is."""

import json
import os
from pathlib import Path

import numpy as np
import pytest
from rsibr.rsibr_addon.core.errors import OutputFileError
from rsibr.rsibr_addon.files.apart import check_apart
from rsibr.rsibr_addon.files.radiance_pictures import write_radiance
from rsibr.tests.json_command import json_result

EQUIRECT = ("--from", "equirect", "--to", "equirect", "--size", "16")
BRACKETS = ("illuminate", "brackets", "light.hdr", "other.hdr", "--times", "1,2")
OVER_THEIR_SOURCE = {
    "bake": ("bake", "mip-chain", "--environment", "light.exr", "--size", "4", "-o", "light.exr"),
    "a link": ("bake", "mip-chain", "--environment", "light.exr", "--size", "4", "-o", "link.exr"),
    "export": ("export", "light.exr", "--for", "unity", "-o", "light.exr"),
    "convert": ("convert", "light.exr", "light.exr", *EQUIRECT),
    "ball": ("illuminate", "ball", "light.exr", "--circle", "8,4,3", "-o", "light.exr"),
    "brackets": (*BRACKETS, "-o", "other.hdr"),
    "painted": ("illuminate", "painted", "light.hdr", "--white", "4", "-o", "light.hdr"),
    "preview": ("preview", "light.exr", "-o", "light.exr"),
    "a background": ("preview", "light.hdr", "--background", "light.exr", "-o", "light.exr"),
    "a layer of a background": ("preview", "light.hdr", "--background", "light.exr:a", "-o", "light.exr"),
    "a layer baked": ("bake", "mip-chain", "--environment", "light.exr:a", "--size", "4", "-o", "light.exr"),
    "a layer exported": ("export", "light.exr:a", "--for", "unity", "-o", "light.exr"),
    "a layer converted": ("convert", "light.exr:a", "light.exr", *EQUIRECT),
    "a layer as a ball": ("illuminate", "ball", "light.exr:a", "--circle", "8,4,3", "-o", "light.exr"),
}


@pytest.fixture
def lights(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The folder that a test works in, with light.exr, light.hdr, other.hdr and a link to the first."""
    monkeypatch.chdir(tmp_path)
    for name in ("light.exr", "light.hdr", "other.hdr"):
        write_radiance(tmp_path / name, np.full((8, 16, 3), 0.5))
    (tmp_path / "link.exr").symlink_to("light.exr")
    return tmp_path


@pytest.mark.parametrize(
    "command",
    [
        pytest.param(name, marks=pytest.mark.needs("bpy") if argv[0] == "preview" else ())
        for name, argv in OVER_THEIR_SOURCE.items()
    ],
)
def test_even_force_replaces_no_source(command: str, lights: Path, capfd: pytest.CaptureFixture[str]) -> None:
    argv = OVER_THEIR_SOURCE[command]
    before = {path.name: path.read_bytes() for path in lights.iterdir()}
    result = json_result(capfd, *argv, "--force")
    assert " of which it is made: give another name" in result.get("error", "")
    assert {path.name: path.read_bytes() for path in lights.iterdir()} == before


def test_a_folder_does_not_replace_what_it_holds(tmp_path: Path) -> None:
    with pytest.raises(OutputFileError, match=r"compare would replace .*compare/a\.exr"):
        check_apart(tmp_path / "compare", [tmp_path / "compare" / "a.exr"])
    check_apart(tmp_path / "compare", [tmp_path / "compare-a.exr"])


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="this system has no named pipes")
@pytest.mark.parametrize("name", ["pipe.exr", "/dev/zero"])
@pytest.mark.parametrize(
    "command",
    [
        ("info", "{}"),
        ("bake", "mip-chain", "--environment", "{}", "-o", "a.rsibr.exr"),
        ("bake", "lobe-stack", "--environment", "light.exr", "--brdf", "merl:path={}", "-o", "a.rsibr.exr"),
        ("illuminate", "painted", "{}", "--white", "4", "-o", "a.exr"),
        ("batch", "{}"),
    ],
)
def test_what_never_ends_is_refused_at_once(
    command: tuple[str, ...], name: str, lights: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    os.mkfifo(lights / "pipe.exr")
    result = json_result(capfd, *(word.format(name) for word in command))
    assert result["error"] == f"{name} is a pipe or a device, not a file: save it as a file first."


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16"])
def test_a_job_is_read_as_editors_save_it(
    encoding: str, lights: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    job = {
        "format": 2,
        "kind": "mip_chain",
        "settings": {"size": 2},
        "light": {"environment": "light.exr"},
        "output": "a.rsibr.exr",
    }
    (lights / "a.json").write_text(json.dumps(job), encoding=encoding)
    assert json_result(capfd, "bake", "a.json")["map_set"] == "a.rsibr.exr"


@pytest.mark.parametrize("command", ["bake", "batch"])
def test_a_text_that_is_too_long_is_not_read(
    command: str, lights: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    with (lights / "film.json").open("wb") as stream:
        stream.truncate(1 << 36)  # of holes, which take no space
    result = json_result(capfd, command, "film.json")
    assert result["error"] == "film.json is longer than 8 MiB, so no text for this: give another file."
