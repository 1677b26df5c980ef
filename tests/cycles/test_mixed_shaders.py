"""One Principled BSDF in the place of other shaders and mixes, beside what Cycles makes of these."""

from collections.abc import Callable
from pathlib import Path

import bpy
import numpy as np
import pytest
from rsibr.rsibr_addon.core.errors import SceneError
from rsibr.rsibr_addon.core.materials.packing import pictures_of
from rsibr.rsibr_addon.core.materials.principled import Input, PrincipledInputs
from rsibr.rsibr_addon.core.materials.sampling import evaluate
from rsibr.rsibr_addon.host.goniophotometer import LEAST_COSINE, measure
from rsibr.rsibr_addon.host.principled import SEPARATE, principled
from rsibr.rsibr_addon.host.scenes import temporary_scene
from rsibr.rsibr_addon.host.surfaces import INPUTS
from rsibr.tests.cycles.test_baked_inputs import BESIDE, Cube, cube, in_middles
from rsibr.tests.cycles.test_baked_inputs import baked as bake
from rsibr.tests.cycles.test_host_principled import SIZE, TEXELS, Nodes, baked_surface, nodes

__all__ = ["cube", "nodes"]

ANGLES, PAIRS = 8, 1000
"""Angles between light and view, and pairs of each, of which a part lies below the horizon."""


def shader(nodes: Nodes, kind: str, **values: object) -> bpy.types.NodeSocket:
    """The output of a new shader with values in its inputs, named with underscores for spaces."""
    node = nodes.add(kind)
    for name, value in values.items():
        node.inputs[name.replace("_", " ")].default_value = value
    return node.outputs[0]


def mix(
    nodes: Nodes, first: bpy.types.NodeSocket, second: bpy.types.NodeSocket, factor: float = 0.3
) -> bpy.types.NodeSocket:
    node = nodes.add("MixShader")
    node.inputs[0].default_value = factor
    nodes.link(first, node.inputs[1])
    nodes.link(second, node.inputs[2])
    return node.outputs[0]


def add(nodes: Nodes, first: bpy.types.NodeSocket, second: bpy.types.NodeSocket) -> bpy.types.NodeSocket:
    node = nodes.add("AddShader")
    nodes.link(first, node.inputs[0])
    nodes.link(second, node.inputs[1])
    return node.outputs[0]


def show(nodes: Nodes, surface: bpy.types.NodeSocket) -> PrincipledInputs:
    nodes.link(surface, nodes.tree.get_output_node("CYCLES").inputs["Surface"])
    return principled(nodes.material)


def standing_for(inputs: PrincipledInputs) -> bpy.types.Material:
    """A material of one Principled BSDF with constant inputs."""
    material = bpy.data.materials.new("one")
    node = material.node_tree.nodes["Principled BSDF"]
    for field, name in INPUTS.items():
        value = getattr(inputs, field)
        assert isinstance(value, Input)
        numbers = value.constant
        node.inputs[name].default_value = numbers[0] if len(numbers) == 1 else (*numbers, 1.0)
    return material


def reflectance(material: bpy.types.Material) -> np.ndarray:
    """Measured for pairs of directions, evenly over both hemispheres, times the roots of both cosines.

    So the sum of squares is the power of the differences between two, and `error` one of the whole.
    """
    rng, found = np.random.default_rng(1), []
    for cosine in (np.arange(ANGLES) + 0.5) * (2.0 / ANGLES) - 1.0:
        frames = np.linalg.qr(rng.normal(size=(PAIRS, 3, 3)))[0]
        light_dir = frames[..., 0]
        view_dir = cosine * light_dir + np.sqrt(1.0 - cosine**2) * frames[..., 1]
        above = (light_dir[:, 2] > LEAST_COSINE) & (view_dir[:, 2] > LEAST_COSINE)
        light_dir, view_dir = light_dir[above], view_dir[above]
        if len(light_dir):
            with temporary_scene() as scene:
                measured = sum(measure(scene, material, light_dir, view_dir))
            found.append(measured * np.sqrt(light_dir[:, 2:] * view_dir[:, 2:]))
    return np.concatenate(found)


def error(nodes: Nodes, surface: bpy.types.NodeSocket) -> float:
    """Relative root mean square by which the Principled BSDF is off that stands for a surface."""
    inputs = show(nodes, surface)
    wanted, found = (reflectance(each) for each in (nodes.material, standing_for(inputs)))
    return float(np.sqrt(np.sum((found - wanted) ** 2) / np.sum(wanted**2)))


Make = Callable[[Nodes], bpy.types.NodeSocket]

