"""Which file of baked inputs an object needs, and how it gets that."""

from collections.abc import Callable, Iterator
from pathlib import Path

import bpy
import numpy as np
import pytest
import rsibr
from rsibr.rsibr_addon.core.at_once import AtOnce
from rsibr.rsibr_addon.core.errors import DeviceError, SceneError
from rsibr.rsibr_addon.device.textures import GpuTexture
from rsibr.rsibr_addon.files.baked_inputs import BakedInputs, write_baked_inputs
from rsibr.rsibr_addon.session.running import session
from rsibr.rsibr_addon.tasks.queue.input_bakes import InputBake, inputs_file
from rsibr.rsibr_addon.tasks.viewport.baked_inputs import InputBakes


@pytest.fixture
def cube(monkeypatch: pytest.MonkeyPatch, tmp_path: object) -> bpy.types.Object:
    """The factory file's, with noise for a colour and an image's ramp for a roughness."""
    bpy.ops.wm.read_homefile(use_factory_startup=True)
    monkeypatch.setattr("rsibr.rsibr_addon.tasks.queue.input_bakes.baked_folder", lambda: tmp_path)
    item = bpy.context.object
    tree = item.active_material.node_tree
    bsdf, noise = tree.nodes["Principled BSDF"], tree.nodes.new("ShaderNodeTexNoise")
    image, ramp = tree.nodes.new("ShaderNodeTexImage"), tree.nodes.new("ShaderNodeValToRGB")
    image.image = bpy.data.images.new("picture", 4, 4)
    image.image.pack()
    tree.links.new(noise.outputs["Color"], bsdf.inputs["Base Color"])
    tree.links.new(image.outputs["Color"], ramp.inputs[0])
    tree.links.new(ramp.outputs["Color"], bsdf.inputs["Roughness"])
    return item


def needed(item: bpy.types.Object) -> str:
    path = inputs_file(item, bpy.context.evaluated_depsgraph_get())
    assert path is not None
    return path.name


def node(item: bpy.types.Object, kind: str) -> bpy.types.Node:
    nodes = item.active_material.node_tree.nodes
    return next(each for each in nodes if each.bl_idname == f"ShaderNode{kind}")


def place_by(output: str, kind: str = "NewGeometry") -> Callable[[bpy.types.Object], None]:
    """Have the noise read something of the object."""

    def change(item: bpy.types.Object) -> None:
        tree = item.active_material.node_tree
        tree.links.new(tree.nodes.new(f"ShaderNode{kind}").outputs[output], node(item, "TexNoise").inputs[0])

    return change


def move(item: bpy.types.Object) -> None:
    item.location.x += 1.0


def rename(item: bpy.types.Object) -> None:
    item.name = "Other"


def change_noise(item: bpy.types.Object) -> None:
    node(item, "TexNoise").inputs["Scale"].default_value = 7.0


def change_ramp(item: bpy.types.Object) -> None:
    node(item, "ValToRGB").color_ramp.elements[0].position = 0.3


def mute(item: bpy.types.Object) -> None:
    node(item, "TexNoise").mute = True


def relink(item: bpy.types.Object) -> None:
    tree = item.active_material.node_tree
    tree.links.new(node(item, "TexNoise").outputs[0], node(item, "BsdfPrincipled").inputs["Base Color"])


def move_uv(item: bpy.types.Object) -> None:
    item.data.uv_layers[0].uv[0].vector.x += 0.01


def move_vertex(item: bpy.types.Object) -> None:
    item.data.vertices[0].co.x += 0.1


def modify(item: bpy.types.Object) -> None:
    item.modifiers.new("Subdivision", "SUBSURF")


def slide(item: bpy.types.Object) -> None:
    node(item, "BsdfPrincipled").inputs["Metallic"].default_value = 0.7


def link_image(item: bpy.types.Object) -> None:
    """What an image says is followed live."""
    tree = item.active_material.node_tree
    tree.links.new(node(item, "TexImage").outputs["Alpha"], node(item, "BsdfPrincipled").inputs["Alpha"])


def lay_out(item: bpy.types.Object) -> None:
    node(item, "TexNoise").location.x += 40.0


