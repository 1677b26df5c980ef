"""The goniophotometer against node trees whose reflectance is known in closed form."""

from collections.abc import Callable

import bpy
import numpy as np
import pytest
from rsibr.rsibr_addon.core.brdf.fresnel import Index, Schlick
from rsibr.rsibr_addon.core.brdf.ggx import Ggx
from rsibr.rsibr_addon.core.brdf.measured_material import measured_pairs
from rsibr.rsibr_addon.core.brdf.metals import METALS
from rsibr.rsibr_addon.host.goniophotometer import LEAST_COSINE, measure
from rsibr.rsibr_addon.host.scenes import temporary_scene

pytestmark = pytest.mark.needs("cycles")

SLICES = (0, 20, 43)
"""Angles of 1, 41 and 87 degrees between half vector and light."""

Tree = bpy.types.NodeTree
Build = Callable[[Tree], bpy.types.NodeSocket]


def pairs(angle: int) -> tuple[np.ndarray, np.ndarray]:
    light_dir, view_dir, wanted = (array[:, angle] for array in measured_pairs(LEAST_COSINE))
    return light_dir[wanted], view_dir[wanted]


def measured(build: Build, angle: int) -> tuple[np.ndarray, np.ndarray]:
    with temporary_scene() as scene:
        material = bpy.data.materials.new("measured")
        tree = material.node_tree
        tree.nodes.clear()
        output = tree.nodes.new("ShaderNodeOutputMaterial")
        tree.links.new(build(tree), output.inputs["Surface"])
        return measure(scene, material, *pairs(angle))


def diffuse(tree: Tree) -> bpy.types.NodeSocket:
    node = tree.nodes.new("ShaderNodeBsdfDiffuse")
    node.inputs["Color"].default_value = (0.8, 0.4, 0.1, 1.0)
    return node.outputs[0]


def glossy(alpha: float) -> Build:
    def build(tree: Tree) -> bpy.types.NodeSocket:
        node = tree.nodes.new("ShaderNodeBsdfAnisotropic")
        node.distribution = "GGX"
        node.inputs["Color"].default_value = (1.0, 1.0, 1.0, 1.0)
        node.inputs["Roughness"].default_value = alpha**0.5
        return node.outputs[0]

    return build


def copper(tree: Tree) -> bpy.types.NodeSocket:
    node = tree.nodes.new("ShaderNodeBsdfMetallic")
    node.distribution, node.fresnel_type = "GGX", "PHYSICAL_CONDUCTOR"
    node.inputs["IOR"].default_value = METALS["copper"].eta
    node.inputs["Extinction"].default_value = METALS["copper"].k
    node.inputs["Roughness"].default_value = 0.3**0.5
    return node.outputs[0]


def mixed(tree: Tree, first: bpy.types.NodeSocket, second: bpy.types.NodeSocket) -> bpy.types.Node:
    mix = tree.nodes.new("ShaderNodeMixShader")
    tree.links.new(first, mix.inputs[1])
    tree.links.new(second, mix.inputs[2])
    return mix


def white_ggx(alpha: float) -> Ggx:
    return Ggx(alpha=alpha, fresnel=Schlick(f0=1.0, f90=1.0))


@pytest.mark.parametrize("angle", SLICES)
def test_lambert_is_its_colour_over_pi(angle: int) -> None:
    before = {repr(item) for item in bpy.data.all_ids}
    by_diffuse, by_glossy = measured(diffuse, angle)
    assert {repr(item) for item in bpy.data.all_ids} == before
    # A tile of cosine c has a depth of its width / c, known to 1e-7 of the frame, 70 widths: 1e-5 in the
    # slope, and at c = 0.001, next to the light's horizon, some 1e-5 / c of the light's cosine.
    light_dir, view_dir = pairs(angle)
    tolerance = 3e-6 / np.minimum(light_dir[:, 2:], view_dir[:, 2:])
    expected = np.array([0.8, 0.4, 0.1]) / np.pi
    assert np.all(np.abs(by_diffuse / expected - 1.0) < 1e-5 + tolerance)
    np.testing.assert_array_equal(by_glossy, 0.0)