PAINT = {"Base_Color": (0.2, 0.5, 0.8, 1.0), "Roughness": 0.4}
RUST = {"Base_Color": (0.5, 0.2, 0.1, 1.0), "Roughness": 0.4}

EXACT: dict[str, Make] = {
    "diffuse": lambda nodes: shader(nodes, "BsdfDiffuse", Color=(0.8, 0.4, 0.1, 1.0)),
    "rough diffuse": lambda nodes: shader(nodes, "BsdfDiffuse", Roughness=0.7),
    "white glossy": lambda nodes: shader(nodes, "BsdfAnisotropic", Color=(1.0,) * 4, Roughness=0.4),
    "metallic": lambda nodes: shader(nodes, "BsdfMetallic", Roughness=0.4),
    "paints": lambda nodes: mix(
        nodes, shader(nodes, "BsdfPrincipled", **PAINT), shader(nodes, "BsdfPrincipled", **RUST)
    ),
    "one alone": lambda nodes: mix(
        nodes, shader(nodes, "BsdfDiffuse"), shader(nodes, "BsdfAnisotropic", Color=(1.0,) * 4), 1.0
    ),
    "metal and paint of one colour": lambda nodes: mix(
        nodes,
        shader(nodes, "BsdfPrincipled", **PAINT),
        shader(nodes, "BsdfPrincipled", **PAINT, Metallic=1.0),
    ),
}


@pytest.mark.parametrize("case", EXACT)
def test_what_one_bsdf_is_exactly(nodes: Nodes, case: str) -> None:
    surface = EXACT[case](nodes)
    assert show(nodes, surface).missing == ()
    assert error(nodes, surface) < 1e-6  # single precision


def conductor(nodes: Nodes) -> bpy.types.NodeSocket:
    output = shader(nodes, "BsdfMetallic", Roughness=0.4)
    output.node.fresnel_type = "PHYSICAL_CONDUCTOR"
    return output


def boundary(nodes: Nodes) -> bpy.types.NodeSocket:
    """Diffuse and glossy reflection mixed by a Fresnel term, as plastic was made of old."""
    glossy = shader(nodes, "BsdfAnisotropic", Color=(1.0,) * 4, Roughness=0.2)
    output = mix(nodes, shader(nodes, "BsdfDiffuse", Color=(0.8, 0.3, 0.2, 1.0)), glossy)
    nodes.link(shader(nodes, "Fresnel", IOR=1.5), output.node.inputs[0])
    return output


def glossy(color: tuple[float, ...]) -> Make:
    return lambda nodes: shader(nodes, "BsdfAnisotropic", Color=(*color, 1.0), Roughness=0.4)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("make", "most"),
    [
        # Schlick's rise to white at the edge is undone but for 5 % of what is missing to white
        (glossy((0.9, 0.7, 0.4)), 0.03),
        (glossy((0.5, 0.5, 0.5)), 0.05),
        # Right at 0 and 82 degrees
        (conductor, 0.02),
        # The node takes the angle of the surface, and not that of facets, which counts where light grazes
        (boundary, 0.25),
    ],
)
def test_what_one_bsdf_is_nearly(nodes: Nodes, make: Make, most: float) -> None:
    surface = make(nodes)
    assert show(nodes, surface).missing == ()
    assert 1e-4 < error(nodes, surface) < most


@pytest.mark.parametrize(
    ("first", "second"),
    [
        ({**PAINT, "Roughness": 0.2}, PAINT),
        (PAINT, {**RUST, "Metallic": 1.0}),
        ({**PAINT, "IOR": 1.3}, PAINT),
    ],
)
def test_a_mix_that_is_none_is_told(
    nodes: Nodes, first: dict[str, object], second: dict[str, object]
) -> None:
    both = [shader(nodes, "BsdfPrincipled", **values) for values in (first, second)]
    assert show(nodes, mix(nodes, *both)).missing == (SEPARATE,)
    assert show(nodes, mix(nodes, *both, 0.0)).missing == ()


def test_transparency_is_alpha_and_light_is_emission(nodes: Nodes) -> None:
    paint = shader(nodes, "BsdfPrincipled", **PAINT)
    alone = show(nodes, paint)
    found = show(nodes, mix(nodes, shader(nodes, "BsdfTransparent", Color=(1.0,) * 4), paint, 0.3))
    assert found.alpha.constant == pytest.approx((0.3,))
    assert found.base_color == alone.base_color
    glow = shader(nodes, "Emission", Color=(0.2, 0.4, 0.6, 1.0), Strength=5.0)
    lit = show(nodes, add(nodes, glow, paint))
    assert lit.emission_color.constant == pytest.approx((0.2, 0.4, 0.6))
    assert lit.emission_strength.constant == (5.0,)
    assert (lit.base_color, lit.roughness) == (alone.base_color, alone.roughness)
    tinted = show(nodes, shader(nodes, "BsdfTransparent", Color=(1.0, 0.5, 0.5, 1.0)))
    assert tinted.missing == ("tinted transparency",)


