"""Environments as worlds and back: the right way up and round, with all their light."""

import bpy
import numpy as np
import pytest
from rsibr.rsibr_addon.core.environment import Environment
from rsibr.rsibr_addon.core.errors import RsibrWarning, SceneError
from rsibr.rsibr_addon.host.installation import studio_environments
from rsibr.rsibr_addon.host.worlds import light_with, sample_world, world_of
from rsibr.tests.open_file import open_file_state

HEIGHT = 16


@pytest.fixture
def environment() -> Environment:
    """Every texel differs from every other."""
    radiance = np.random.default_rng(3).random((HEIGHT, 2 * HEIGHT, 3), dtype=np.float32)
    return Environment(radiance, "noise")


def seen(environment: Environment) -> np.ndarray:
    """What sampling at the same size must see, shape (HEIGHT - 2, 2 * HEIGHT, 3).

    Linear interpolation between texel centres, averaged over a texel, takes 1/8 from each
    neighbour. Without the polar rows, beyond which Blender finds no neighbour.
    """
    across = environment.radiance
    across = 0.75 * across + 0.125 * (np.roll(across, 1, axis=1) + np.roll(across, -1, axis=1))
    return (0.75 * across + 0.125 * (np.roll(across, 1, axis=0) + np.roll(across, -1, axis=0)))[1:-1]


def group_of_light_path(nodes: bpy.types.Nodes) -> bpy.types.NodeSocket:
    """Add a group whose output tells the camera's rays from others."""
    tree = bpy.data.node_groups.new("group", "ShaderNodeTree")
    tree.interface.new_socket("Is Camera Ray", in_out="OUTPUT", socket_type="NodeSocketFloat")
    path, end = tree.nodes.new("ShaderNodeLightPath"), tree.nodes.new("NodeGroupOutput")
    tree.links.new(path.outputs["Is Camera Ray"], end.inputs["Is Camera Ray"])
    group = nodes.new("ShaderNodeGroup")
    group.node_tree = tree
    return group.outputs["Is Camera Ray"]


def lit(environment: Environment) -> bpy.types.World:
    scene = bpy.context.scene
    light_with(scene, environment)
    return scene.world


def test_a_world_made_of_an_environment_is_seen_as_that(environment: Environment) -> None:
    sampled = sample_world(lit(environment), HEIGHT)
    # The relative error of a texel is at most 1 %, as far as Cycles can tell after 16 samples of
    # values that vary by up to 1: five of 16 stratified samples' standard deviations,
    # .25 / sqrt(12) / 4 = .018, are not reached, because what is uncertain is sampled again.
    np.testing.assert_allclose(sampled.radiance[1:-1], seen(environment), atol=0.025)


def test_a_sun_of_one_texel_keeps_its_place_and_its_light() -> None:
    radiance = np.zeros((HEIGHT, 2 * HEIGHT, 3), dtype=np.float32)
    radiance[11, 5] = (1e4, 2e4, 5e3)
    sun = Environment(radiance, "sun")
    sampled = sample_world(lit(sun), HEIGHT).radiance
    assert np.unravel_index(np.argmax(sampled[..., 1]), sampled.shape[:2]) == (11, 5)
    # As above, relative to the peak.
    np.testing.assert_allclose(sampled[1:-1], seen(sun), atol=0.025 * radiance.max())
    np.testing.assert_allclose(sampled.sum(axis=(0, 1)), radiance[11, 5], rtol=0.03)


def test_the_whole_node_tree_counts(environment: Environment) -> None:
    world = lit(environment)
    nodes, links = world.node_tree.nodes, world.node_tree.links
    texture = next(node for node in nodes if node.bl_idname == "ShaderNodeTexEnvironment")
    background = next(node for node in nodes if node.bl_idname == "ShaderNodeBackground")
    background.inputs["Strength"].default_value = 3.0
    mapping = nodes.new("ShaderNodeMapping")
    # The lookup turns from +X to +Y, a quarter of the map to the left (u falls with the azimuth).
    mapping.inputs["Rotation"].default_value = (0.0, 0.0, np.pi / 2.0)
    links.new(nodes.new("ShaderNodeTexCoord").outputs["Generated"], mapping.inputs["Vector"])
    links.new(mapping.outputs["Vector"], texture.inputs["Vector"])
    sampled = sample_world(world, HEIGHT).radiance
    expected = 3.0 * np.roll(seen(environment), HEIGHT // 2, axis=1)
    np.testing.assert_allclose(sampled[1:-1], expected, atol=3.0 * 0.025)


@pytest.mark.parametrize("grouped", [False, True])
def test_what_lights_counts_not_what_the_camera_is_shown(environment: Environment, grouped: bool) -> None:
    world = lit(environment)
    nodes, links = world.node_tree.nodes, world.node_tree.links
    light = next(node for node in nodes if node.bl_idname == "ShaderNodeBackground")
    backdrop = nodes.new("ShaderNodeBackground")
    backdrop.inputs["Color"].default_value = (0.0, 1.0, 0.0, 1.0)
    mix = nodes.new("ShaderNodeMixShader")
    if grouped:
        is_camera_ray = group_of_light_path(nodes)
    else:
        is_camera_ray = nodes.new("ShaderNodeLightPath").outputs["Is Camera Ray"]
    links.new(is_camera_ray, mix.inputs["Factor"])
    links.new(light.outputs[0], mix.inputs[1])
    links.new(backdrop.outputs[0], mix.inputs[2])
    links.new(mix.outputs[0], world.node_tree.get_output_node("ALL").inputs["Surface"])
    sampled = sample_world(world, HEIGHT)
    np.testing.assert_allclose(sampled.radiance[1:-1], seen(environment), atol=0.025)


def test_a_file_may_work_in_other_colours(environment: Environment) -> None:
    bpy.ops.wm.set_working_color_space(working_space="ACEScg")
    sampled = sample_world(lit(environment), HEIGHT)
    np.testing.assert_allclose(sampled.radiance[1:-1], seen(environment), atol=0.025)


def test_negative_light_is_taken_as_none(environment: Environment) -> None:
    dark = Environment(environment.radiance - np.float32(2.0), "dark")
    with pytest.warns(RsibrWarning, match=f"dark holds {HEIGHT * 2 * HEIGHT * 3} negative values"):
        sampled = sample_world(lit(dark), HEIGHT)
    assert not np.any(sampled.radiance)


def test_sampling_leaves_the_file_alone(environment: Environment) -> None:
    world = lit(environment)
    before = open_file_state()
    first = sample_world(world, HEIGHT)
    assert open_file_state() == before
    assert sample_world(world, HEIGHT).sha256 == first.sha256
    assert first.name == world.name


def test_a_scene_without_a_world_is_refused() -> None:
    scene = bpy.context.scene
    assert world_of(scene) == bpy.data.worlds["World"]
    scene.world = None
    with pytest.raises(SceneError, match="Scene Scene has no world: add one"):
        world_of(scene)


def test_blenders_own_environments_are_known_by_name() -> None:
    found = studio_environments()
    assert "forest" in found
    assert len(found) == 8
    assert all(path.is_file() for path in found.values())
