"""Files of bakes move beside a .blend when it is saved, and a look at them makes no folder."""

from collections.abc import Iterator
from pathlib import Path

import bpy
import pytest
import rsibr
from rsibr.rsibr_addon.core.errors import OutputFileError
from rsibr.rsibr_addon.host import baked_beside, preferences
from rsibr.rsibr_addon.host.bake_settings import assign
from rsibr.rsibr_addon.host.plain_settings import plain_settings
from rsibr.rsibr_addon.tasks.queue.bake_request import output_for, request_for


@pytest.fixture(autouse=True)
def _registered() -> Iterator[None]:
    rsibr.register()
    yield
    rsibr.unregister()


@pytest.fixture
def users(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The folder among the user's files."""
    folder = tmp_path / "user"
    folder.mkdir()
    for module in (preferences, baked_beside):
        monkeypatch.setattr(module, "user_folder", lambda: folder)
    return folder


@pytest.fixture
def baked(users: Path) -> Path:
    """What the cube is shaded from before the .blend is saved."""
    path = users / "light.rsibr.exr"
    path.write_bytes(b"maps")
    assign([bpy.context.object.session_uid], path, plain_settings(bpy.context.scene.rsibr_bake))
    return path


def test_the_first_save_brings_what_was_baked_before(baked: Path, tmp_path: Path) -> None:
    blend = tmp_path / "project" / "artist.blend"
    blend.parent.mkdir()
    bpy.ops.wm.save_as_mainfile(filepath=str(blend))
    assert (blend.parent / "rsibr" / baked.name).read_bytes() == b"maps"
    blend.parent.rename(tmp_path / "handed on")
    baked.unlink()
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "handed on" / "artist.blend"))
    assert bpy.context.object.rsibr.map_set == f"//rsibr/{baked.name}"
    assert Path(bpy.path.abspath(bpy.context.object.rsibr.map_set)).read_bytes() == b"maps"


def test_a_bake_that_ends_after_the_first_save_comes_with_the_next(users: Path, tmp_path: Path) -> None:
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "artist.blend"))
    path = users / "late.rsibr.exr"
    path.write_bytes(b"maps")
    assign([bpy.context.object.session_uid], path, plain_settings(bpy.context.scene.rsibr_bake))
    bpy.ops.wm.save_mainfile()
    assert bpy.context.object.rsibr.map_set == "//rsibr/late.rsibr.exr"


def test_what_cannot_be_copied_is_used_where_it_is(
    baked: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def refuse(folder: Path) -> None:
        raise OutputFileError(f"{folder} cannot be written to.")

    monkeypatch.setattr(baked_beside, "make_writable", refuse)
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "artist.blend"))
    assert Path(bpy.path.abspath(bpy.context.object.rsibr.map_set)) == baked


@pytest.mark.parametrize(("there", "used"), [(b"maps", "rsibr"), (b"others", "user")])
def test_a_file_of_that_name_is_used_if_it_is_the_same(
    baked: Path, tmp_path: Path, there: bytes, used: str
) -> None:
    (tmp_path / "rsibr").mkdir()
    (tmp_path / "rsibr" / baked.name).write_bytes(there)
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "artist.blend"))
    assert Path(bpy.path.abspath(bpy.context.object.rsibr.map_set)).parent.name == used
    assert (tmp_path / "rsibr" / baked.name).read_bytes() == there


def test_a_look_whether_something_was_baked_makes_no_folder(tmp_path: Path) -> None:
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "artist.blend"))
    chosen = bpy.context.scene.rsibr_bake
    chosen.light, chosen.studio = "STUDIO", "forest"
    request = request_for(chosen, bpy.context.scene, bpy.context.object)
    assert output_for(request, bpy.context.scene, bpy.context.object).parent == tmp_path / "rsibr"
    assert [each.name for each in tmp_path.iterdir()] == ["artist.blend"]


@pytest.mark.parametrize(
    ("kind", "title"),
    [("kernel_pyramid", "2 objects in forest"), ("mip_chain", "2 objects: mip chain in forest")],
)
def test_the_title_of_a_bake_says_what_and_in_which_light(kind: str, title: str) -> None:
    chosen = bpy.context.scene.rsibr_bake
    chosen.kind, chosen.light, chosen.studio = kind, "STUDIO", "forest"
    assert request_for(chosen, bpy.context.scene, bpy.context.object).title_for("2 objects") == title
