"""What shades an object outlasts saving, moving, copying, appending and linking, as a file or packed."""

from collections.abc import Callable
from contextlib import AbstractContextManager
from pathlib import Path

import bpy
import pytest
import rsibr
from rsibr.rsibr_addon import properties
from rsibr.rsibr_addon.core.errors import OutputFileError
from rsibr.rsibr_addon.host.bake_settings import chosen_environment
from rsibr.rsibr_addon.host.map_sets import is_packed, unpacked
from rsibr.rsibr_addon.host.plain_settings import plain_settings
from rsibr.rsibr_addon.host.visible_surfaces import map_set_of
from rsibr.rsibr_addon.tasks.queue.bake_request import output_for, request_for
from rsibr.rsibr_addon.tasks.report.facts import map_set_content
from rsibr.rsibr_addon.ui import bake_properties
from rsibr.tests.bake_jobs import run_job
from rsibr.tests.flat_capture import write_flat_capture

pytestmark = pytest.mark.usefixtures("registered")


@pytest.fixture
def baked(tmp_path: Path) -> Path:
    """A map set beside the open file, which has its cube shaded from it."""
    folder = tmp_path / "art" / "rsibr"
    folder.mkdir(parents=True)
    path = write_flat_capture(folder / "flat.rsibr.exr", (0.5, 0.0, 0.5))
    save(tmp_path / "art" / "car.blend")
    assert bpy.ops.rsibr.assign(filepath=str(path)) == {"FINISHED"}
    save(tmp_path / "art" / "car.blend")
    return path


def save(path: Path) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    bpy.ops.wm.save_as_mainfile(filepath=str(path))


def cube() -> bpy.types.Object:
    return bpy.data.objects["Cube"]


def shown() -> Path:
    """The file that the cube is shaded from."""
    return Path(map_set_of(cube()))


def taken_from(blend: Path, link: bool) -> bpy.types.Object:
    with bpy.data.libraries.load(str(blend), link=link, relative=True) as (_, wanted):
        wanted.objects = ["Cube"]
    (item,) = wanted.objects
    bpy.context.scene.collection.objects.link(item)
    return item


def test_a_file_that_is_saved_elsewhere_still_finds_its_map_sets(baked: Path, tmp_path: Path) -> None:
    assert cube().rsibr.map_set == "//rsibr/flat.rsibr.exr"
    save(tmp_path / "elsewhere" / "car.blend")
    assert shown().samefile(baked)
    bpy.ops.wm.open_mainfile(filepath=bpy.data.filepath)
    assert shown().samefile(baked)
    assert cube().rsibr.map_set == "//../art/rsibr/flat.rsibr.exr"


@pytest.mark.parametrize("link", [False, True], ids=["appended", "linked"])
def test_an_object_taken_into_another_file_is_shaded_as_before(
    baked: Path, tmp_path: Path, link: bool
) -> None:
    library = bpy.data.filepath
    bpy.ops.wm.read_homefile(use_empty=True)
    save(tmp_path / "elsewhere" / "scene.blend")
    item = taken_from(Path(library), link)
    assert Path(map_set_of(item)).samefile(baked)
    save(tmp_path / "far" / "scene.blend")
    bpy.ops.wm.open_mainfile(filepath=bpy.data.filepath)
    assert shown().samefile(baked)


@pytest.mark.parametrize("touched", [True, False])
def test_an_override_keeps_what_was_set_there(tmp_path: Path, touched: bool) -> None:
    library = tmp_path / "art" / "car.blend"
    if touched:
        cube().rsibr.show = False
    save(library)
    other = write_flat_capture(tmp_path / "other.rsibr.exr", (0.0, 0.5, 0.0))
    bpy.ops.wm.read_homefile(use_empty=True)
    save(tmp_path / "elsewhere" / "scene.blend")
    item = taken_from(library, link=True)
    override = item.override_create()
    bpy.context.scene.collection.objects.unlink(item)
    bpy.context.scene.collection.objects.link(override)
    override.rsibr.map_set, override.rsibr.show = "//../other.rsibr.exr", True
    override.rsibr.mip_chain.k_d = (0.25, 0.5, 1.0)

    def check() -> None:
        (kept,) = bpy.context.scene.objects
        assert kept.override_library
        assert Path(map_set_of(kept)).samefile(other)
        assert tuple(kept.rsibr.mip_chain.k_d) == (0.25, 0.5, 1.0)

    bpy.data.libraries[0].reload()
    check()
    for _ in range(2):
        save(Path(bpy.data.filepath))
        bpy.ops.wm.open_mainfile(filepath=bpy.data.filepath)
        check()
        bpy.data.libraries[0].reload()
        check()


