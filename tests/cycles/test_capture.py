"""Captures: the right views in the right place, whole or to be resumed, and refused in words."""

import signal
import subprocess
import sys
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import bpy
import numpy as np
import pytest
from rsibr.rsibr_addon.core.conventions import texel_centres
from rsibr.rsibr_addon.core.environment import Environment
from rsibr.rsibr_addon.core.errors import (
    InputFileError,
    OutputFileError,
    RangeError,
    RenderError,
    RsibrWarning,
    SceneError,
)
from rsibr.rsibr_addon.core.geometry.directions import reflect
from rsibr.rsibr_addon.core.maps import equirect, sphere_map
from rsibr.rsibr_addon.core.progress import Progress, drain
from rsibr.rsibr_addon.files import memory
from rsibr.rsibr_addon.files.map_set import read_map_set
from rsibr.rsibr_addon.files.pictures import write_exr
from rsibr.rsibr_addon.host.cycles import BYTES_BESIDES, bytes_needed, render_view
from rsibr.rsibr_addon.host.worlds import LIGHT_OF_TEXEL, light_with
from rsibr.rsibr_addon.job import BakeJob
from rsibr.rsibr_addon.settings.light import Light
from rsibr.rsibr_addon.settings.radiance_views import RadianceViewsSettings
from rsibr.rsibr_addon.tasks.light import environments
from rsibr.rsibr_addon.tasks.methods import views_by_cycles as task
from rsibr.rsibr_addon.tasks.methods.bake import bake
from rsibr.rsibr_addon.tasks.methods.kinds import open_map_set
from rsibr.tests.open_file import open_file_state

pytestmark = pytest.mark.usefixtures("quick_furnace")

LIT = (12, 3)


@pytest.fixture
def environment(tmp_path: Path) -> Environment:
    """Dim light from everywhere, and one texel that is bright: at (tmp_path / "light.exr")."""
    radiance = np.full((16, 32, 4), 0.01, dtype=np.float32)
    radiance[LIT] = 100.0
    write_exr(tmp_path / "light.exr", radiance)
    return Environment(radiance[..., :3], "light.exr")


@pytest.fixture
def job(tmp_path: Path, environment: Environment) -> BakeJob:
    """A capture that takes a second."""
    settings = RadianceViewsSettings(material="copper", size=12, samples=4, denoise=False, seed=3)
    light = Light(environment=str(tmp_path / "light.exr"))
    return BakeJob(settings, str(tmp_path / "copper.rsibr.exr"), light)


def changed(job: BakeJob, **settings: object) -> BakeJob:
    return replace(job, settings=replace(job.settings, **settings))


@pytest.fixture
def partial(tmp_path: Path) -> Path:
    return tmp_path / "copper.rsibr.exr.partial"


@pytest.fixture
def rendered(monkeypatch: pytest.MonkeyPatch) -> Iterator[list[int]]:
    """Seeds of the views that were rendered."""
    seeds: list[int] = []

    def counted(scene: object, settings: object) -> object:
        seeds.append(settings.seed)
        return render_view(scene, settings)

    monkeypatch.setattr(task, "render_view", counted)
    return seeds


def steps(job: BakeJob, count: int) -> Iterator[Progress]:
    """A capture that has rendered `count` views, and waits."""
    work = bake(job)
    for _ in range(count + 2):
        next(work)
    return work


def test_a_capture_is_whole(job: BakeJob, environment: Environment, partial: Path) -> None:
    told = list(bake(job))
    assert [progress.done for progress in told] == [0, *range(12)]
    assert {progress.total for progress in told} == {12}
    assert not partial.exists()

    map_set = read_map_set(job.output, "radiance_views")
    np.testing.assert_array_equal(map_set.maps["environment"], environment.radiance)
    assert map_set.header["environment"]["sha256"] == environment.sha256
    assert map_set.header["environment"]["name"] == "light.exr"
    assert map_set.header["settings"] == {"views": 12, "size": 12, "samples": 4, "denoise": False, "seed": 3}
    assert map_set.header["material"]["spec"] == map_set.header["material"]["name"] == "copper"
    assert map_set.header["software"].endswith(f"Blender {bpy.app.version_string}")
    assert 0.0 < map_set.header["error_bound"]["relative_noise"] < 10.0
    views = open_map_set(Path(job.output)).content
    assert views.size == 12
    assert not np.any(views.diffuse)  # copper is a metal
    # Filled beyond the rim: corners repeat what is there.
    assert np.all(views.glossy[:, 0, 0].sum(axis=-1) > 0.0)


