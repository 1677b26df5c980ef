"""Cycles' own mirror ball: the axes of the maps that are laid out as seen from the front."""

import bpy
import numpy as np
from rsibr.rsibr_addon.core.conventions import texel_centres
from rsibr.rsibr_addon.core.maps.representation import representation
from rsibr.rsibr_addon.host.worlds import sample_world


def test_a_mirror_ball_is_the_same_in_cycles() -> None:
    ball, latlong = representation("mirror_ball"), representation("equirect")
    size = 128
    directions = ball.direction_from_uv(texel_centres(size, size), np.array(0))
    image = bpy.data.images.new("ball", size, size, alpha=False, float_buffer=True)
    image.colorspace_settings.name = "Non-Color"
    pixels = np.concatenate([1.5 + directions, np.ones((size, size, 1))], axis=-1)
    image.pixels.foreach_set(pixels.astype(np.float32).ravel())
    world = bpy.data.worlds.new("ball")
    tree = world.node_tree
    tree.nodes.clear()
    texture = tree.nodes.new("ShaderNodeTexEnvironment")
    texture.image, texture.projection = image, "MIRROR_BALL"
    background, output = tree.nodes.new("ShaderNodeBackground"), tree.nodes.new("ShaderNodeOutputWorld")
    tree.links.new(texture.outputs["Color"], background.inputs["Color"])
    tree.links.new(background.outputs["Background"], output.inputs["Surface"])
    seen = sample_world(world, 16).radiance
    expected = latlong.texel_directions(32)[0]
    # Around the singularity, straight ahead, a texel of the ball is ten degrees long
    clear = expected[..., 1] < 0.9
    # A latlong texel is 0.2 across, and its mean is at most a quarter of that from its centre's value
    np.testing.assert_allclose(seen[clear] - 1.5, expected[clear], atol=0.05)
