"""What the panel's settings ask for: a job that the command line takes, a name that tells bakes apart."""

from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from unittest.mock import MagicMock

import bpy
import numpy as np
import pytest
from rsibr.operators.background import _replaces
from rsibr.rsibr_addon.core.errors import InputFileError, OutputFileError, RsibrError, SceneError
from rsibr.rsibr_addon.files.exr import write_parts
from rsibr.rsibr_addon.files.exr_part import Part
from rsibr.rsibr_addon.files.map_set import is_whole_map_set, read_map_set, write_map_set
from rsibr.rsibr_addon.files.staging import is_staging_folder
from rsibr.rsibr_addon.host.plain_settings import apply_settings, plain_settings
from rsibr.rsibr_addon.job import read_job
from rsibr.rsibr_addon.tasks.light.light_pictures import NO_RADIANCE, light_remarks
from rsibr.rsibr_addon.tasks.queue.background import State
from rsibr.rsibr_addon.tasks.queue.bake_request import (
    ObjectBake,
    bake_of,
    plain_name,
    request_for,
)
from rsibr.rsibr_addon.tasks.queue.input_bakes import InputBake
from rsibr.rsibr_addon.ui.light import draw_light
from rsibr.tests.bake_jobs import run_job
from rsibr.tests.blender.bake_orders import order, output
from rsibr.tests.open_file import linked_cube, open_file_state

pytestmark = pytest.mark.usefixtures("panel")


RENDERED = "chosen.kind = 'radiance_views'"


def test_the_panel_names_a_map_set_without_its_hash() -> None:
    bpy.context.scene.rsibr_bake.kind = "mip_chain"
    assert plain_name(output()) == "mip-chain-in-the-world"
    assert plain_name(Path("/art/paint.rsibr.exr")) == "paint.rsibr.exr"


def ended(suffix: str, cls: type[ObjectBake] = ObjectBake, **given: object) -> ObjectBake:
    return cls("", Path("a").with_suffix(suffix), (), state=State.DONE, **given)  # type: ignore[arg-type]


def test_a_preview_clears_the_list_and_all_else_its_own_sort() -> None:
    shows = {"settings": {"kind": "mip_chain"}}
    preview, comparison = ended(".exr", **shows), ended(".html")
    by_itself, inputs = ended(".exr", by_itself=True, **shows), ended(".exr", InputBake)
    told = [preview, by_itself, comparison, inputs]
    assert all(_replaces(preview, each) for each in told)
    for bake in told[1:]:
        assert [each for each in told if _replaces(bake, each)] == [bake]


def test_what_a_map_set_will_lack_is_told_before_it_is_baked() -> None:
    bpy.context.scene.rsibr_bake.kind = "radiance_views"
    assert order().remarks == ()
    tree = bpy.context.object.active_material.node_tree
    checker = tree.nodes.new("ShaderNodeTexChecker")
    coordinates = tree.nodes.new("ShaderNodeTexCoord")
    tree.links.new(coordinates.outputs["UV"], checker.inputs["Vector"])
    tree.links.new(checker.outputs["Color"], tree.nodes["Principled BSDF"].inputs["Base Color"])
    (remark,) = order().remarks
    assert remark.startswith("Material is baked as it looks on one shape: ")
    assert "Texture Coordinate" in remark


@pytest.mark.parametrize(
    ("spoil", "sentence"),
    [
        ("bpy.context.view_layer.objects.active = None", "There is no object to bake for: select one."),
        ("bpy.context.view_layer.objects.active = bpy.data.objects['Light']", "Object Light has no surface"),
        (
            f"{RENDERED}; bpy.context.object.active_material = None",
            "Object Cube has no material: give it one",
        ),
        (
            f"{RENDERED}; bpy.context.object.active_material.node_tree.nodes.clear()",
            "Material Material has no surface",
        ),
        ("bpy.context.scene.world = None", "Scene Scene has no world: add one"),
        ("chosen.light = 'PICTURE'", "No environment is chosen: give a latitude-longitude picture."),
        ("chosen.light, chosen.picture = 'PICTURE', '/no.exr'", "There is no file /no.exr: choose another."),
        ("chosen.kind, chosen.lobe_stack.source = 'lobe_stack', 'FILE'", "No measured material is chosen"),
        ("chosen.kind, chosen.lobe_stack.brdf = 'lobe_stack', 'gold'", 'There is no BRDF model "gold"'),
    ],
)
def test_what_is_missing_is_told_before_the_button_is_pressed(spoil: str, sentence: str) -> None:
    assert bpy.ops.rsibr.bake.poll()
    exec(spoil, {"bpy": bpy, "chosen": bpy.context.scene.rsibr_bake})
    assert not bpy.ops.rsibr.bake.poll()
    with pytest.raises(RsibrError, match=sentence):
        order()


