"""A map set is data: what it names is not opened because it says so."""

from dataclasses import replace
from pathlib import Path
from typing import Any

import bpy
import numpy as np
import pytest
from rsibr.rsibr_addon.core.brdf.lambert import Lambert
from rsibr.rsibr_addon.core.environment import Environment
from rsibr.rsibr_addon.core.errors import InputFileError, RangeError
from rsibr.rsibr_addon.core.kinds.lobe_stack.stack import LobeStack
from rsibr.rsibr_addon.core.lobes.bank import KernelBank
from rsibr.rsibr_addon.core.progress import drain
from rsibr.rsibr_addon.files import brdfs as readers
from rsibr.rsibr_addon.files.kinds.lobe_stack import PROFILES, profiles, to_map_set
from rsibr.rsibr_addon.files.map_set import read_map_set, write_map_set
from rsibr.rsibr_addon.files.map_set_data import MapSet
from rsibr.rsibr_addon.files.map_set_header import Origin
from rsibr.rsibr_addon.host import materials
from rsibr.rsibr_addon.job import read_job
from rsibr.rsibr_addon.settings.lobe_stack import StackComparison
from rsibr.rsibr_addon.settings.radiance_views import ViewsComparison
from rsibr.rsibr_addon.tasks.compare.compare import compare
from rsibr.rsibr_addon.tasks.queue.bake_request import comparison_of
from rsibr.rsibr_addon.tasks.reflectance.brdfs import check_told_brdf, told_brdf
from rsibr.rsibr_addon.tasks.report.report import map_set_report
from rsibr.tests.flat_capture import write_flat_capture
from rsibr.tests.lobe_stacks import random_fit, random_stack

needs_gl = pytest.mark.needs("gl")

ELSEWHERE = ["merl:path=/etc/passwd", " merl : path = /etc/passwd", " blend:/art/evil.blend:Evil"]
ELSEWHERE += ["layered:coat=(ggx:alpha=0.1,eta=1.5),base=(rgl:path=/etc/passwd)"]
"""Models in other files."""


