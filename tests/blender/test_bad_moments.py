"""What an artist is told when something is missing, full, read-only or too new; nothing is lost then."""

import json
import os
from collections.abc import Callable
from contextlib import AbstractContextManager
from pathlib import Path

import bpy
import pytest
from rsibr.rsibr_addon.command_line.main import run
from rsibr.rsibr_addon.core.errors import OutputFileError, RangeError, RsibrError, SceneError
from rsibr.rsibr_addon.files.kinds.registry import look_types
from rsibr.rsibr_addon.host.option_properties import options_of
from rsibr.rsibr_addon.host.preferences import baked_folder, make_writable
from rsibr.rsibr_addon.tasks.queue.bake_request import request_for
from rsibr.tests.bake_jobs import run_job
from rsibr.tests.open_file import linked_cube

pytestmark = pytest.mark.usefixtures("registered")


CHOSEN = "bpy.context.scene.rsibr_bake"
RENDERED = f"{CHOSEN}.kind = 'radiance_views'"
NEWER = "bl_system_properties_get(do_create=True)"


@pytest.mark.parametrize(
    ("spoil", "sentence"),
    [
        (f"{CHOSEN}.{NEWER}['kind'] = 77", "Method was chosen in another version, and is unknown here"),
        (f"{CHOSEN}.{NEWER}['light'] = 77", "Light was chosen in another version, and is unknown here"),
        (f"{RENDERED}; {CHOSEN}.radiance_views.{NEWER}['views'] = 77", "Views was chosen in another version"),
    ],
)
def test_choices_of_a_newer_version_are_named(spoil: str, sentence: str) -> None:
    exec(spoil, {"bpy": bpy})
    assert not bpy.ops.rsibr.bake.poll()
    with pytest.raises(SceneError, match=sentence):
        request_for(bpy.context.scene.rsibr_bake, bpy.context.scene, bpy.context.object)


@pytest.mark.parametrize(
    ("kind", "name", "sentence"),
    [
        ("radiance_views", "mode", "Mode cannot be '': choose one of fragment, texel, paper"),
        ("radiance_views", "warping", "Warp cannot be '': choose one of auto"),
        ("mip_chain", "borders", "Borders cannot be '': choose one of"),
    ],
)
def test_looks_of_a_newer_version_are_told_of_where_the_preview_would_be(
    kind: str, name: str, sentence: str
) -> None:
    looks = bpy.context.object.rsibr
    group = getattr(looks, kind)
    group.bl_system_properties_get(do_create=True)[name] = 77
    with pytest.raises(RangeError, match=sentence):
        options_of(look_types()[kind], group)


def test_neither_camera_nor_lamp_is_needed(tmp_path: Path) -> None:
    for name in ("Camera", "Light"):
        bpy.data.objects.remove(bpy.data.objects[name])
    chosen = bpy.context.scene.rsibr_bake
    chosen.kind, chosen.light, chosen.studio = "mip_chain", "STUDIO", "forest"
    chosen.mip_chain.size, chosen.mip_chain.filter = "64", "box"
    job = request_for(bpy.context.scene.rsibr_bake, bpy.context.scene, bpy.context.object).job(
        tmp_path / "light.rsibr.exr"
    )
    assert run_job(job, tmp_path) == 0


def test_a_mesh_without_faces_is_no_error_of_a_preview() -> None:
    from rsibr.rsibr_addon.host.meshes import mesh_from_object

    bpy.context.object.data.clear_geometry()
    depsgraph = bpy.context.evaluated_depsgraph_get()
    mesh = mesh_from_object(bpy.context.object.evaluated_get(depsgraph), depsgraph)
    assert mesh.triangles.size == 0


def test_a_read_only_folder_is_told_of_before_anything_is_baked(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "artist.blend"))
    monkeypatch.setattr(os, "access", lambda path, mode: False)  # to root, every folder is writable
    with pytest.raises(OutputFileError, match=r"rsibr cannot be written to: choose another folder"):
        make_writable(baked_folder())
    with pytest.raises(RuntimeError, match=r"rsibr cannot be written to"):
        bpy.ops.rsibr.bake()


def test_a_full_disk_leaves_the_old_file_and_a_sentence(
    tmp_path: Path,
    files_end_at: Callable[[int], AbstractContextManager[None]],
    capfd: pytest.CaptureFixture[str],
) -> None:
    path = tmp_path / "light.rsibr.exr"
    path.write_bytes(b"what was there")
    command = ["mips", "--environment", "forest", "--size", "64", "--output", str(path), "--force", "--json"]
    with files_end_at(20_000):
        assert run([*command, "--progress", "none"]) == 1
    (line,) = (line for line in capfd.readouterr().out.splitlines() if line.startswith("{"))
    told = json.loads(line)
    assert not told["ok"]
    assert "light.rsibr.exr was not written" in told["error"]
    assert [each.name for each in tmp_path.iterdir()] == [path.name]
    assert path.read_bytes() == b"what was there"


def test_a_missing_library_is_named(tmp_path: Path) -> None:
    library = tmp_path / "library.blend"
    cube = linked_cube(library)
    bpy.context.scene.collection.objects.link(cube)
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "scene.blend"))
    library.unlink()
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "scene.blend"))
    with pytest.raises(RsibrError, match=r"Object Cube is missing in .*library\.blend: bring that file back"):
        request_for(bpy.context.scene.rsibr_bake, bpy.context.scene, bpy.data.objects["Cube"])
