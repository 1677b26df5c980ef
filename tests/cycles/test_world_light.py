"""A world's strength and rotation, read from its nodes, against what Cycles sees of it."""

import bpy
import numpy as np
import pytest
from rsibr.rsibr_addon.core.conventions import texel_centres
from rsibr.rsibr_addon.core.environment import Environment
from rsibr.rsibr_addon.core.errors import SceneError
from rsibr.rsibr_addon.core.maps import equirect
from rsibr.rsibr_addon.host.world_light import world_light
from rsibr.rsibr_addon.host.worlds import light_with, sample_world
from rsibr.tests.mirror_capture import environment, radiance_from


def lit_world(kind: str | None) -> bpy.types.World:
    """A world with the environment of `mirror_capture`, turned by a Mapping of that kind."""
    scene = bpy.context.scene
    light: Environment = environment(64)
    light_with(scene, light)
    tree = scene.world.node_tree
    background = next(node for node in tree.nodes if node.type == "BACKGROUND")
    background.inputs["Strength"].default_value = 1.75
    if kind:
        texture = next(node for node in tree.nodes if node.type == "TEX_ENVIRONMENT")
        mapping = tree.nodes.new("ShaderNodeMapping")
        mapping.vector_type = kind
        mapping.inputs["Rotation"].default_value = (0.3, -0.5, 2.0)
        coordinates = tree.nodes.new("ShaderNodeTexCoord")
        tree.links.new(coordinates.outputs["Generated"], mapping.inputs["Vector"])
        tree.links.new(mapping.outputs["Vector"], texture.inputs["Vector"])
    return scene.world


@pytest.mark.parametrize("kind", [None, "POINT", "TEXTURE", "VECTOR", "NORMAL"])
def test_it_is_what_cycles_sees(kind: str | None) -> None:
    world = lit_world(kind)
    seen = sample_world(world, 16).radiance
    light = world_light(world)
    # Texels are means; of a function that changes by at most 1.7 a radian, finely sampled here
    fine = equirect.direction_from_uv(texel_centres(32 * 4, 16 * 4))
    expected = light.strength * radiance_from(fine @ light.turn.T)
    expected = expected.reshape(16, 4, 32, 4, 3).mean(axis=(1, 3))
    # Cycles' noise of 0.01, and the map's own texels: h^2 / 8 of second derivatives up to 8 at 0.05 radians
    assert np.abs(seen - expected).max() < 0.02 * expected.max()


def test_a_bare_world_is_its_environment_and_stays_as_it_is() -> None:
    world = lit_world("POINT")
    before = world_light(world)
    seen = sample_world(world, 16, bare=True).radiance
    fine = equirect.direction_from_uv(texel_centres(32 * 4, 16 * 4))
    expected = radiance_from(fine).reshape(16, 4, 32, 4, 3).mean(axis=(1, 3))
    # As above
    assert np.abs(seen - expected).max() < 0.02 * expected.max()
    after = world_light(world)
    assert before is not None
    assert after is not None
    assert after.strength == before.strength == 1.75
    np.testing.assert_array_equal(after.turn, before.turn)
    world.node_tree.nodes.clear()
    with pytest.raises(SceneError, match="is more than a Background and an Environment Texture"):
        sample_world(world, 16, bare=True)


@pytest.mark.parametrize("change", ["location", "scale", "strength", "colour", "empty"])
def test_what_cannot_be_followed_is_not(change: str) -> None:
    world = lit_world("POINT")
    tree = world.node_tree
    mapping = next(node for node in tree.nodes if node.type == "MAPPING")
    background = next(node for node in tree.nodes if node.type == "BACKGROUND")
    assert world_light(world) is not None
    match change:
        case "location":
            mapping.inputs["Location"].default_value[2] = 0.1
        case "scale":
            mapping.inputs["Scale"].default_value[0] = 2.0
        case "strength":
            value = tree.nodes.new("ShaderNodeValue")
            tree.links.new(value.outputs["Value"], background.inputs["Strength"])
        case "colour":
            tree.links.remove(background.inputs["Color"].links[0])
        case "empty":
            tree.nodes.clear()
    assert world_light(world) is None
    assert world_light(None) is None