def test_a_picture_is_no_measured_material(tmp_path: Path) -> None:
    chosen = bpy.context.scene.rsibr_bake
    path = tmp_path / "wood.png"
    path.touch()
    chosen.kind, chosen.lobe_stack.source, chosen.lobe_stack.path = "lobe_stack", "FILE", str(path)
    with pytest.raises(InputFileError, match=r"wood\.png is no measured material: give a MERL \.binary"):
        order()


def test_equal_bakes_have_one_file_and_others_another(tmp_path: Path) -> None:
    chosen = bpy.context.scene.rsibr_bake
    cube = bpy.data.objects["Cube"]
    chosen.kind = "radiance_views"
    first = output()
    assert output() == first
    assert first.name.startswith("material-in-the-world-")
    names = {first}

    def differs() -> None:
        names.add(output())

    chosen.radiance_views.samples = 7
    differs()
    bpy.context.scene.world.node_tree.nodes["Background"].inputs["Strength"].default_value = 2.0
    differs()
    cube.active_material.node_tree.nodes["Principled BSDF"].inputs["Roughness"].default_value = 0.1
    differs()
    picture = tmp_path / "light.exr"
    chosen.light, chosen.picture = "PICTURE", str(picture)
    for content in (b"a", b"b"):
        picture.write_bytes(content)
        differs()
    chosen.kind = "mip_chain"
    differs()
    chosen.clamp = 2.5
    differs()
    chosen.clamp = 3.0
    differs()
    assert order().job(Path("out.rsibr.exr")).light.clamp == 3.0
    chosen.layer = "V.Sky"
    differs()
    chosen.kind, chosen.lobe_stack.source, chosen.lobe_stack.fit = "lobe_stack", "FIT", str(tmp_path / "fit")
    for content in (b"a", b"b"):
        (tmp_path / "fit").write_bytes(content)
        differs()
    assert len(names) == 12
    chosen.kind = "mip_chain"
    cube.active_material.name = cube.name = "Renamed"
    before = output()
    cube.location.x += 3.0
    assert output() == before


def panel_labels() -> str:
    """What the panel tells of the light, in a region that is wide enough for a line of it."""
    layout = MagicMock()
    context = SimpleNamespace(scene=bpy.context.scene, object=None, region=SimpleNamespace(width=5000))
    draw_light(layout, context)
    return " ".join(call.kwargs["text"] for call in layout.column.return_value.label.call_args_list)


def test_a_layer_is_named_with_its_file_or_apart(tmp_path: Path) -> None:
    plane = np.ones((4, 8), np.float32)
    layers = {f"{layer}.{channel}": plane for layer in ("Sky", "Room") for channel in "RGB"}
    path = tmp_path / "light.exr"
    write_parts(path, [Part("", layers | {"Fog.Y": plane, "Fog.RY": plane})])
    chosen = bpy.context.scene.rsibr_bake
    chosen.light, chosen.picture = "PICTURE", str(path)

    def told() -> tuple[str, ...]:
        return light_remarks(Path(order().light.environment or ""))

    assert "holds several layers (Room, Sky): name one" in told()[0]
    chosen.picture = f"{path}:Sky"
    assert (chosen.layer, Path(chosen.image.filepath)) == ("Sky", path)
    assert order().light.environment == chosen.picture == f"{path}:Sky"
    assert order().title.endswith(" in light")
    assert told() == ()
    apply_settings(chosen, plain_settings(chosen))
    assert chosen.picture == f"{path}:Sky"
    chosen.layer = "Fog"
    assert told()[0] == "light.exr:Fog is grey: its light has no colour."
    assert told()[1].startswith("light.exr:Fog has Fog.RY beside Fog.Y")
    chosen.layer = "Depth"
    assert "holds no layer Depth: choose Fog, Room, Sky" in told()[0]
    assert panel_labels() == told()[0]
    chosen.picture = str(path)
    assert chosen.layer == ""


