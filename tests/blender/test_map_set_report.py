"""The report of a map set: whole in itself, with everything that the set holds."""

import os
import re
import sys
from pathlib import Path

import numpy as np
import pytest
from rsibr.rsibr_addon.core.errors import MapSetError, OutputFileError
from rsibr.rsibr_addon.core.progress import drain
from rsibr.rsibr_addon.files.map_set import read_map_set, read_map_set_header
from rsibr.rsibr_addon.files.pictures import read_exr
from rsibr.rsibr_addon.files.radiance_pictures import write_radiance
from rsibr.rsibr_addon.job import BakeJob
from rsibr.rsibr_addon.settings.light import Light
from rsibr.rsibr_addon.settings.mip_chain import MipChainSettings
from rsibr.rsibr_addon.tasks.methods.bake import bake
from rsibr.rsibr_addon.tasks.report.report import map_set_report

pytestmark = pytest.mark.needs("gl")


@pytest.fixture(scope="module")
def map_set(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("mips") / "<mips>.rsibr.exr"
    job = BakeJob(MipChainSettings(filter="box", size=16), str(path), Light(environment="forest"))
    return drain(bake(job)).path


def test_all_of_a_map_set_is_on_its_page(map_set: Path, tmp_path: Path) -> None:
    text = drain(map_set_report(map_set, tmp_path / "report.html")).read_text()
    header = read_map_set_header(map_set)
    assert "&lt;mips&gt;.rsibr.exr" in text
    for part in header["parts"]:
        assert f'alt="{part["name"]}"' in text
    assert header["software"] in text
    # Two pictures drawn with it, and one of each map
    assert text.count("data:image/png;base64,") == 2 + len(header["parts"])
    assert not re.search(r"<script|<link|https?:|src=\"(?!data:)", text)


@pytest.mark.skipif(sys.platform != "linux", reason="names are text in other systems")
def test_names_that_are_no_utf8_are_shown_as_far_as_they_can_be(tmp_path: Path) -> None:
    light, path = (tmp_path / os.fsdecode(b"caf\xe9" + kind) for kind in (b".exr", b".rsibr.exr"))
    write_radiance(tmp_path / "light.exr", np.ones((16, 32, 3)))
    (tmp_path / "light.exr").rename(light)
    settings, output = MipChainSettings(filter="box", size=16), str(tmp_path / "a.rsibr.exr")
    drain(bake(BakeJob(settings, output, Light(environment=str(light)))))
    (tmp_path / "a.rsibr.exr").rename(path)
    text = drain(map_set_report(path, tmp_path / "report.html")).read_text()
    assert "caf?.rsibr.exr" in text
    assert "caf\ufffd.exr, 32 x 16" in text


def test_files_are_not_replaced_unasked(map_set: Path, tmp_path: Path) -> None:
    report = tmp_path / "report.html"
    report.write_text("mine")
    with pytest.raises(OutputFileError, match="exists"):
        drain(map_set_report(map_set, report))
    assert report.read_text() == "mine"
    assert drain(map_set_report(map_set, report, force=True)).read_text().startswith("<!doctype html>")


def test_maps_are_written_at_their_full_size(map_set: Path, tmp_path: Path) -> None:
    drain(map_set_report(map_set, tmp_path / "report.html", maps=tmp_path / "maps"))
    held = read_map_set(map_set)
    written = {path.stem: read_exr(path) for path in (tmp_path / "maps").iterdir()}
    assert written.keys() == held.maps.keys()
    for name, picture in written.items():
        np.testing.assert_array_equal(picture[..., :3], held.maps[name])
    again = tmp_path / "again.html"
    with pytest.raises(OutputFileError, match="maps exists"):
        drain(map_set_report(map_set, again, maps=tmp_path / "maps"))
    assert not again.exists()


def test_bad_names_are_told(map_set: Path, tmp_path: Path) -> None:
    with pytest.raises(OutputFileError, match=r"report.txt does not end in .html"):
        drain(map_set_report(map_set, tmp_path / "report.txt"))
    with pytest.raises(MapSetError, match="does not exist"):
        drain(map_set_report(tmp_path / "none.rsibr.exr", tmp_path / "report.html"))