def test_a_lit_texel_lands_in_every_view_where_the_conventions_say(job: BakeJob) -> None:
    size = 48
    drain(bake(changed(job, material="mirror", size=size, samples=8)))
    views = open_map_set(Path(job.output)).content
    lit = equirect.direction_from_uv(texel_centres(32, 16)[LIT])
    inside = sphere_map.texel_solid_angle(size) * size**2 / 16.0 > 0.999
    for view_dir, frame, glossy in zip(views.sphere.vertices, views.frames, views.glossy, strict=True):
        normal = sphere_map.normal_from_uv(texel_centres(size, size)) @ frame.T
        direction = reflect(np.broadcast_to(view_dir, normal.shape), normal)[inside]
        light = glossy[inside][:, 0] - 0.01
        mean = light @ direction
        # The rest is dim and even; near the rim a texel of the view shows many directions.
        if lit @ view_dir > -0.8:
            assert mean @ lit / np.linalg.norm(mean) > np.cos(np.radians(4.0))


def test_an_interrupted_capture_goes_on(job: BakeJob, partial: Path, rendered: list[int]) -> None:
    drain(bake(job))
    uninterrupted = Path(job.output).read_bytes()
    Path(job.output).unlink()
    rendered.clear()

    before = open_file_state()
    work = steps(job, 4)
    assert open_file_state() == before
    work.close()
    assert open_file_state() == before
    assert not Path(job.output).exists()
    assert len(list(partial.glob("view*.exr"))) == 4
    drain(bake(job))
    assert rendered == [3 + view for view in range(12)]  # each once
    assert Path(job.output).read_bytes() == uninterrupted
    assert not partial.exists()


def test_a_killed_capture_goes_on_bit_for_bit(job: BakeJob, partial: Path, rendered: list[int]) -> None:
    job = changed(job, denoise=True)
    drain(bake(job))
    uninterrupted = Path(job.output).read_bytes()
    Path(job.output).unlink()
    rendered.clear()

    script = (
        "import os, signal, sys\n"
        "from rsibr.rsibr_addon.job import read_job\n"
        "from rsibr.rsibr_addon.tasks.methods.bake import bake\n"
        "for progress in bake(read_job(sys.argv[1], 'job')):\n"
        "    if progress.done == 6:\n"
        "        os.kill(os.getpid(), signal.SIGKILL)\n"
    )
    command = [sys.executable, "-c", script, job.to_json()]
    process = subprocess.run(command, capture_output=True, check=False)
    assert process.returncode == -signal.SIGKILL
    assert not Path(job.output).exists()
    assert len(list(partial.glob("view*.exr"))) == 6
    drain(bake(job))
    assert len(rendered) == 6
    assert Path(job.output).read_bytes() == uninterrupted
    assert not partial.exists()


@pytest.mark.parametrize("described", [True, False])
def test_a_capture_killed_after_it_named_its_output_needs_no_force(
    described: bool, job: BakeJob, partial: Path, rendered: list[int]
) -> None:
    drain(bake(job))
    whole = Path(job.output).read_bytes()
    Path(job.output).unlink()
    steps(job, 11).close()
    Path(job.output).write_bytes(whole)
    if not described:
        (partial / "job.json").unlink()  # it goes before the views do
    rendered.clear()
    with pytest.raises(OutputFileError, match=r"exists, made with other settings \(Seed 3, not 50\)"):
        drain(bake(changed(job, seed=50)))
    assert len(list(partial.glob("view*.exr"))) == 11
    drain(bake(job))
    assert not partial.exists()
    assert rendered == []
    assert Path(job.output).read_bytes() == whole
    # Now nothing tells that it was interrupted
    with pytest.raises(OutputFileError, match=r"exists: .*--force"):
        drain(bake(job))


@pytest.mark.parametrize("denoise", [False, True])
def test_a_size_that_memory_does_not_hold_is_refused_before_any_view(
    denoise: bool, job: BakeJob, partial: Path, rendered: list[int], monkeypatch: pytest.MonkeyPatch
) -> None:
    left = BYTES_BESIDES + LIGHT_OF_TEXEL * 16 * 32 + bytes_needed(100**2, denoise)
    monkeypatch.setattr(memory, "memory_left", lambda: left)
    with pytest.raises(RangeError, match=r" at 200x200, .*: shrink it to (100x100|99x99) at most"):
        drain(bake(changed(job, size=200, denoise=denoise)))
    assert rendered == []
    assert not partial.exists()
    drain(bake(changed(job, size=99, denoise=denoise, samples=2)))


def test_views_of_another_job_are_not_taken(job: BakeJob, partial: Path, rendered: list[int]) -> None:
    steps(job, 2).close()
    rendered.clear()
    with pytest.warns(RsibrWarning, match=r"partial held parts of another job"):
        drain(bake(changed(job, seed=50)))
    assert len(rendered) == 12
    assert not partial.exists()


