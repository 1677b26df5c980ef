"""Files of Blender that go to other machines hold all that they need."""

import json
from pathlib import Path

import bpy
import numpy as np
import pytest
from rsibr.rsibr_addon.command_line.main import run
from rsibr.rsibr_addon.files.radiance_pictures import write_radiance
from rsibr.rsibr_addon.host.blend_files import open_blend
from rsibr.rsibr_addon.host.materials import fingerprint, names_in
from rsibr.rsibr_addon.host.packing import write_packed
from rsibr.rsibr_addon.tasks.batch.description import read_batch


def with_image(name: str, image: bpy.types.Image) -> bpy.types.Material:
    """A material, within a group of nodes, of an image."""
    group = bpy.data.node_groups.new(f"{name} group", "ShaderNodeTree")
    group.nodes.new("ShaderNodeTexImage").image = image
    material = bpy.data.materials.new(name)
    material.use_fake_user = True
    material.node_tree.nodes.new("ShaderNodeGroup").node_tree = group
    return material


def image(path: Path, grey: float) -> bpy.types.Image:
    made = bpy.data.images.new(path.stem, 2, 2)
    made.pixels.foreach_set(np.full(16, grey, np.float32))
    made.filepath_raw, made.file_format = str(path), "PNG"
    made.save()
    bpy.data.images.remove(made)
    return bpy.data.images.load(str(path))


@pytest.fixture
def scene_file(tmp_path: Path) -> Path:
    """A file with an image beside it, and a linked material whose image is beside its library."""
    for folder in ("studio", "library"):
        (tmp_path / folder).mkdir()
    with_image("Gold", image(tmp_path / "library" / "gold.png", 0.7))
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "library" / "metals.blend"), relative_remap=True)
    bpy.ops.wm.read_factory_settings()
    wood = with_image("Wood", image(tmp_path / "studio" / "wood.png", 0.2))
    with bpy.data.libraries.load(str(tmp_path / "library" / "metals.blend"), link=True) as (_, wanted):
        wanted.materials = ["Gold"]
    for material in (wood, wanted.materials[0]):
        bpy.context.object.data.materials.append(material)
    path = tmp_path / "studio" / "scene.blend"
    bpy.ops.wm.save_as_mainfile(filepath=str(path), relative_remap=True)
    return path


def test_a_packed_file_has_the_same_materials_where_nothing_else_is(scene_file: Path, tmp_path: Path) -> None:
    wanted = {name: fingerprint(bpy.data.materials[name]) for name in ("Wood", "Gold")}
    (tmp_path / "sent").mkdir()
    write_packed(tmp_path / "sent" / "scene.blend")
    for folder in ("studio", "library"):
        (tmp_path / folder).rename(tmp_path / f"no-{folder}")
    open_blend(tmp_path / "sent" / "scene.blend")
    assert not bpy.data.libraries
    assert {name: fingerprint(bpy.data.materials[name]) for name in wanted} == wanted


def test_a_missing_image_is_told(scene_file: Path, tmp_path: Path) -> None:
    (tmp_path / "library" / "gold.png").unlink()
    open_blend(scene_file)
    with pytest.warns(match="Image gold.png cannot go with its material, as .*gold.png is missing"):
        write_packed(tmp_path / "sent.blend")


def test_patterns_of_names_stand_for_a_files_materials(
    scene_file: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    bpy.data.materials.new("Wood [old]").use_fake_user = True
    bpy.ops.wm.save_mainfile()
    assert {"Wood", "Wood [old]"} < set(names_in(scene_file))
    monkeypatch.chdir(tmp_path)
    write_radiance(Path("dawn.exr"), np.ones((8, 16, 3)))

    def found(*materials: str) -> list[str]:
        batch = {"environments": ["dawn.exr"], "materials": materials, "methods": ["radiance-views"]}
        Path("batch.json").write_text(json.dumps(batch))
        return [each.material for each in read_batch(Path("batch.json"))]

    assert found("studio/scene.blend:Wood*") == ["Wood", "Wood [old]"]
    assert found("studio/scene.blend:Wood [old]") == ["Wood [old]"]
    assert found("*/*.blend:G*") == ["Gold"]
    assert run(["batch", "batch.json", "--dry-run"]) == 0
    Path("batch.json").write_text(Path("batch.json").read_text().replace("G*", "X*"))
    assert run(["batch", "batch.json", "--dry-run"]) == 1


def test_a_bundle_takes_packed_files_along(
    scene_file: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    write_radiance(Path("dawn.exr"), np.ones((8, 16, 3)))
    batch = {
        "environments": ["dawn.exr"],
        "materials": ["studio/scene.blend:Gold"],
        "methods": ["radiance-views"],
    }
    Path("batch.json").write_text(json.dumps(batch))
    assert run(["submit", "batch.json", "--openjd", "bundle"]) == 0
    [bake] = read_batch(Path("bundle/inputs/batch.json"))
    file, _, name = bake.job.settings.material.rpartition(":")
    assert (Path(file).name, name) == ("scene.blend", "Gold")
    assert Path(file).is_relative_to(Path("bundle/inputs"))
    open_blend(Path(file))
    assert not bpy.data.libraries
    before = fingerprint(bpy.data.materials["Gold"])
    # Given again, the file is packed anew: its image has changed
    image(tmp_path / "library" / "gold.png", 0.3)
    assert run(["submit", "batch.json", "--openjd", "bundle"]) == 0
    open_blend(Path(file))
    assert fingerprint(bpy.data.materials["Gold"]) != before
