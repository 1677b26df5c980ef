"""Materials' inputs as they are described, beside what Cycles makes of their nodes."""

from collections.abc import Callable, Iterator

import bpy
import numpy as np
import pytest
from rsibr.rsibr_addon.core.conventions import Array
from rsibr.rsibr_addon.core.errors import SceneError
from rsibr.rsibr_addon.core.light.transfer_curve import linear_from_srgb
from rsibr.rsibr_addon.core.materials.principled import Baked, Bump, Input, NormalMap
from rsibr.rsibr_addon.core.materials.sampling import evaluate
from rsibr.rsibr_addon.host.principled import principled
from rsibr.rsibr_addon.host.rendering import configure_cycles
from rsibr.rsibr_addon.host.scenes import temporary_scene

SIZE = 16
"""Width of a bake, in texels."""

TEXELS = np.random.default_rng(3).uniform(0.1, 0.9, (5, 7, 4)).astype(np.float32)
TEXELS[..., 3] = 1.0


class Nodes:
    """A material's nodes, and how a test adds to them."""

    def __init__(self) -> None:
        self.material = bpy.data.materials.new("material")
        self.tree = self.material.node_tree
        self.bsdf = self.tree.nodes["Principled BSDF"]

    def add(self, kind: str, **properties: object) -> bpy.types.Node:
        node = self.tree.nodes.new(f"ShaderNode{kind}")
        for name, value in properties.items():
            setattr(node, name, value)
        return node

    def image(self, **properties: object) -> bpy.types.Node:
        image = bpy.data.images.new("picture", TEXELS.shape[1], TEXELS.shape[0], float_buffer=True)
        image.pixels.foreach_set(TEXELS.ravel())
        image.update()
        image.pack()
        return self.add("TexImage", image=image, **properties)

    def link(self, first: bpy.types.NodeSocket, second: bpy.types.NodeSocket | str) -> None:
        self.tree.links.new(first, self.bsdf.inputs[second] if isinstance(second, str) else second)


@pytest.fixture
def nodes() -> Iterator[Nodes]:
    with temporary_scene():
        yield Nodes()


def baked(nodes: Nodes, name: str) -> Array:
    """An input as Cycles bakes it on the unit square, shape (SIZE, SIZE, 3)."""
    emission = nodes.add("Emission")
    nodes.link(nodes.bsdf.inputs[name].links[0].from_socket, emission.inputs["Color"])
    output = nodes.tree.get_output_node("CYCLES")
    nodes.link(emission.outputs[0], output.inputs["Surface"])
    return baked_surface(nodes)


def baked_surface(nodes: Nodes) -> Array:
    """What the surface gives off, as Cycles bakes it on the unit square, shape (SIZE, SIZE, 3)."""
    scene = bpy.data.scenes.new("bake")
    configure_cycles(scene, SIZE, SIZE, 1)
    mesh = bpy.data.meshes.new("square")
    mesh.from_pydata([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)], [], [(0, 1, 2, 3)])
    mesh.uv_layers.new(name="UVMap").data.foreach_set("uv", [0, 0, 1, 0, 1, 1, 0, 1])
    mesh.materials.append(nodes.material)
    item = bpy.data.objects.new("square", mesh)
    scene.collection.objects.link(item)
    target = nodes.add("TexImage", image=bpy.data.images.new("target", SIZE, SIZE, float_buffer=True))
    nodes.tree.nodes.active = target
    layer = scene.view_layers[0]
    layer.objects.active = item
    item.select_set(True, view_layer=layer)
    with bpy.context.temp_override(
        scene=scene, view_layer=layer, active_object=item, object=item, selected_objects=[item]
    ):
        bpy.ops.object.bake(type="EMIT", margin=0)
    pixels = np.empty(SIZE * SIZE * 4, np.float32)
    target.image.pixels.foreach_get(pixels)
    return pixels.reshape(SIZE, SIZE, 4)[..., :3]


def check(nodes: Nodes, name: str, field: str) -> None:
    described = getattr(principled(nodes.material), field)
    assert isinstance(described, Input)
    centre = (np.arange(SIZE) + 0.5) / SIZE
    ours = evaluate(described, TEXELS, np.stack(np.meshgrid(centre, centre), axis=-1))
    # Half the precision of Cycles' half-float textures, and its 8 bits of a bilinear weight
    np.testing.assert_allclose(np.broadcast_to(ours, (SIZE, SIZE, 3)), baked(nodes, name), atol=4e-3)