@pytest.mark.parametrize("angle", SLICES)
@pytest.mark.parametrize(("alpha", "tolerance"), [(0.3, 1e-3), (0.05, 2e-3), (0.01, 2e-2)])
def test_glossy_is_ggx(angle: int, alpha: float, tolerance: float) -> None:
    by_diffuse, by_glossy = measured(glossy(alpha), angle)
    np.testing.assert_array_equal(by_diffuse, 0.0)
    # Cycles' single precision knows the half vector to 1e-7, of alpha^2 = 1e-4 at worst: 0.5 % was seen.
    np.testing.assert_allclose(by_glossy, white_ggx(alpha)(*pairs(angle)), rtol=tolerance)


@pytest.mark.parametrize("angle", SLICES)
def test_copper_has_the_fresnel_of_its_index(angle: int) -> None:
    _, by_glossy = measured(copper, angle)
    expected = Ggx(alpha=0.3, fresnel=METALS["copper"])(*pairs(angle))
    np.testing.assert_allclose(by_glossy, expected, rtol=1e-3)


def test_parts_of_a_mix_come_apart() -> None:
    def build(tree: Tree) -> bpy.types.NodeSocket:
        mix = mixed(tree, diffuse(tree), glossy(0.2)(tree))
        mix.inputs[0].default_value = 0.3
        return mix.outputs[0]

    by_diffuse, by_glossy = measured(build, 20)
    expected = 0.7 * np.array([0.8, 0.4, 0.1]) / np.pi
    np.testing.assert_allclose(by_diffuse, np.broadcast_to(expected, by_diffuse.shape), rtol=3e-3)
    np.testing.assert_allclose(by_glossy, 0.3 * white_ggx(0.2)(*pairs(20)), rtol=3e-3)


def test_a_mix_by_the_angle_of_view_knows_light_from_view() -> None:
    def build(tree: Tree) -> bpy.types.NodeSocket:
        fresnel = tree.nodes.new("ShaderNodeFresnel")
        fresnel.inputs["IOR"].default_value = 1.5
        black = tree.nodes.new("ShaderNodeBsdfDiffuse")
        black.inputs["Color"].default_value = (0.0, 0.0, 0.0, 1.0)
        mix = mixed(tree, black.outputs[0], diffuse(tree))
        tree.links.new(fresnel.outputs[0], mix.inputs[0])
        return mix.outputs[0]

    by_diffuse, _ = measured(build, 20)
    _, view_dir = pairs(20)
    expected = Index(eta=1.5)(view_dir[:, 2]) * np.array([0.8, 0.4, 0.1]) / np.pi
    np.testing.assert_allclose(by_diffuse, expected, rtol=1e-2)  # Fresnel's slope at grazing is 10


def test_light_of_its_own_and_through_it_does_not_count() -> None:
    def build(tree: Tree) -> bpy.types.NodeSocket:
        glow = tree.nodes.new("ShaderNodeEmission")
        glow.inputs["Strength"].default_value = 50.0
        through = mixed(tree, tree.nodes.new("ShaderNodeBsdfTransparent").outputs[0], diffuse(tree))
        add = tree.nodes.new("ShaderNodeAddShader")
        tree.links.new(glow.outputs[0], add.inputs[0])
        tree.links.new(through.outputs[0], add.inputs[1])
        return add.outputs[0]

    by_diffuse, by_glossy = measured(build, 20)
    expected = 0.5 * np.array([0.8, 0.4, 0.1]) / np.pi
    np.testing.assert_allclose(by_diffuse, np.broadcast_to(expected, by_diffuse.shape), rtol=3e-3)
    np.testing.assert_array_equal(by_glossy, 0.0)
