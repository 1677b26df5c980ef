"""Materials of objects as previews read them: each is shown, or what is not shown is said in a sentence."""

import re
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import fields
from pathlib import Path
from typing import Any

import bpy
import numpy as np
import pytest
from rsibr.rsibr_addon.core.materials.principled import Baked, Bump, Input, NormalMap, constant
from rsibr.rsibr_addon.core.materials.stand_ins import BLACK, PLAIN, UNASSIGNED
from rsibr.rsibr_addon.device.own_materials import MOST_TEXTURES, MOST_UV_MAPS
from rsibr.rsibr_addon.host import input_nodes
from rsibr.rsibr_addon.host.principled import principled
from rsibr.rsibr_addon.host.surfaces import INPUTS
from rsibr.rsibr_addon.tasks.viewport import own_materials
from rsibr.rsibr_addon.tasks.viewport.baked_inputs import InputBakes, ShownInputs
from rsibr.rsibr_addon.tasks.viewport.own_materials import Materials, ShownMaterials


@pytest.fixture
def cube() -> bpy.types.Object:
    """The factory file's, of one slot."""
    bpy.ops.wm.read_factory_settings()
    return bpy.data.objects["Cube"]


def unbaked() -> Materials:
    """Materials of which nothing is baked."""
    return Materials(InputBakes(ThreadPoolExecutor(1)))


def shown(item: bpy.types.Object, materials: Materials | None = None) -> ShownMaterials:
    """What an object shows, as the depsgraph has it."""
    bpy.context.view_layer.update()
    evaluated = item.evaluated_get(bpy.context.evaluated_depsgraph_get())
    found = (materials or unbaked()).of(evaluated)
    for slot in found.slots:
        values = [getattr(slot.inputs, field.name) for field in fields(slot.inputs)]
        assert not [value for value in values if isinstance(value, Baked)]
    return found


def bsdf(material: bpy.types.Material) -> bpy.types.Node:
    return material.node_tree.nodes["Principled BSDF"]


def image_node(material: bpy.types.Material, name: str, image: bpy.types.Image | None) -> bpy.types.Node:
    """A node with an image, linked to an input of the BSDF."""
    node = material.node_tree.nodes.new("ShaderNodeTexImage")
    node.image = image
    material.node_tree.links.new(node.outputs["Color"], bsdf(material).inputs[name])
    return node


def picture(name: str = "picture") -> bpy.types.Image:
    return bpy.data.images.new(name, 4, 4)


def test_the_plain_material_is_blender_s() -> None:
    new = principled(bpy.data.materials.new("new"))
    for field in fields(PLAIN):
        value, expected = getattr(new, field.name), getattr(PLAIN, field.name)
        if isinstance(expected, Input):  # which Blender keeps in single precision
            np.testing.assert_allclose(value.rows, expected.rows, rtol=1e-7)
        else:
            assert value == expected


# Bad input: what a test does to a material -> what is said of it; nothing where all is shown


def no_image(material: bpy.types.Material) -> None:
    image_node(material, "Base Color", None)


def missing_file(material: bpy.types.Material) -> None:
    image = picture("lost")
    image.source, image.filepath = "FILE", "//nowhere/lost.png"
    image_node(material, "Base Color", image)


def generated(material: bpy.types.Material) -> None:
    image_node(material, "Base Color", picture())


def packed(material: bpy.types.Material) -> None:
    image = picture()
    image.pack()
    image_node(material, "Base Color", image)


def tiled(material: bpy.types.Material) -> None:
    image_node(material, "Base Color", bpy.data.images.new("tiles", 4, 4, tiled=True))


def movie(material: bpy.types.Material) -> None:
    image = picture()
    image.source = "MOVIE"
    image_node(material, "Base Color", image)


def no_such_uv_map(material: bpy.types.Material) -> None:
    node = image_node(material, "Base Color", picture())
    uv_map = material.node_tree.nodes.new("ShaderNodeUVMap")
    uv_map.uv_map = "absent"
    material.node_tree.links.new(uv_map.outputs[0], node.inputs["Vector"])


def nested_groups(material: bpy.types.Material) -> None:
    """The image lies five groups deep."""
    tree = None
    for _ in range(5):
        inner, tree = tree, bpy.data.node_groups.new("group", "ShaderNodeTree")
        tree.interface.new_socket("Color", in_out="OUTPUT", socket_type="NodeSocketColor")
        if inner is None:
            node = tree.nodes.new("ShaderNodeTexImage")
            node.image = picture()
        else:
            node = tree.nodes.new("ShaderNodeGroup")
            node.node_tree = inner
        tree.links.new(node.outputs[0], tree.nodes.new("NodeGroupOutput").inputs[0])
    group = material.node_tree.nodes.new("ShaderNodeGroup")
    group.node_tree = tree
    material.node_tree.links.new(group.outputs[0], bsdf(material).inputs["Base Color"])