def test_every_setting_is_kept_by_overrides() -> None:
    for group in (*properties.CLASSES, *bake_properties.CLASSES):
        for prop in group.bl_rna.properties:
            derived = prop.is_skip_save or prop.identifier in ("map_set", "picture")
            if prop.identifier not in bpy.types.PropertyGroup.bl_rna.properties and not derived:
                assert prop.is_overridable, f"{group.__name__}.{prop.identifier}"


def test_the_picture_of_the_light_is_found_from_elsewhere_too(tmp_path: Path) -> None:
    picture = write_flat_capture(tmp_path / "light.exr", (1.0, 1.0, 1.0))
    save(tmp_path / "art" / "car.blend")
    chosen = bpy.context.scene.rsibr_bake
    chosen.light, chosen.picture = "PICTURE", "//../light.exr"
    assert plain_settings(chosen)["picture"] == "//../light.exr"
    save(tmp_path / "elsewhere" / "deeper" / "car.blend")
    bpy.ops.wm.open_mainfile(filepath=bpy.data.filepath)
    assert Path(chosen_environment(bpy.context.scene.rsibr_bake, bpy.context.scene)).samefile(picture)
    bpy.ops.file.pack_all()
    content = picture.read_bytes()
    picture.unlink()
    assert Path(chosen_environment(bpy.context.scene.rsibr_bake, bpy.context.scene)).read_bytes() == content


def test_copies_share_one_file(baked: Path) -> None:
    copy = cube().copy()
    assert copy.rsibr.image == cube().rsibr.image
    copy.rsibr.map_set = str(baked)
    assert copy.rsibr.image == cube().rsibr.image
    copy.rsibr.map_set = ""
    assert cube().rsibr.map_set == "//rsibr/flat.rsibr.exr"
    assert copy.rsibr.image is None


def test_packed_bytes_go_where_the_object_goes(baked: Path, tmp_path: Path) -> None:
    content = baked.read_bytes()
    assert bpy.ops.rsibr.pack() == {"FINISHED"}
    library = Path(bpy.data.filepath)
    save(library)
    baked.unlink()
    assert unpacked.write(cube().rsibr.image).read_bytes() == content
    for link in (False, True):
        bpy.ops.wm.read_homefile(use_empty=True)
        save(tmp_path / "elsewhere" / "scene.blend")
        taken_from(library, link)
        save(Path(bpy.data.filepath))
        bpy.ops.wm.open_mainfile(filepath=bpy.data.filepath)
        assert cube().rsibr.image.packed_file.data == content
    assert not bpy.ops.rsibr.unpack.poll()  # it is the library's


def test_unpacking_writes_the_very_file(baked: Path, tmp_path: Path) -> None:
    content = baked.read_bytes()
    bpy.ops.rsibr.pack()
    save(tmp_path / "moved" / "car.blend")
    baked.unlink()
    assert bpy.ops.rsibr.unpack() == {"FINISHED"}
    assert cube().rsibr.map_set == "//rsibr/flat.rsibr.exr"
    assert shown() == tmp_path / "moved" / "rsibr" / "flat.rsibr.exr"
    assert shown().read_bytes() == content
    assert not bpy.ops.rsibr.unpack.poll()


def test_blender_s_own_commands_pack_unpack_and_find(baked: Path, tmp_path: Path) -> None:
    content = baked.read_bytes()
    bpy.ops.file.pack_all()
    assert is_packed(cube().rsibr)
    assert unpacked.write(cube().rsibr.image).read_bytes() == content
    bpy.ops.file.unpack_all(method="USE_ORIGINAL")
    assert shown() == baked
    moved = tmp_path / "moved" / baked.name
    moved.parent.mkdir()
    baked.rename(moved)
    bpy.ops.file.find_missing_files(directory=str(tmp_path))
    assert shown().samefile(moved)


def test_other_bytes_of_an_image_are_noticed(baked: Path) -> None:
    bpy.ops.rsibr.pack()
    before = shown()
    cube().rsibr.image.unpack(method="REMOVE")
    assert shown() == baked
    write_flat_capture(baked, (0.0, 0.5, 0.0))
    cube().rsibr.image.pack()
    assert shown() != before
    assert unpacked.write(cube().rsibr.image).read_bytes() == baked.read_bytes()