def test_a_picture_that_is_no_radiance_is_told_of(tmp_path: Path) -> None:
    write_parts(tmp_path / "data.exr", [Part("", {"Depth.Z": np.ones((4, 8), np.float32)})])
    (tmp_path / "photo.png").write_bytes(b"\x89PNG")
    assert "data.exr holds no colour (channels: Depth.Z)" in light_remarks(tmp_path / "data.exr")[0]
    assert light_remarks(tmp_path / "photo.png") == (NO_RADIANCE,)


def test_a_bake_gets_a_copy_of_the_file_as_it_is(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("rsibr.rsibr_addon.tasks.queue.bake_request.blender_program", lambda: "blender")
    bpy.context.scene.rsibr_bake.radiance_views.samples = 5
    before = open_file_state()
    bake = bake_of(order(), bpy.context.scene, [bpy.context.object], tmp_path / "out.rsibr.exr")
    assert open_file_state() == before
    assert bake.variables["RSIBR_ORIGINAL"] == ""
    assert is_staging_folder(Path(bake.variables["TMPDIR"]))
    blend, job = Path(bake.command[3]), Path(bake.command[11])
    assert read_job(job.read_text(), "job") == order().job(tmp_path / "out.rsibr.exr")
    with bpy.data.libraries.load(str(blend)) as (found, _):
        assert "Material" in found.materials
    bake.tidy()
    assert not blend.parent.exists()


def test_a_bake_leaves_particles_and_relative_paths_as_they_are(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("rsibr.rsibr_addon.tasks.queue.bake_request.blender_program", lambda: "blender")
    cube, scene = bpy.context.object, bpy.context.scene
    cube.modifiers.new("Dust", "PARTICLE_SYSTEM")
    image = bpy.data.images.new("Rust", 4, 4)
    cube.active_material.node_tree.nodes.new("ShaderNodeTexImage").image = image
    image.filepath_raw = str(tmp_path / "rust.png")
    image.save()
    image.source, image.filepath = "FILE", "//rust.png"
    bpy.data.scenes.new("Another")  # before the cube's, by the alphabet
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "dust.blend"))
    for frame in range(1, 15):
        scene.frame_set(frame)
    before, dust = open_file_state(), _particles(cube)
    bake = bake_of(order(), scene, [cube], tmp_path / "out.rsibr.exr")
    assert np.array_equal(_particles(cube), dust)
    assert np.ptp(dust) > 0.0
    assert open_file_state() == before

    bpy.ops.wm.open_mainfile(filepath=bake.command[3])
    assert bake.command[4:6] == ["--scene", bpy.context.scene.name] == ["--scene", "Scene"]
    assert bpy.context.scene.world.name == "World"
    (image,) = (each for each in bpy.data.images if each.name == "Rust")
    assert Path(image.filepath) == tmp_path / "rust.png"
    bake.tidy()


def _particles(item: bpy.types.Object) -> np.ndarray:
    (system,) = item.evaluated_get(bpy.context.evaluated_depsgraph_get()).particle_systems
    return np.array([(*each.location, each.alive_state == "ALIVE") for each in system.particles])


def test_without_a_blender_there_is_a_sentence(tmp_path: Path) -> None:
    with pytest.raises(
        SceneError, match="There is no Blender to bake in: bake with the command rsibr instead"
    ):
        bake_of(order(), bpy.context.scene, [bpy.context.object], tmp_path / "out.rsibr.exr")
    with pytest.raises(RuntimeError, match="There is no Blender to bake in"):
        bpy.ops.rsibr.bake()