def cycle_of_drivers(material: bpy.types.Material) -> None:
    for name, other in (("Metallic", "Roughness"), ("Roughness", "Metallic")):
        socket = bsdf(material).inputs[name]
        driver = socket.driver_add("default_value").driver
        variable = driver.variables.new()
        variable.targets[0].id_type = "NODETREE"
        variable.targets[0].id = material.node_tree
        variable.targets[0].data_path = f'nodes["Principled BSDF"].inputs["{other}"].default_value'
        driver.expression = f"{variable.name} + 0.1"


def without_output(material: bpy.types.Material) -> None:
    material.node_tree.nodes.remove(material.node_tree.nodes["Material Output"])


def without_nodes(material: bpy.types.Material) -> None:
    material.node_tree.nodes.clear()


def noise(material: bpy.types.Material) -> None:
    node = material.node_tree.nodes.new("ShaderNodeTexNoise")
    material.node_tree.links.new(node.outputs["Color"], bsdf(material).inputs["Base Color"])
    material.node_tree.links.new(node.outputs["Fac"], bsdf(material).inputs["Roughness"])


def baked_normal(material: bpy.types.Material) -> None:
    node = material.node_tree.nodes.new("ShaderNodeBevel")
    material.node_tree.links.new(node.outputs[0], bsdf(material).inputs["Normal"])


def glass(material: bpy.types.Material) -> None:
    bsdf(material).inputs["Transmission Weight"].default_value = 1.0


def bumped_coat(material: bpy.types.Material) -> None:
    node = material.node_tree.nodes.new("ShaderNodeBump")
    height = image_node(material, "Roughness", picture()).outputs[0]
    material.node_tree.links.new(height, node.inputs["Height"])
    material.node_tree.links.new(node.outputs[0], bsdf(material).inputs["Coat Normal"])


def many_images(material: bpy.types.Material) -> None:
    for number, name in enumerate(list(INPUTS.values())[: MOST_TEXTURES + 3]):
        image_node(material, name, picture(f"picture {number}"))


def many_uv_maps(material: bpy.types.Material) -> None:
    mesh, tree = bpy.data.objects["Cube"].data, material.node_tree
    for number, name in enumerate(("Base Color", "Roughness", "Metallic", "Coat Weight", "Alpha")):
        node, uv_map = image_node(material, name, picture()), tree.nodes.new("ShaderNodeUVMap")
        uv_map.uv_map = (mesh.uv_layers.new(name=f"map {number}")).name
        tree.links.new(uv_map.outputs[0], node.inputs["Vector"])


def loop_of_links(material: bpy.types.Material) -> None:
    first, second = (material.node_tree.nodes.new("ShaderNodeMath") for _ in range(2))
    material.node_tree.links.new(first.outputs[0], second.inputs[0])
    material.node_tree.links.new(second.outputs[0], first.inputs[0])
    material.node_tree.links.new(second.outputs[0], bsdf(material).inputs["Roughness"])


def long_chain(material: bpy.types.Material) -> None:
    before = None
    for _ in range(400):
        node = material.node_tree.nodes.new("ShaderNodeMath")
        if before:
            material.node_tree.links.new(before, node.inputs[0])
        before = node.outputs[0]
    material.node_tree.links.new(before, bsdf(material).inputs["Roughness"])


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (no_image, ""),
        (missing_file, "Image lost of material Material has no pixels and is shown pink"),
        (generated, ""),
        (packed, ""),
        (tiled, r"Base Color \(UDIM tiles\)"),
        (movie, r"Base Color \(a movie\)"),
        (no_such_uv_map, "Cube does not have the UV map absent, which material Material asks for"),
        (nested_groups, ""),
        (cycle_of_drivers, ""),
        (without_output, "Material Material has no surface"),
        (without_nodes, "Material Material has no surface"),
        (noise, r"default for Base Color \(Noise Texture\) and Roughness \(Noise Texture\)\."),
        (baked_normal, r"default for Normal \(Bevel\)\."),
        (glass, "Material Material is shown without transmission."),
        (bumped_coat, r"default for Coat Normal \(a bump of its own\)"),
        (many_images, f"more than {MOST_TEXTURES} images"),
        (many_uv_maps, f"The materials of Cube use more than {MOST_UV_MAPS} UV maps"),
        (loop_of_links, None),
        (long_chain, "Material Material has chains of nodes that are too long"),
    ],
    ids=lambda each: each.__name__ if callable(each) else "",
)
def test_what_cannot_be_shown_is_said(
    cube: bpy.types.Object, change: Callable[[bpy.types.Material], None], said: str | None
) -> None:
    change(cube.active_material)
    # An image gives an IOR below 1
    told = [each for each in shown(cube).messages if "IOR below 1" not in each]
    assert len(told) <= 1
    if said is not None:
        assert bool(told) == bool(said)
        assert not said or re.search(said, told[0])