def test_unpacking_replaces_no_other_file(baked: Path) -> None:
    content = baked.read_bytes()
    bpy.ops.rsibr.pack()
    baked.write_bytes(b"another")
    bpy.ops.rsibr.unpack()
    assert baked.read_bytes() == b"another"
    assert shown().parent == baked.parent
    assert shown().name.endswith("-flat.rsibr.exr")
    assert shown().read_bytes() == content


def test_what_is_baked_anew_is_shown_although_the_old_is_packed(baked: Path) -> None:
    bpy.ops.rsibr.pack()
    write_flat_capture(baked, (0.0, 0.5, 0.0))
    bpy.ops.rsibr.assign(filepath=str(baked))
    assert shown() == baked


def baked_with(size: str) -> Path:
    """Bake a mip chain for the cube with the scene's settings, as the background would."""
    chosen = bpy.context.scene.rsibr_bake
    chosen.kind, chosen.light, chosen.studio = "mip_chain", "STUDIO", "forest"
    chosen.mip_chain.size, chosen.mip_chain.filter = size, "box"
    order = request_for(bpy.context.scene.rsibr_bake, bpy.context.scene, cube())
    path = output_for(order, bpy.context.scene, cube())
    path.parent.mkdir(exist_ok=True)
    assert run_job(order.job(path), path.parent) == 0
    return path


def test_an_object_remembers_how_its_map_set_was_baked(tmp_path: Path) -> None:
    save(tmp_path / "art" / "car.blend")
    path, chosen = baked_with("64"), bpy.context.scene.rsibr_bake
    assert bpy.ops.rsibr.bake() == {"FINISHED"}
    chosen.mip_chain.size, chosen.light = "128", "WORLD"
    copy = cube().copy()
    bpy.context.scene.collection.objects.link(copy)
    bpy.context.view_layer.objects.active = copy
    copy.rsibr.map_set = ""
    assert not bpy.ops.rsibr.bake_again.poll()
    bpy.context.view_layer.objects.active = cube()
    path.rename(path.with_name("aside"))
    with pytest.raises(RuntimeError, match="There is no Blender to bake in"):
        bpy.ops.rsibr.bake_again()
    assert (chosen.mip_chain.size, chosen.light, chosen.studio) == ("64", "STUDIO", "forest")
    path.with_name("aside").rename(path)
    assert bpy.ops.rsibr.bake_again() == {"FINISHED"}
    assert shown() == path


def test_a_map_set_that_has_changed_is_accepted_or_baked_again(tmp_path: Path) -> None:
    save(tmp_path / "art" / "car.blend")
    path = baked_with("64")
    assert bpy.ops.rsibr.bake() == {"FINISHED"}
    settings = cube().rsibr
    assert settings.content == map_set_content(path)
    write_flat_capture(path, (0.0, 0.5, 0.0))
    assert settings.content != map_set_content(path)
    with pytest.raises(RuntimeError, match="There is no Blender to bake in"):
        bpy.ops.rsibr.bake_again()
    assert bpy.ops.rsibr.accept() == {"FINISHED"}
    assert settings.content == map_set_content(path)
    assert not bpy.ops.rsibr.bake_again.poll()  # what it is now, was not baked here


@pytest.mark.parametrize("content", [None, b"", b"no picture"])
def test_only_map_sets_are_packed(baked: Path, content: bytes | None) -> None:
    baked.unlink()
    if content is not None:
        baked.write_bytes(content)
    with pytest.raises(RuntimeError, match=r"flat\.rsibr\.exr"):
        bpy.ops.rsibr.pack()
    assert cube().rsibr.image.packed_file is None
    assert cube().rsibr.map_set == "//rsibr/flat.rsibr.exr"


def test_a_full_disk_loses_no_packed_bytes(
    baked: Path, files_end_at: Callable[[int], AbstractContextManager[None]]
) -> None:
    content = baked.read_bytes()
    bpy.ops.rsibr.pack()
    baked.unlink()
    with files_end_at(1000), pytest.raises(RuntimeError, match="was not written"):
        bpy.ops.rsibr.unpack()
    with files_end_at(1000), pytest.raises(OutputFileError, match="was not written"):
        unpacked.write(cube().rsibr.image)
    assert list(baked.parent.iterdir()) == []
    assert cube().rsibr.image.packed_file.data == content


def test_nothing_that_was_written_out_stays(baked: Path) -> None:
    bpy.ops.rsibr.pack()
    path = unpacked.write(cube().rsibr.image)
    assert path.is_file()
    rsibr.unregister()
    assert not path.parent.exists()
    rsibr.register()
    assert unpacked.write(cube().rsibr.image) == path