@pytest.fixture(autouse=True)
def nothing_else_is_opened(monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(path: Any, *_: Any) -> None:
        raise AssertionError(f"{path} is opened")

    monkeypatch.setattr(readers, "READERS", dict.fromkeys(readers.READERS, refuse))
    monkeypatch.setattr(materials, "_appended", refuse)


def write_stack(path: Path, brdf: str) -> Path:
    fit = random_fit(KernelBank((0.5, 4.0)))
    maps = random_stack("octahedral").maps[:2, :4]
    stack = LobeStack("octahedral", fit.mu, maps, fit.scale, fit.offsets, fit.taps, fit.albedo)
    light = Environment(np.ones((8, 16, 3), dtype=np.float32), "light")
    material = {"brdf": brdf, "method": "joint", PROFILES: profiles(fit)}
    write_map_set(path, to_map_set(stack, Origin(light, {}, "test", material)))
    return path


@pytest.mark.parametrize("spec", ELSEWHERE)
def test_a_model_in_another_file_is_refused(spec: str) -> None:
    for told in (told_brdf, check_told_brdf):
        with pytest.raises(InputFileError, match="--brdf"):
            told(spec)


def test_a_model_that_needs_no_file_is_made() -> None:
    assert told_brdf("lambert:kd=0.5") == Lambert(kd=0.5)
    check_told_brdf("lambert:kd=0.5")
    check_told_brdf("blend:copper")
    check_told_brdf("blend::Material")
    with pytest.raises(RangeError, match="There is no BRDF model"):
        check_told_brdf("hologram:kd=1")


def test_a_material_of_the_open_file_is_no_other_file(tmp_path: Path) -> None:
    blend = tmp_path / "art.blend"
    assert materials.names_other_file(f"{blend}:Paint")
    bpy.ops.wm.save_as_mainfile(filepath=str(blend))
    assert not materials.names_other_file(f"{blend}:Paint")
    assert not materials.names_other_file("copper")
    assert not materials.names_other_file(":Paint")


@needs_gl
@pytest.mark.slow
@pytest.mark.parametrize("spec", [*ELSEWHERE[1:3], "hologram:kd=1", "(" * 4000])
def test_the_report_lacks_one_line(tmp_path: Path, spec: str) -> None:
    path = write_stack(tmp_path / "a.rsibr.exr", spec)
    page = drain(map_set_report(path, tmp_path / "a.html")).read_text()
    assert "The BRDF is not shown. " in page
    assert page.count("data:image/svg+xml;base64,") == 3


@needs_gl
@pytest.mark.slow
def test_the_report_plots_the_model_that_is_named(tmp_path: Path) -> None:
    path = write_stack(tmp_path / "a.rsibr.exr", ELSEWHERE[0])
    named = drain(map_set_report(path, tmp_path / "a.html", brdf="lambert:kd=0.5")).read_text()
    assert "The BRDF is not shown." not in named
    with pytest.raises(AssertionError, match="/etc/passwd is opened"):
        drain(map_set_report(path, tmp_path / "b.html", brdf=ELSEWHERE[0]))


@needs_gl
def test_stacks_are_compared_with_files_that_are_named(tmp_path: Path) -> None:
    path, settings = write_stack(tmp_path / "a.rsibr.exr", ELSEWHERE[0]), StackComparison(views=1, size=8)
    with pytest.raises(InputFileError, match=r"names a model in /etc/passwd, .* with --brdf"):
        drain(compare(path, settings, tmp_path / "out"))
    with pytest.raises(AssertionError, match="/etc/passwd is opened"):
        drain(compare(path, replace(settings, brdf=ELSEWHERE[0]), tmp_path / "out"))
    found = drain(compare(path, replace(settings, brdf="lambert:kd=0.5"), tmp_path / "out"))
    assert found.material == "lambert:kd=0.5"


@needs_gl
def test_views_are_compared_with_files_that_are_named(tmp_path: Path) -> None:
    flat = read_map_set(write_flat_capture(tmp_path / "flat.rsibr.exr", (0.5, 0.0, 0.5)))
    path, spec = tmp_path / "a.rsibr.exr", "/art/evil.blend:Evil"
    header = flat.header | {"material": flat.header["material"] | {"spec": spec}}
    write_map_set(path, MapSet(flat.kind, flat.maps, header))
    settings = ViewsComparison(views=1, size=8)
    with pytest.raises(InputFileError, match=r"names the material /art/evil\.blend:Evil, .* with --material"):
        drain(compare(path, settings, tmp_path / "out"))
    with pytest.raises(AssertionError, match=r"/art/evil\.blend is opened"):
        drain(compare(path, replace(settings, material=spec), tmp_path / "out"))


@pytest.mark.usefixtures("registered")
def test_the_panel_names_the_file_that_its_artist_chose(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("rsibr.rsibr_addon.tasks.queue.bake_request.blender_program", lambda: "blender")
    path, item = write_stack(tmp_path / "a.rsibr.exr", ELSEWHERE[0]), bpy.context.object
    gold = tmp_path / "gold.binary"
    gold.touch()

    def arguments() -> tuple[str, ...]:
        bake = comparison_of(bpy.context.scene, item, path)
        job = read_job(Path(bake.command[-4]).read_text(), "job")
        bake.tidy()
        return job.arguments

    assert "--brdf" not in arguments()
    item.rsibr_baked.kind = "lobe_stack"
    chosen = item.rsibr_baked.lobe_stack
    chosen.source, chosen.path = "FILE", str(gold)
    assert f"merl:path={gold}" in arguments()
    gold.unlink()
    with pytest.raises(InputFileError, match=r"There is no file .*gold\.binary"):
        arguments()
    chosen.source = "OWN"
    assert "--brdf" not in arguments()
