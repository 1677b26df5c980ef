"""What the panel tells of a map set is what its file says, also after the file has changed."""

import re
from pathlib import Path

import numpy as np
import pytest
from rsibr.rsibr_addon.command_line.main import run
from rsibr.rsibr_addon.core.errors import MapSetError
from rsibr.rsibr_addon.files.kinds.registry import STORED
from rsibr.rsibr_addon.files.map_set import read_map_set, write_map_set
from rsibr.rsibr_addon.files.map_set_data import MapSet
from rsibr.rsibr_addon.tasks.report import facts as facts
from rsibr.rsibr_addon.tasks.report.pictures import map_set_pictures
from rsibr.tests.faults.small_map_sets import map_sets
from rsibr.tests.flat_capture import write_flat_capture


@pytest.fixture
def path(tmp_path: Path) -> Path:
    return write_flat_capture(tmp_path / "flat.rsibr.exr", (0.5, 0.0, 0.25))


def test_facts_follow_the_file(tmp_path: Path) -> None:
    path = tmp_path / "flat.rsibr.exr"
    with pytest.raises(MapSetError, match=r"flat\.rsibr\.exr"):
        facts.map_set_facts(path)
    write_flat_capture(path, (0.5, 0.0, 0.5))
    told = facts.map_set_facts(path)
    assert told["Kind"] == "Radiance Views"
    assert all(isinstance(which, str) and which for which in told.values())
    path.write_text("no picture any more")
    with pytest.raises(MapSetError, match=r"flat\.rsibr\.exr"):
        facts.map_set_facts(path)


@pytest.mark.parametrize("map_set", map_sets(), ids=lambda map_set: map_set.kind)
def test_info_tells_every_kind_in_words(
    map_set: MapSet, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "a.rsibr.exr"
    write_map_set(path, map_set)
    assert run(["info", str(path)]) == 0
    first, *lines = capfd.readouterr().out.splitlines()
    assert first == f"{path}: a map set, format 1"
    shown = dict(re.split("  +", line.strip(), maxsplit=1) for line in lines)
    assert list(shown)[:2] == ["Kind", "Light"]
    assert shown["Kind"] == STORED[map_set.kind].settings.LABEL
    assert facts.map_set_facts(path).items() <= shown.items()
    assert all(which and not set(f"{what}{which}") & set("_[]{}") for what, which in shown.items())


def test_files_are_read_once(path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    first = facts.map_set_facts(path), facts.map_set_content(path)

    def refuse(path: Path) -> None:
        raise AssertionError(f"{path} is read again")

    monkeypatch.setattr(facts, "read_map_set_header", refuse)
    assert (facts.map_set_facts(path), facts.map_set_content(path)) == first


def test_bright_maps_are_shown_darker(tmp_path: Path) -> None:
    (glossy,) = [
        picture
        for picture in map_set_pictures(write_flat_capture(tmp_path / "sun.rsibr.exr", (20.0, 10.0, 5.0)))
        if picture.title == "View 3, Glossy"
    ]
    np.testing.assert_allclose(glossy.pixels[4, 4], [1.0, 0.7353570, 0.5370987], atol=1e-6)


def test_pictures_are_of_every_map_the_environment_last(path: Path) -> None:
    pictures = map_set_pictures(path)
    parts = [part["name"] for part in read_map_set(path).header["parts"]]
    assert sorted(picture.name for picture in pictures) == sorted(parts)
    assert pictures[-1].title == "Environment"
    (glossy,) = [picture for picture in pictures if picture.title == "View 3, Glossy"]
    # 0.5 and 0.25 on the sRGB curve
    np.testing.assert_allclose(glossy.pixels[4, 4], [0.7353570, 0.0, 0.5370987], atol=1e-6)


def test_the_first_picture_is_no_black_one(tmp_path: Path) -> None:
    (map_set,) = (each for each in map_sets() if each.kind == "lobe_stack")
    first, second, *_ = (part["name"] for part in map_set.header["parts"])
    map_set.maps[first][:], map_set.maps[second][:] = 0.0, 1.0
    write_map_set(tmp_path / "a.rsibr.exr", map_set)
    pictures = [picture.name for picture in map_set_pictures(tmp_path / "a.rsibr.exr")]
    assert pictures[0] == second
    assert first in pictures[1:]