def test_an_image_is_found_through_groups(cube: bpy.types.Object) -> None:
    nested_groups(cube.active_material)
    (slot,) = shown(cube).slots
    assert [texture.image for texture in slot.textures] == ["picture"]


def test_a_missing_image_is_pink_also_through_nodes(cube: bpy.types.Object) -> None:
    material = cube.active_material
    missing_file(material)
    (slot,) = shown(cube).slots
    assert slot.inputs.base_color == constant((1.0, 0.0, 1.0))
    assert not slot.textures


def test_a_material_without_surface_is_black_and_no_material_is_grey(cube: bpy.types.Object) -> None:
    without_output(cube.active_material)
    cube.data.materials.append(None)
    assert [slot.inputs for slot in shown(cube).slots] == [BLACK, UNASSIGNED]
    cube.data.materials.clear()
    assert [slot.inputs for slot in shown(cube).slots] == [UNASSIGNED]


def test_a_material_is_read_once_until_it_may_have_changed(
    cube: bpy.types.Object, monkeypatch: pytest.MonkeyPatch
) -> None:
    read: list[str] = []

    def counted(material: bpy.types.Material, *baked: Any) -> own_materials.ShownMaterial:
        read.append(material.name)
        return original(material, *baked)

    original = own_materials.shown_material
    monkeypatch.setattr(own_materials, "shown_material", counted)
    materials = unbaked()
    cube.data.materials.append(cube.active_material)
    first = shown(cube, materials)
    assert shown(cube, materials).slots == first.slots
    assert read == ["Material"]
    materials.changed()
    assert shown(cube, materials).slots != first.slots
    assert read == ["Material"] * 2


def test_an_output_is_read_once_however_many_inputs_it_feeds(
    cube: bpy.types.Object, monkeypatch: pytest.MonkeyPatch
) -> None:
    material, read = cube.active_material, []
    tree, before = material.node_tree, image_node(material, "Base Color", picture()).outputs["Alpha"]
    for _ in range(10):
        node = tree.nodes.new("ShaderNodeMath")  # adds what is before to itself
        for number in (0, 1):
            tree.links.new(before, node.inputs[number])
        before = node.outputs[0]
    for name in ("Roughness", "Metallic"):
        tree.links.new(before, bsdf(material).inputs[name])
    original = input_nodes.NODES["ShaderNodeMath"]
    monkeypatch.setitem(
        input_nodes.NODES, "ShaderNodeMath", lambda *given: read.append(given) or original(*given)
    )
    found = principled(material)
    assert found.metallic == found.roughness
    assert found.roughness.rows == ((0.0, 0.0, 0.0, 2.0**10, 0.0),)
    assert len(read) == 10


def test_drivers_and_keys_are_followed_by_frame(cube: bpy.types.Object) -> None:
    roughness, metallic = (bsdf(cube.active_material).inputs[name] for name in ("Roughness", "Metallic"))
    roughness.driver_add("default_value").driver.expression = "frame / 100"
    for frame in (1, 101):
        metallic.default_value = frame / 101
        metallic.keyframe_insert("default_value", frame=frame)
    seen = []
    for frame in (20, 101):
        bpy.context.scene.frame_set(frame)
        inputs = shown(cube).slots[0].inputs
        seen.append((inputs.roughness.constant[0], inputs.metallic.constant[0]))
    assert seen[0][0] == pytest.approx(0.2)
    assert 0.0 < seen[0][1] < 1.0
    assert seen[1] == (pytest.approx(1.01), 1.0)


