"""The turn and strength that a world gives its environment, if its nodes do nothing else."""

from dataclasses import dataclass

import bpy
import numpy as np

from ..core.conventions import Array
from ..core.errors import SceneError


@dataclass(frozen=True)
class WorldLight:
    """The strength and turn of an environment in a world.

    Attributes
    ----------
    strength : float
        Factor of radiance.
    turn : ndarray, shape (3, 3)
        Rotation from a direction in the world to that in the environment.
    """

    strength: float
    turn: Array


AS_IT_IS = WorldLight(1.0, np.eye(3))


def world_light(world: bpy.types.World | None) -> WorldLight | None:
    """Read a world's strength and rotation.

    Returns
    -------
    WorldLight or None
        None unless the world is a Background of constant strength with an Environment Texture, which may have
        a Mapping that only rotates.
    """
    background, texture = _lights(world)
    if background is None or texture is None or background.inputs["Strength"].is_linked:
        return None
    strength = background.inputs["Strength"].default_value
    if not texture.inputs["Vector"].is_linked:
        return WorldLight(strength, np.eye(3))
    mapping = _before(texture, "Vector", "MAPPING")
    if mapping is None or not _only_rotates(mapping):
        return None
    rotation = np.array(mapping.inputs["Rotation"].default_value.to_matrix())
    return WorldLight(strength, rotation.T if mapping.vector_type == "TEXTURE" else rotation)


def environment_texture(world: bpy.types.World) -> bpy.types.Node:
    """The Environment Texture of a world of which `world_light` reads strength and rotation.

    Raises
    ------
    SceneError
        It is another one.
    """
    _, texture = _lights(world)
    if texture is None or world_light(world) is None:
        raise SceneError(
            f"World {world.name} is more than a Background and an Environment Texture with a Mapping that "
            f"rotates: bake it as it is."
        )
    return texture


def make_bare(world: bpy.types.World) -> None:
    """Leave a world its environment alone, without the strength and rotation that `world_light` reads.

    Raises
    ------
    SceneError
        See `environment_texture`.
    """
    texture = environment_texture(world)
    background, _ = _lights(world)
    assert background is not None
    background.inputs["Strength"].default_value = 1.0
    for link in texture.inputs["Vector"].links:
        world.node_tree.links.remove(link)


def follows_world(item: bpy.types.Object) -> bool:
    """Whether an object's map set is to be turned and scaled as the world is.

    A map set that was baked in the world with its strength and rotation holds them already, and live light
    shows them.
    """
    return item.rsibr.follow_world and not item.rsibr.live.on and not holds_world(item)


def holds_world(item: bpy.types.Object) -> bool:
    """Whether an object's map set was baked in the world as it was, with its strength and rotation."""
    if not item.is_property_set("rsibr_baked"):
        return False
    return bool(item.rsibr_baked.light == "WORLD" and not item.rsibr_baked.bare_world)


def has_environment(world: bpy.types.World | None) -> bool:
    """Whether a world has an Environment Texture."""
    return world is not None and any(node.type == "TEX_ENVIRONMENT" for node in world.node_tree.nodes)


def _lights(world: bpy.types.World | None) -> tuple[bpy.types.Node | None, bpy.types.Node | None]:
    """The Background that lights a world, and its Environment Texture, as far as there are such."""
    background = _before(world.node_tree.get_output_node("ALL") if world else None, "Surface", "BACKGROUND")
    return background, _before(background, "Color", "TEX_ENVIRONMENT")


def _before(node: bpy.types.Node | None, socket: str, kind: str) -> bpy.types.Node | None:
    """The node that a socket's value comes from, if it is of a kind."""
    links = node.inputs[socket].links if node else ()
    return links[0].from_node if links and links[0].from_node.type == kind else None


def _only_rotates(mapping: bpy.types.Node) -> bool:
    vector = mapping.inputs["Vector"]
    linked = [socket.name for socket in mapping.inputs if socket.is_linked]
    generated = vector.is_linked and vector.links[0].from_socket.name == "Generated"
    # Where the type of mapping has no location, its socket still exists, without effect.
    moved = mapping.vector_type in ("POINT", "TEXTURE") and any(mapping.inputs["Location"].default_value)
    scaled = any(size != 1.0 for size in mapping.inputs["Scale"].default_value)
    return linked == ["Vector"] and generated and not moved and not scaled