def test_a_mask_between_constants_needs_no_bake(nodes: Nodes) -> None:
    output = mix(nodes, shader(nodes, "BsdfPrincipled", **PAINT), shader(nodes, "BsdfPrincipled", **RUST))
    nodes.link(nodes.image().outputs["Color"], output.node.inputs[0])
    inputs = show(nodes, output)
    assert pictures_of(inputs) == ()
    centre = (np.arange(SIZE) + 0.5) / SIZE
    uv = np.stack(np.meshgrid(centre, centre), axis=-1)
    mask = evaluate(Input((*inputs.base_color.rows,), inputs.base_color.texture), TEXELS, uv)
    # Cycles' own mix of the two colours, as emissions
    for number, values in ((1, PAINT), (2, RUST)):
        glow = shader(nodes, "Emission", Color=values["Base_Color"])
        nodes.link(glow, output.node.inputs[number])
    # Half the precision of Cycles' half-float textures, and its 8 bits of a bilinear weight
    np.testing.assert_allclose(mask, baked_surface(nodes), atol=4e-3)


@pytest.mark.parametrize(
    ("make", "sentence"),
    [
        (lambda nodes: shader(nodes, "BsdfGlass"), "made by Glass BSDF: use Principled, Diffuse"),
        (lambda nodes: nodes.add("MixShader").outputs[0], "mixed with nothing"),
        (
            lambda nodes: add(nodes, shader(nodes, "BsdfDiffuse"), shader(nodes, "BsdfAnisotropic")),
            "Add Shader adds two shaders",
        ),
    ],
)
def test_what_no_bsdf_is_is_refused(nodes: Nodes, make: Make, sentence: str) -> None:
    with pytest.raises(SceneError, match=sentence):
        show(nodes, make(nodes))


@pytest.mark.parametrize("grouped", [False, True])
def test_inputs_of_mixed_shaders_are_baked(cube: Cube, grouped: bool, tmp_path: Path) -> None:
    """Paint and rust mixed by a coordinate, then with transparency by another one."""
    nodes = cube
    place = cube.coordinates("Object")
    paint = shader(nodes, "BsdfPrincipled", **PAINT)
    if grouped:
        tree = bpy.data.node_groups.new("group", "ShaderNodeTree")
        tree.interface.new_socket("Surface", in_out="OUTPUT", socket_type="NodeSocketShader")
        node = tree.nodes.new("ShaderNodeBsdfPrincipled")
        for name, value in PAINT.items():
            node.inputs[name.replace("_", " ")].default_value = value
        tree.links.new(node.outputs[0], tree.nodes.new("NodeGroupOutput").inputs[0])
        group = cube.tree.nodes.new("ShaderNodeGroup")
        group.node_tree = tree
        paint = group.outputs[0]
    rust = shader(nodes, "BsdfPrincipled", Base_Color=RUST["Base_Color"], Roughness=0.9)
    inner = mix(nodes, paint, rust)
    nodes.link(cube.part(place, "X"), inner.node.inputs[0])
    outer = mix(nodes, inner, shader(nodes, "BsdfTransparent", Color=(1.0,) * 4))
    nodes.link(cube.part(place, "Y"), outer.node.inputs[0])
    inputs = show(nodes, outer)
    assert inputs.metallic.constant == (0.0,)
    found = bake(tmp_path)
    assert found.pictures.keys() == {(0, ("base_color",)), (0, ("roughness",)), (0, ("alpha",))}
    for field, first, second, axis in (
        ("base_color", PAINT["Base_Color"][:3], RUST["Base_Color"][:3], 0),
        ("roughness", (0.4,) * 3, (0.9,) * 3, 0),
        ("alpha", (1.0,) * 3, (0.0,) * 3, 1),
    ):
        texels, middle = in_middles(found, (0, (field,)), cube.item)
        factor = np.clip(middle[:, [axis]], 0.0, 1.0)
        wanted = (1.0 - factor) * np.array(first) + factor * np.array(second)
        # Texels between the negative and the positive half are mixed
        kept = np.abs(middle[:, axis]) > 0.2
        np.testing.assert_allclose(texels[kept], wanted[kept], atol=BESIDE)
        assert np.count_nonzero(kept) > 6