@pytest.mark.parametrize("interpolation", ["Linear", "Closest"])
@pytest.mark.parametrize("extension", ["REPEAT", "EXTEND", "CLIP", "MIRROR"])
@pytest.mark.parametrize("kind", ["POINT", "TEXTURE", "VECTOR"])
def test_an_image_lies_where_cycles_has_it(
    nodes: Nodes, interpolation: str, extension: str, kind: str
) -> None:
    image = nodes.image(interpolation=interpolation, extension=extension)
    mapping = nodes.add("Mapping", vector_type=kind)
    for name, value in {"Location": (-0.3, 0.4, 0), "Rotation": (0, 0, 0.7), "Scale": (2.1, 1.3, 1)}.items():
        if name in mapping.inputs:  # a mapping of vectors has no location
            mapping.inputs[name].default_value = value
    nodes.link(nodes.add("TexCoord").outputs["UV"], mapping.inputs["Vector"])
    nodes.link(mapping.outputs[0], image.inputs["Vector"])
    nodes.link(image.outputs["Color"], "Base Color")
    check(nodes, "Base Color", "base_color")


@pytest.mark.parametrize("linked", [False, True])
@pytest.mark.parametrize("mode", ["STRAIGHT", "CHANNEL_PACKED", "NONE"])
def test_what_alpha_hides_is_black_unless_alpha_is_taken(nodes: Nodes, mode: str, linked: bool) -> None:
    image = bpy.data.images.new("holes", TEXELS.shape[1], TEXELS.shape[0], alpha=True)
    texels = np.round(255.0 * TEXELS) / 255.0
    texels[..., 3] = np.indices(TEXELS.shape[:2]).sum(axis=0) % 2
    image.pixels.foreach_set(texels.astype(np.float32).ravel())
    image.update()
    image.pack()
    image.alpha_mode = mode
    node = nodes.add("TexImage", image=image, interpolation="Closest")
    nodes.link(node.outputs["Color"], "Base Color")
    if linked:
        nodes.link(node.outputs["Alpha"], "Alpha")
    described = principled(nodes.material).base_color
    assert isinstance(described, Input)
    assert described.texture is not None
    assert described.texture.covered == (mode == "STRAIGHT" and not linked)
    if not linked:  # a bake of the colour alone takes no alpha
        centre = (np.arange(SIZE) + 0.5) / SIZE
        linear = np.concatenate([linear_from_srgb(texels[..., :3]), texels[..., 3:]], axis=-1)
        ours = evaluate(described, linear, np.stack(np.meshgrid(centre, centre), axis=-1))
        np.testing.assert_allclose(ours, baked(nodes, "Base Color"), atol=4e-3)


def inverted(nodes: Nodes, color: bpy.types.NodeSocket) -> bpy.types.NodeSocket:
    node = nodes.add("Invert")
    node.inputs["Factor"].default_value = 0.8
    nodes.link(color, node.inputs["Color"])
    return node.outputs[0]


def green(nodes: Nodes, color: bpy.types.NodeSocket) -> bpy.types.NodeSocket:
    node = nodes.add("SeparateColor")
    nodes.link(color, node.inputs[0])
    return node.outputs["Green"]


def mixed(blend: str) -> Callable[[Nodes, bpy.types.NodeSocket], bpy.types.NodeSocket]:
    def mix(nodes: Nodes, color: bpy.types.NodeSocket) -> bpy.types.NodeSocket:
        node = nodes.add("Mix", data_type="RGBA", blend_type=blend)
        factor, first, second = (each for each in node.inputs if each.enabled)
        factor.default_value, second.default_value = 0.7, (0.2, 0.6, 0.9, 1.0)
        nodes.link(color, first)
        return next(each for each in node.outputs if each.enabled)

    return mix


def calculated(operation: str) -> Callable[[Nodes, bpy.types.NodeSocket], bpy.types.NodeSocket]:
    def calculate(nodes: Nodes, color: bpy.types.NodeSocket) -> bpy.types.NodeSocket:
        node = nodes.add("Math", operation=operation)
        node.inputs[1].default_value = 0.4
        nodes.link(color, node.inputs[0])
        return node.outputs[0]

    return calculate


def muted(nodes: Nodes, color: bpy.types.NodeSocket) -> bpy.types.NodeSocket:
    output = inverted(nodes, color)
    output.node.mute = True
    return output


