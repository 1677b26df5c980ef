"""Which file of baked inputs an object needs: another for what shows, the same for what does not."""

from collections.abc import Callable

import bpy
import numpy as np
import pytest
from rsibr.rsibr_addon.core.errors import SceneError
from rsibr.rsibr_addon.tasks.queue.input_bakes import inputs_file


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


def nothing(item: bpy.types.Object) -> None:
    """Leave it."""


@pytest.mark.parametrize(
    ("before", "change", "is_other"),
    [
        (nothing, nothing, False),
        (nothing, slide, False),
        (nothing, link_image, False),
        (nothing, lay_out, False),
        (nothing, move, False),
        (nothing, rename, False),
        (nothing, change_noise, True),
        (nothing, change_ramp, True),
        (nothing, mute, True),
        (nothing, relink, True),
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