def mix_in_group(item: bpy.types.Object) -> None:
    """Mix the shader with another, in a group whose input says how much of which."""
    tree, group = item.active_material.node_tree, bpy.data.node_groups.new("mix", "ShaderNodeTree")
    for name, kind in (("Factor", "Float"), ("First", "Shader"), ("Second", "Shader")):
        group.interface.new_socket(name, in_out="INPUT", socket_type=f"NodeSocket{kind}")
    group.interface.new_socket("Mixed", in_out="OUTPUT", socket_type="NodeSocketShader")
    begin, mix, end = (
        group.nodes.new(kind) for kind in ("NodeGroupInput", "ShaderNodeMixShader", "NodeGroupOutput")
    )
    for number in range(3):
        group.links.new(begin.outputs[number], mix.inputs[number])
    group.links.new(mix.outputs[0], end.inputs[0])
    inserted, other = tree.nodes.new("ShaderNodeGroup"), tree.nodes.new("ShaderNodeBsdfPrincipled")
    inserted.node_tree = group
    inserted.inputs["Factor"].default_value = 0.25
    tree.links.new(node(item, "BsdfPrincipled").outputs[0], inserted.inputs["First"])
    tree.links.new(other.outputs[0], inserted.inputs["Second"])
    tree.links.new(inserted.outputs[0], node(item, "OutputMaterial").inputs["Surface"])


def change_mix(item: bpy.types.Object) -> None:
    node(item, "Group").inputs["Factor"].default_value = 0.75


def nothing(item: bpy.types.Object) -> None:
    """Leave it."""


def bevelled(item: bpy.types.Object) -> None:
    """Have Blender add UV maps up in no certain order."""
    bpy.ops.mesh.primitive_monkey_add()
    monkey = bpy.context.object.data
    bpy.data.objects.remove(bpy.context.object)
    monkey.materials.append(item.active_material)
    item.data = monkey
    for name, kind in (("Subdivision", "SUBSURF"), ("Bevel", "BEVEL"), ("Dust", "PARTICLE_SYSTEM")):
        item.modifiers.new(name, kind)


def warp(item: bpy.types.Object) -> None:
    item.modifiers.new("Warp", "UV_WARP").offset = (0.01, 0.0)


def turn(item: bpy.types.Object) -> None:
    """About the middle of each face."""
    item.modifiers.new("Warp", "UV_WARP").rotation = np.pi / 2.0


def laid_out_squarely(item: bpy.types.Object) -> None:
    """Each face on all of the picture."""
    item.data.uv_layers[0].uv.foreach_set("vector", [0.0, 0.0, 1.0, 0.0, 1.0, 1.0, 0.0, 1.0] * 6)


def edit(item: bpy.types.Object) -> None:
    bpy.context.view_layer.objects.active = item
    bpy.ops.object.mode_set(mode="EDIT")


def evaluate_anew(item: bpy.types.Object) -> None:
    item.update_tag()


@pytest.mark.parametrize(
    ("before", "change", "is_other"),
    [
        (nothing, nothing, False),
        (bevelled, evaluate_anew, False),
        (bevelled, edit, False),
        (bevelled, move_uv, True),
        (bevelled, warp, True),
        (laid_out_squarely, turn, True),
        (nothing, slide, False),
        (nothing, link_image, False),
        (nothing, lay_out, False),
        (nothing, move, False),
        (nothing, rename, False),
        (nothing, change_noise, True),
        (nothing, change_ramp, True),
        (nothing, mute, True),
        (nothing, relink, True),
        (mix_in_group, nothing, False),
        (mix_in_group, change_mix, True),
        (nothing, move_uv, True),
        (nothing, move_vertex, True),
        (nothing, modify, True),
        (place_by("Position"), move, True),
        (place_by("Parametric"), move, False),
        (place_by("Random", "ObjectInfo"), rename, True),
    ],
)
def test_a_file_is_another_for_what_shows(
    cube: bpy.types.Object,
    before: Callable[[bpy.types.Object], None],
    change: Callable[[bpy.types.Object], None],
    is_other: bool,
) -> None:
    before(cube)
    old = needed(cube)
    change(cube)
    new = needed(cube)
    assert (old != new) == is_other


def test_copies_share_their_bake(cube: bpy.types.Object) -> None:
    other = cube.copy()
    bpy.context.collection.objects.link(other)
    other.location.x = 5.0
    bpy.context.view_layer.update()
    assert needed(other) == needed(cube)


def test_what_is_followed_needs_no_file(cube: bpy.types.Object) -> None:
    for each in list(node(cube, "BsdfPrincipled").inputs):
        for link in list(each.links):
            cube.active_material.node_tree.links.remove(link)
    assert inputs_file(cube, bpy.context.evaluated_depsgraph_get()) is None


def test_what_is_not_saved_is_told(cube: bpy.types.Object) -> None:
    image = node(cube, "TexImage").image
    image.pixels.foreach_set(np.full(64, 0.5, np.float32))
    image.update()
    with pytest.raises(SceneError, match=r"Image picture has pixels that are not saved.*: save or pack it"):
        needed(cube)


@pytest.fixture
def inputs(cube: bpy.types.Object, monkeypatch: pytest.MonkeyPatch) -> Iterator[InputBakes]:
    """Those of a session that shows the cube."""
    rsibr.register()
    previews = session().previews
    monkeypatch.setattr(previews, "with_baked_inputs", lambda _: [cube])
    yield previews.inputs
    rsibr.unregister()