def test_a_damaged_view_is_rendered_again(job: BakeJob, partial: Path, rendered: list[int]) -> None:
    steps(job, 3).close()
    damaged = partial / "view001.exr"
    damaged.write_bytes(damaged.read_bytes()[:-100])
    rendered.clear()
    drain(bake(job))
    assert rendered == [3 + view for view in (1, *range(3, 12))]


def test_two_captures_do_not_meet(job: BakeJob) -> None:
    first = steps(job, 1)
    assert next(bake(job)).what == "waiting for another process that makes copper.rsibr.exr"
    first.close()
    drain(bake(job))


def test_an_output_that_exists_is_refused_at_once(job: BakeJob, rendered: list[int]) -> None:
    Path(job.output).write_text("precious")
    with pytest.raises(OutputFileError, match=r"exists: .*--force"):
        next(bake(job))
    assert Path(job.output).read_text() == "precious"
    drain(bake(replace(job, force=True)))
    assert read_map_set(job.output).kind == "radiance_views"


def test_an_output_that_appears_meanwhile_stays(job: BakeJob, partial: Path) -> None:
    work = steps(job, 1)
    Path(job.output).write_text("precious")
    with pytest.raises(OutputFileError, match="exists"):
        drain(work)
    assert Path(job.output).read_text() == "precious"
    Path(job.output).unlink()
    drain(bake(job))
    assert not partial.exists()


def test_a_foreign_folder_in_the_way_stays(job: BakeJob, partial: Path) -> None:
    partial.mkdir()
    (partial / "thesis.txt").write_text("precious")
    with pytest.raises(OutputFileError, match="holds files other than unfinished work"):
        drain(bake(job))
    assert (partial / "thesis.txt").read_text() == "precious"


def test_a_failing_render_leaves_nothing_behind(
    job: BakeJob, partial: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def fail(*_: object) -> None:
        raise RenderError("Blender cannot render.")

    monkeypatch.setattr(task, "render_view", fail)
    before = open_file_state()
    with pytest.raises(RenderError):
        drain(bake(job))
    assert open_file_state() == before
    assert not partial.exists()
    assert not Path(job.output).exists()


def test_the_artists_own_world_and_material_can_be_captured(
    job: BakeJob, environment: Environment, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(environments, "WORLD_HEIGHT", 16)
    light_with(bpy.context.scene, environment)
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "scene.blend"))
    before = open_file_state()
    drain(bake(replace(changed(job, material=":Material"), light=Light())))
    assert open_file_state() == before
    header = read_map_set(job.output).header
    assert header["environment"]["name"] == bpy.context.scene.world.name
    assert header["environment"]["size"] == [32, 16]
    assert header["material"]["name"] == "Material"
    assert header["material"]["spec"] == f"{tmp_path / 'scene.blend'}:Material"


def test_a_material_that_changes_meanwhile_is_refused(job: BakeJob) -> None:
    work = steps(changed(job, material=":Material"), 2)
    bsdf = bpy.data.materials["Material"].node_tree.nodes["Principled BSDF"]
    bsdf.inputs["Roughness"].default_value = 0.123
    with pytest.raises(SceneError, match="Material :Material was changed while it was captured"):
        drain(work)


def test_a_material_that_no_radiance_map_can_hold_is_captured_with_a_word(job: BakeJob) -> None:
    tree = bpy.data.materials["Material"].node_tree
    texture = tree.nodes.new("ShaderNodeTexNoise")
    tree.links.new(texture.outputs["Color"], tree.nodes["Principled BSDF"].inputs["Base Color"])
    with pytest.warns(RsibrWarning, match="No radiance map can hold :Material, .*default coordinates"):
        drain(bake(changed(job, material=":Material")))
    assert Path(job.output).exists()


def test_what_cannot_be_captured_is_said_before_anything_is_written(job: BakeJob, tmp_path: Path) -> None:
    nowhere, misspelt = Light(environment=str(tmp_path / "no.exr")), Light(environment="forrest")
    for wrong, error, words in [
        (replace(job, light=nowhere), InputFileError, "no.exr does not exist: check the name"),
        (replace(job, light=misspelt), InputFileError, "one of city, .*forest"),
        (changed(job, material="coper"), InputFileError, "There is no material coper"),
        (changed(job, seed=2**31 - 5), RangeError, "seed 2147483648 is out of range"),
        (replace(job, output=str(tmp_path / "no" / "x.exr")), OutputFileError, "make that folder first"),
        (replace(job, output=str(tmp_path)), OutputFileError, "does not end in"),
    ]:
        with pytest.raises(error, match=words):
            drain(bake(wrong))
    bpy.context.scene.world = None
    with pytest.raises(SceneError, match="has no world"):
        drain(bake(replace(job, light=Light())))
    assert [path.name for path in tmp_path.iterdir()] == ["light.exr"]


def test_blenders_environments_go_by_name(job: BakeJob) -> None:
    steps(replace(job, light=Light(environment="forest")), 1).close()
