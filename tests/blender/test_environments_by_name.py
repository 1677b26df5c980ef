"""What `--environment` takes: files, Blender's own by name, and a sentence for all else."""

from pathlib import Path

import numpy as np
import pytest
from rsibr.rsibr_addon.command_line.main import run
from rsibr.rsibr_addon.core.errors import InputFileError
from rsibr.rsibr_addon.files.map_set import read_map_set
from rsibr.rsibr_addon.files.radiance_pictures import write_radiance
from rsibr.rsibr_addon.host.installation import studio_environments
from rsibr.rsibr_addon.tasks.light.environments import load_environment

MIPS = ["bake", "mip-chain", "--size", "4", "--filter", "box"]


@pytest.mark.parametrize("path", ["nothere.hdr", "nothere.exr:sky", "folder/forest", "./forest"])
def test_a_path_that_is_not_there_is_a_missing_file(path: str) -> None:
    with pytest.raises(InputFileError, match=r"^\S+ does not exist: check the name and the folder"):
        load_environment(path)


def test_a_bare_name_that_is_not_known_is_told_the_known_ones() -> None:
    with pytest.raises(InputFileError, match=r"There is no environment grove.*forest"):
        load_environment("grove")


def test_blenders_own_environments_are_taken_in_silence() -> None:
    for name, path in studio_environments().items():  # a warning is an error
        by_name, by_path = load_environment(name), load_environment(str(path))
        assert by_name.sha256 == by_path.sha256
        assert by_name.radiance.min() >= 0.0


@pytest.mark.parametrize("layer", ["", ":environment", ":mip00"])
def test_a_map_set_is_no_environment(
    layer: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    write_radiance("sky.hdr", np.ones((4, 8, 3)))
    assert run([*MIPS, "--environment", "sky.hdr", "-o", "sky.rsibr.exr"]) == 0
    capfd.readouterr()
    assert run([*MIPS, "--environment", f"sky.rsibr.exr{layer}", "-o", "new.rsibr.exr"]) == 1
    told = f"sky.rsibr.exr{layer} is a map set, not a picture: give the picture that it was made of."
    assert capfd.readouterr().err == f"rsibr: error: {told}\n"


@pytest.mark.slow
def test_previews_and_exports_show_the_light_of_a_name(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    forest = str(studio_environments()["forest"])
    for light, output in (("forest", "name"), (forest, "path")):
        assert run(["export", light, "--for", "any", "--size", "16", "-o", f"{output}.ktx2"]) == 0
        assert run(["preview", light, "--size", "8", "-o", f"{output}.exr"]) == 0
    for ending in ("ktx2", "exr"):
        assert Path(f"name.{ending}").read_bytes() == Path(f"path.{ending}").read_bytes()
    capfd.readouterr()
    assert run(["export", "grove", "--for", "any", "-o", "grove.ktx2"]) == 1
    assert "There is no environment grove" in capfd.readouterr().err


def test_a_probe_has_the_light_of_a_name(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    write_radiance("sky.hdr", np.ones((4, 8, 3)))
    forest = studio_environments()["forest"]
    for light, output in (("forest", "name"), (forest, "path")):
        probe = f"box:light={light},size=4/4/4"
        assert run([*MIPS, "--environment", "sky.hdr", "--probes", probe, "-o", f"{output}.rsibr.exr"]) == 0
    by_name, by_path = (read_map_set(Path(f"{name}.rsibr.exr")) for name in ("name", "path"))
    assert by_name.maps.keys() == by_path.maps.keys()
    for name, values in by_name.maps.items():
        np.testing.assert_array_equal(values, by_path.maps[name])