def test_what_was_baked_before_is_taken_at_once(tmp_path: Path) -> None:
    chosen = bpy.context.scene.rsibr_bake
    chosen.kind, chosen.mip_chain.size, chosen.mip_chain.filter = "mip_chain", "64", "box"
    cube = bpy.context.object
    path = output()
    assert run_job(order().job(path), tmp_path) == 0
    assert bpy.ops.rsibr.bake() == {"FINISHED"}
    assert Path(cube.rsibr.map_set) == path
    cube.rsibr.map_set = ""
    whole = path.read_bytes()
    path.write_bytes(whole[:-9] + bytes(9))
    assert not is_whole_map_set(path)
    with pytest.raises(RuntimeError, match="There is no Blender to bake in"):
        bpy.ops.rsibr.bake()
    assert cube.rsibr.map_set == ""


@pytest.mark.parametrize(
    ("kind", "least", "role"),
    [
        ("kernel_pyramid", {"size": "256"}, "ring"),
        ("mip_chain", {"size": "64", "filter": "box"}, "harmonics"),
    ],
)
def test_what_cannot_be_shown_is_baked_again(tmp_path: Path, kind: str, least: dict, role: str) -> None:
    chosen = bpy.context.scene.rsibr_bake
    chosen.kind = kind
    for name, value in least.items():
        setattr(getattr(chosen, kind), name, value)
    path = output()
    assert run_job(order().job(path), tmp_path) == 0
    assert is_whole_map_set(path)
    written = path.read_bytes()
    # As a version wrote it that had no such maps, under the same name
    held = read_map_set(path)
    held.header["parts"] = [part for part in held.header["parts"] if part["role"] != role]
    maps = {part["name"]: held.maps[part["name"]] for part in held.header["parts"]}
    assert len(maps) < len(held.maps)
    write_map_set(path, replace(held, maps=maps), force=True)
    assert path == output()
    assert not is_whole_map_set(path)
    assert run_job(order().job(path), tmp_path) == 0
    assert path.read_bytes() == written


def test_only_map_sets_are_assigned(tmp_path: Path) -> None:
    path = tmp_path / "no.rsibr.exr"
    with pytest.raises(RuntimeError, match=r"no\.rsibr\.exr"):
        bpy.ops.rsibr.assign(filepath=str(path))
    assert bpy.context.object.rsibr.map_set == ""


def test_the_material_is_recorded_as_the_original_has_it(monkeypatch: pytest.MonkeyPatch) -> None:
    from rsibr.rsibr_addon.host.materials import ORIGINAL, lasting_spec

    monkeypatch.setenv(ORIGINAL, "/art/car.blend")
    assert lasting_spec(":Paint") == "/art/car.blend:Paint"
    monkeypatch.setenv(ORIGINAL, "")
    assert lasting_spec(":Paint") == ":Paint"


def test_folders_that_cannot_be_made_are_named(tmp_path: Path) -> None:
    from rsibr.rsibr_addon.host import preferences

    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "artist.blend"))
    folder = preferences.baked_folder()
    assert folder == tmp_path / "rsibr"
    folder.touch()
    with pytest.raises(OutputFileError, match=r"rsibr cannot be made \(File exists\): choose another folder"):
        preferences.make_writable(folder)


def test_the_original_counts_as_open(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    from rsibr.rsibr_addon.host.materials import ORIGINAL, load_material

    original, copy = tmp_path / "artist.blend", tmp_path / "copy.blend"
    bpy.ops.wm.save_as_mainfile(filepath=str(original))
    bpy.data.materials["Material"].name = "Changed"
    bpy.ops.wm.save_as_mainfile(filepath=str(copy))
    monkeypatch.setenv(ORIGINAL, str(original))
    assert load_material(f"{original}:Changed") == bpy.data.materials["Changed"]


def test_a_linked_object_is_not_baked_for(tmp_path: Path) -> None:
    cube = linked_cube(tmp_path / "library.blend")
    with pytest.raises(
        SceneError, match="Object Cube belongs to another file: make it local, or an override"
    ):
        request_for(bpy.context.scene.rsibr_bake, bpy.context.scene, cube)