def write_flat(path: Path) -> None:
    write_baked_inputs(path, BakedInputs({(0, ("base_color",)): np.zeros((4, 4, 3), np.float32)}, "UVMap"))


def test_a_file_that_cannot_be_shown_is_read_once_and_told(
    cube: bpy.types.Object, inputs: InputBakes, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def refuse(*_: object) -> int:
        raise DeviceError("The picture is too large.")

    monkeypatch.setattr(GpuTexture, "upload", refuse)
    path = tmp_path / "inputs-0123456789.exr"
    write_flat(path)
    for _ in range(2):
        assert inputs.wish(cube, path)
        while inputs.is_busy:
            inputs.upload()
        assert inputs.messages(cube, by_itself=True) == ["The picture is too large."]
        assert inputs.is_unasked  # and so it is asked for again
        assert not inputs.wish(cube, path)
        assert not inputs.is_busy
        inputs.forgive(cube)


def test_a_render_reads_a_file_that_viewports_have_not_read_yet(
    cube: bpy.types.Object, inputs: InputBakes, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(GpuTexture, "upload", lambda *_: 0)
    monkeypatch.setattr(GpuTexture, "is_whole", True)
    path = tmp_path / "inputs-0123456789.exr"
    assert not inputs.wish(cube, path)
    write_flat(path)
    render = InputBakes(AtOnce())
    render.show_as(inputs)
    assert render.upload()
    assert not render.lacks(cube)
    assert render.shows_all(cube)
    assert not inputs.shows_all(cube)


def test_what_kept_an_object_from_its_file_is_forgotten_once_it_is_gone(
    cube: bpy.types.Object, inputs: InputBakes, tmp_path: Path
) -> None:
    write_flat(tmp_path / needed(cube))
    bpy.ops.rsibr.bake_inputs(by_itself=True)
    assert not inputs.is_refused(cube)
    image = node(cube, "TexImage").image
    image.pixels.foreach_set(np.full(64, 0.5, np.float32))
    image.update()
    bpy.ops.rsibr.bake_inputs(by_itself=True)
    assert "pixels that are not saved" in inputs.messages(cube, by_itself=True)[0]
    image.reload()
    bpy.ops.rsibr.bake_inputs(by_itself=True)
    assert not inputs.is_refused(cube)
    image.pixels.foreach_set(np.full(64, 0.5, np.float32))
    image.update()
    bpy.ops.rsibr.bake_inputs(by_itself=True)
    assert inputs.is_refused(cube)
    bsdf = node(cube, "BsdfPrincipled")
    for each in [link for socket in bsdf.inputs for link in socket.links]:
        cube.active_material.node_tree.links.remove(each)
    bpy.ops.rsibr.bake_inputs(by_itself=True)
    assert not inputs.is_refused(cube)
    assert not inputs.lacks(cube)


def waiting(title: str, output: Path, items: list[int]) -> InputBake:
    return InputBake(title=title, output=output, command=("sleep", "60"), items=items)


def test_a_bake_that_is_cancelled_is_told_and_not_asked_for_again(
    cube: bpy.types.Object, inputs: InputBakes, tmp_path: Path
) -> None:
    output = tmp_path / needed(cube)
    inputs.wish(cube, output)
    inputs.ask(cube)
    session().bakes.add(waiting("of the cube", output, [cube.session_uid]))
    assert inputs.messages(cube, by_itself=True) == ["Materials need a bake: baking."]
    assert bpy.ops.rsibr.cancel_bake(number=0) == {"FINISHED"}
    for _ in range(2):
        assert "was cancelled: press Bake Materials" in inputs.messages(cube, by_itself=True)[0]
        bpy.ops.rsibr.bake_inputs(by_itself=True)
        assert not session().bakes.busy


def test_an_edit_of_one_object_leaves_the_bake_of_its_copy(
    cube: bpy.types.Object, inputs: InputBakes, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(
        "rsibr.operators.bake_inputs.input_bake_of", lambda *given: waiting("new", given[2], [])
    )
    bakes, copy = session().bakes, 12345
    bakes.add(waiting("of another", tmp_path / "other.exr", [copy]))
    shared = waiting("of both", tmp_path / "before.exr", [cube.session_uid, copy])
    bakes.add(shared)
    bpy.ops.rsibr.bake_inputs(by_itself=True)
    assert (shared.items, shared.ended) == ([copy], False)
    shared.items = [cube.session_uid]
    inputs.forgive(cube)
    change_noise(cube)
    bpy.ops.rsibr.bake_inputs(by_itself=True)
    assert shared.ended