def nested(nodes: Nodes, color: bpy.types.NodeSocket) -> bpy.types.NodeSocket:
    """Five groups, one in the other; the innermost inverts."""
    kept = nodes.tree
    inner = None
    for _ in range(5):
        tree = bpy.data.node_groups.new("group", "ShaderNodeTree")
        tree.interface.new_socket("In", in_out="INPUT", socket_type="NodeSocketColor")
        tree.interface.new_socket("Out", in_out="OUTPUT", socket_type="NodeSocketColor")
        begin, end = tree.nodes.new("NodeGroupInput"), tree.nodes.new("NodeGroupOutput")
        node = tree.nodes.new("ShaderNodeGroup" if inner else "ShaderNodeInvert")
        if inner:
            node.node_tree = inner
        tree.links.new(begin.outputs[0], node.inputs[0 if inner else "Color"])
        tree.links.new(node.outputs[0], end.inputs[0])
        inner = tree
    group = kept.nodes.new("ShaderNodeGroup")
    group.node_tree = inner
    reroute = kept.nodes.new("NodeReroute")
    nodes.link(color, reroute.inputs[0])
    nodes.link(reroute.outputs[0], group.inputs[0])
    return group.outputs[0]


FOLLOWED = {
    "inverted": inverted,
    "green": green,
    "muted": muted,
    "nested": nested,
    **{blend: mixed(blend) for blend in ("MIX", "MULTIPLY", "ADD", "SUBTRACT")},
    **{f"math {each}": calculated(each) for each in ("ADD", "SUBTRACT", "MULTIPLY")},
}


@pytest.mark.parametrize("case", FOLLOWED)
def test_what_lies_between_is_followed(nodes: Nodes, case: str) -> None:
    nodes.link(FOLLOWED[case](nodes, nodes.image().outputs["Color"]), "Base Color")
    check(nodes, "Base Color", "base_color")


def test_an_image_that_is_not_there_is_cycles_magenta(nodes: Nodes) -> None:
    nodes.link(nodes.add("TexImage").outputs["Color"], "Base Color")
    check(nodes, "Base Color", "base_color")


def test_a_procedural_texture_is_to_be_baked(nodes: Nodes) -> None:
    nodes.link(nodes.add("TexNoise").outputs["Color"], "Base Color")
    assert principled(nodes.material).base_color == Baked("Noise Texture")


def test_normal_maps_and_bumps_are_told(nodes: Nodes) -> None:
    color = nodes.image().outputs["Color"]
    normal_map, bump = nodes.add("NormalMap", uv_map="other"), nodes.add("Bump", invert=True)
    normal_map.inputs["Strength"].default_value = 0.5
    nodes.link(color, normal_map.inputs["Color"])
    nodes.link(color, bump.inputs["Height"])
    nodes.link(normal_map.outputs[0], bump.inputs["Normal"])
    nodes.link(bump.outputs[0], "Normal")
    nodes.link(normal_map.outputs[0], "Coat Normal")
    described = principled(nodes.material)
    assert isinstance(described.normal, Bump)
    assert isinstance(described.coat_normal, NormalMap)
    assert described.normal.normal == described.coat_normal
    assert described.normal.invert
    assert described.coat_normal.uv_map == "other"
    assert described.coat_normal.strength.constant == (0.5,)


def test_descriptions_are_equal_until_something_changes(nodes: Nodes) -> None:
    before = principled(nodes.material)
    assert principled(nodes.material) == before
    nodes.bsdf.inputs["Roughness"].default_value = 0.25
    after = principled(nodes.material)
    assert after != before
    assert after.roughness == Input(((0.0, 0.0, 0.0, 0.0, 0.25),))


def test_what_is_not_shown_is_listed(nodes: Nodes) -> None:
    assert principled(nodes.material).missing == ()
    nodes.bsdf.inputs["Transmission Weight"].default_value = 0.5
    assert principled(nodes.material).missing == ("transmission",)


@pytest.mark.parametrize(
    ("ior", "metallic", "is_told"), [(0.7, 0.0, True), (0.7, 1.0, False), (1.0, 0.0, False)]
)
def test_an_index_below_1_is_told(nodes: Nodes, ior: float, metallic: float, is_told: bool) -> None:
    index = nodes.add("Value")
    index.outputs[0].default_value = ior
    nodes.link(index.outputs[0], "IOR")
    nodes.bsdf.inputs["Metallic"].default_value = metallic
    told = any("IOR below 1" in words for words in principled(nodes.material).missing)
    assert told == is_told


def test_an_image_as_index_may_be_below_1(nodes: Nodes) -> None:
    nodes.link(nodes.image().outputs["Color"], "IOR")
    assert any("IOR below 1" in words for words in principled(nodes.material).missing)


def test_a_material_without_a_principled_surface_is_refused(nodes: Nodes) -> None:
    output = nodes.tree.get_output_node("CYCLES")
    nodes.link(nodes.add("BsdfGlass").outputs[0], output.inputs["Surface"])
    with pytest.raises(SceneError, match="made by Glass BSDF"):
        principled(nodes.material)
    nodes.tree.nodes.remove(output)
    with pytest.raises(SceneError, match="no surface"):
        principled(nodes.material)