def test_materials_that_geometry_nodes_and_objects_set_are_the_ones(cube: bpy.types.Object) -> None:
    by_nodes, by_object = (bpy.data.materials.new(name) for name in ("by nodes", "by object"))
    bsdf(by_nodes).inputs["Roughness"].default_value = 0.125
    bsdf(by_object).inputs["Roughness"].default_value = 0.25
    cube.material_slots[0].link = "OBJECT"
    cube.material_slots[0].material = by_object
    tree = bpy.data.node_groups.new("set", "GeometryNodeTree")
    for way in ("INPUT", "OUTPUT"):
        tree.interface.new_socket("Geometry", in_out=way, socket_type="NodeSocketGeometry")
    begin, end = tree.nodes.new("NodeGroupInput"), tree.nodes.new("NodeGroupOutput")
    setting = tree.nodes.new("GeometryNodeSetMaterial")
    setting.inputs["Material"].default_value = by_nodes
    tree.links.new(begin.outputs[0], setting.inputs[0])
    tree.links.new(setting.outputs[0], end.inputs[0])
    assert [slot.inputs.roughness.constant[0] for slot in shown(cube).slots] == [0.25]
    cube.modifiers.new("set", "NODES").node_group = tree
    assert [slot.inputs.roughness.constant[0] for slot in shown(cube).slots] == [0.25, 0.125]


def test_linked_and_overridden_materials_and_images_are_read(cube: bpy.types.Object, tmp_path: Path) -> None:
    image = picture("of the library")
    image.pack()
    material = bpy.data.materials.new("linked")
    image_node(material, "Base Color", image)
    path = str(tmp_path / "library.blend")
    bpy.data.libraries.write(path, {material}, fake_user=True)
    bpy.data.materials.remove(material)
    bpy.data.images.remove(image)
    picture("of the library")  # one of ours with its name
    with bpy.data.libraries.load(path, link=True) as (_, there):
        there.materials = ["linked"]
    linked = bpy.data.materials["linked", path]
    cube.data.materials[0] = linked
    for _ in range(2):
        found = shown(cube)
        (texture,) = found.slots[0].textures
        assert (texture.image, texture.library, found.messages) == ("of the library", path, ())
        cube.data.materials[0] = linked.override_create()


def test_a_mesh_is_asked_for_the_uv_maps_and_tangents_of_its_slots(cube: bpy.types.Object) -> None:
    mapped, bumped = bpy.data.materials.new("mapped"), bpy.data.materials.new("bumped")
    for material, kind in ((mapped, "NormalMap"), (bumped, "Bump")):
        node = material.node_tree.nodes.new(f"ShaderNode{kind}")
        link = image_node(material, "Roughness", picture()).outputs[0]
        material.node_tree.links.new(link, node.inputs["Color" if kind == "NormalMap" else "Height"])
        material.node_tree.links.new(node.outputs[0], bsdf(material).inputs["Normal"])
        if kind == "NormalMap":
            node.uv_map = "UVMap"
    coated = mapped.copy()
    tree = coated.node_tree
    tree.links.new(tree.nodes["Normal Map"].outputs[0], bsdf(coated).inputs["Coat Normal"])
    tree.links.remove(bsdf(coated).inputs["Normal"].links[0])
    cube.data.materials[0] = mapped
    cube.data.materials.append(bumped)
    cube.data.materials.append(coated)
    found = shown(cube)
    assert isinstance(found.slots[0].inputs.normal, NormalMap)
    assert isinstance(found.slots[1].inputs.normal, Bump)
    assert (found.needs.uv_maps, found.needs.tangents) == (("",), ("UVMap", None, "UVMap"))


def test_textures_beyond_the_last_that_fits_are_the_only_ones_not_shown(cube: bpy.types.Object) -> None:
    many_images(cube.active_material)
    (slot,) = shown(cube).slots
    assert len(slot.textures) == MOST_TEXTURES
    asked = list(INPUTS)[: MOST_TEXTURES + 3]
    textured = [name for name in asked if getattr(slot.inputs, name).texture]
    assert textured == asked[:MOST_TEXTURES]
    for name in asked[MOST_TEXTURES:]:
        assert getattr(slot.inputs, name) == getattr(PLAIN, name)


def test_a_bake_of_another_mesh_is_told_and_no_bake_is_promised(cube: bpy.types.Object) -> None:
    noise(cube.active_material)
    of_viewports = ShownInputs({}, {}, ("bake", np.zeros((5, 2), np.float32)))
    inputs = InputBakes(ThreadPoolExecutor(1))
    inputs._shown[cube.session_uid] = Path("inputs.exr"), of_viewports
    (told,) = Materials(inputs).of(cube.evaluated_get(bpy.context.evaluated_depsgraph_get())).messages
    assert "the bake of Cube lies face by face on the mesh that viewports show" in told
