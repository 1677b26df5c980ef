"""Objects with materials of their own, as an artist would make them: Blender's meshes, nodes and images."""

from collections.abc import Callable
from typing import Any

import bpy
import made_textures as made
import numpy as np
from rsibr.rsibr_addon.core.conventions import Array
from rsibr.rsibr_addon.core.light.transfer_curve import srgb_from_linear

GOLD, RED = (1.0, 0.75, 0.3), (0.5, 0.05, 0.03)


class Material:
    """A Principled material in the making.

    Parameters
    ----------
    name : str
    inputs : dict
        Name of an input of the node -> a number, a colour, or texels of shape (height, width[, 3 or 4]).
    repeat : float
        How often the textures lie across the UV map.
    """

    def __init__(self, name: str, inputs: dict[str, Any], repeat: float = 1.0) -> None:
        self.data = bpy.data.materials.new(name)
        self._nodes, self._links = self.data.node_tree.nodes, self.data.node_tree.links
        (self._principled,) = (each for each in self._nodes if each.type == "BSDF_PRINCIPLED")
        self._place = self._nodes.new("ShaderNodeMapping")
        self._place.inputs["Scale"].default_value = (repeat, repeat, 1.0)
        self._links.new(self._nodes.new("ShaderNodeTexCoord").outputs["UV"], self._place.inputs["Vector"])
        for socket, value in inputs.items():
            if np.ndim(value) < 2:
                given = (*value, 1.0) if np.ndim(value) else value
                self._principled.inputs[socket].default_value = given
            else:
                node = self._image(socket, np.asarray(value), is_color=np.ndim(value) == 3)
                self._links.new(node.outputs["Color"], self._principled.inputs[socket])
                if np.shape(value)[-1] == 4:
                    self._links.new(node.outputs["Alpha"], self._principled.inputs["Alpha"])

    def mapped(self, height: Array) -> "Material":
        """Give it the normal map of a height in texels."""
        node = self._nodes.new("ShaderNodeNormalMap")
        self._links.new(self._image("Normal", made.normals(height)).outputs["Color"], node.inputs["Color"])
        self._links.new(node.outputs["Normal"], self._principled.inputs["Normal"])
        return self

    def bumped(self, height: Array, distance: float) -> "Material":
        """Give it a bump of a height from 0 to 1."""
        node = self._nodes.new("ShaderNodeBump")
        node.inputs["Strength"].default_value, node.inputs["Distance"].default_value = 1.0, distance
        self._links.new(self._image("Height", height).outputs["Color"], node.inputs["Height"])
        self._links.new(node.outputs["Normal"], self._principled.inputs["Normal"])
        return self

    def _image(self, name: str, texels: Array, is_color: bool = False) -> bpy.types.Node:
        height, width = texels.shape[:2]
        image = bpy.data.images.new(
            f"{self.data.name} {name}", width, height, alpha=True, is_data=not is_color
        )
        rgba = np.ones((height, width, 4), np.float32)
        values = np.atleast_3d(texels)
        rgba[..., :3] = srgb_from_linear(values[..., :3]) if is_color else values[..., :3]
        if values.shape[-1] == 4:
            image.alpha_mode = "CHANNEL_PACKED"
            rgba[..., 3] = values[..., 3]
        image.pixels.foreach_set(rgba.ravel())
        image.pack()
        node = self._nodes.new("ShaderNodeTexImage")
        node.image = image
        self._links.new(self._place.outputs["Vector"], node.inputs["Vector"])
        return node


def _grid(name: str, at: Callable[[Array, Array], Array], across: int, along: int) -> bpy.types.Object:
    """A smooth surface of points at (u, v) from 0 to 1, laid out by these."""
    u, v = np.meshgrid(np.linspace(0.0, 1.0, across + 1), np.linspace(0.0, 1.0, along + 1))
    corner = np.arange(along)[:, None] * (across + 1) + np.arange(across)
    faces = np.stack([corner, corner + 1, corner + across + 2, corner + across + 1], axis=-1).reshape(-1, 4)
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(at(u.ravel(), v.ravel()).tolist(), [], faces.tolist())
    uv = np.stack([u.ravel(), v.ravel()], axis=-1)[faces.ravel()]
    mesh.uv_layers.new(name="UVMap").uv.foreach_set("vector", uv.astype(np.float32).ravel())
    mesh.shade_smooth()
    return _added(bpy.data.objects.new(name, mesh))


def _added(item: bpy.types.Object) -> bpy.types.Object:
    bpy.context.scene.collection.objects.link(item)
    return item


def _made_of(item: bpy.types.Object, *materials: Material) -> bpy.types.Object:
    for each in materials:
        item.data.materials.append(each.data)
    return item


def _sphere(name: str) -> bpy.types.Object:
    bpy.ops.mesh.primitive_uv_sphere_add(segments=192, ring_count=96)
    item = bpy.context.object
    item.name = name
    item.data.shade_smooth()
    return item


def wall() -> bpy.types.Object:
    """A wall of bricks that bends: color, roughness and normal map."""

    def at(u: Array, v: Array) -> Array:
        return np.stack([1.6 * (u - 0.5), 0.25 * np.cos(2.0 * np.pi * u), 1.6 * (v - 0.5)], axis=-1)

    brick = made.bricks()
    material = Material("Bricks", {"Base Color": brick["color"], "Roughness": brick["roughness"]})
    return _made_of(_grid("Wall", at, 96, 8), material.mapped(brick["height"]))


def ring() -> bpy.types.Object:
    """A ring of rusty steel: color, metallic and roughness."""
    bpy.ops.mesh.primitive_torus_add(
        major_segments=160, minor_segments=80, major_radius=0.62, minor_radius=0.33, rotation=(0.9, 0.3, 0.0)
    )
    item = bpy.context.object
    item.data.shade_smooth()
    rust = made.rust()
    names = {"Base Color": "color", "Metallic": "metallic", "Roughness": "roughness"}
    return _made_of(item, Material("Rust", {each: rust[name] for each, name in names.items()}, 2.0))


def ball() -> bpy.types.Object:
    """A painted ball whose coat has worn off in places."""
    paint = made.paint()
    inputs = {
        "Base Color": paint["color"],
        "Roughness": 0.6,
        "Coat Weight": paint["coat"],
        "Coat Roughness": 0.08,
    }
    return _made_of(_sphere("Ball"), Material("Paint", inputs, 2.0))


def cushion() -> bpy.types.Object:
    """A leather cushion: color and bump."""

    def at(u: Array, v: Array) -> Array:
        longitude, latitude = 2.0 * np.pi * u, np.pi * (v - 0.5)
        flat, tall = np.sign(np.cos(latitude)) * np.abs(np.cos(latitude)) ** 0.5, np.sin(latitude)
        x, y = (np.sign(each) * np.abs(each) ** 0.6 for each in (np.cos(longitude), np.sin(longitude)))
        return np.stack([0.8 * flat * x, 0.8 * flat * y, 0.45 * tall], axis=-1)

    hide = made.leather()
    material = Material("Leather", {"Base Color": hide["color"], "Roughness": 0.45}, 2.0)
    item = _made_of(_grid("Cushion", at, 128, 64), material.bumped(hide["height"], 0.005))
    item.rotation_euler = (0.5, 0.3, 0.4)
    return item


def suzanne() -> bpy.types.Object:
    """Suzanne in a checker of gold and plastic."""
    bpy.ops.mesh.primitive_monkey_add(size=1.5)
    item = bpy.context.object
    smooth = item.modifiers.new("Smooth", "SUBSURF")
    smooth.levels = smooth.render_levels = 3
    item.data.shade_smooth()
    is_gold = made.checker(16)
    colors = made.mixed(is_gold, (0.05, 0.2, 0.3), GOLD)
    inputs = {"Base Color": colors, "Metallic": is_gold, "Roughness": 0.45 - 0.15 * is_gold}
    return _made_of(item, Material("Checker", inputs))


def leaf() -> bpy.types.Object:
    """A leaf that is cut out of its image by alpha, with a normal map."""

    def at(u: Array, v: Array) -> Array:
        lift = 0.3 * np.cos(1.5 * np.pi * (u - 0.5)) - 0.8 * (v - 0.5) ** 2
        return np.stack([1.8 * (u - 0.5), lift, 1.4 * (v - 0.5)], axis=-1)

    green = made.leaf()
    inputs = {"Base Color": np.dstack([green["color"], green["coverage"]]), "Roughness": 0.35}
    return _made_of(_grid("Leaf", at, 96, 64), Material("Leaf", inputs).mapped(green["height"]))


def vase() -> bpy.types.Object:
    """A vase of three slots: glazed clay, a band of gold, and a foot of rough wood."""

    def at(u: Array, v: Array) -> Array:
        radius = 0.28 + 0.3 * np.sin(np.pi * np.clip(0.1 + 1.05 * v, 0.0, 1.3)) ** 2
        return np.stack(
            [radius * np.cos(2.0 * np.pi * u), radius * np.sin(2.0 * np.pi * u), 1.7 * (v - 0.5)], axis=-1
        )

    glaze = made.mixed(made.above(made.noise(11, 5.0), 0.5, 0.1), (0.05, 0.25, 0.3), (0.6, 0.65, 0.5))
    grain = made.noise(12, 8.0)
    wood = made.mixed(grain, (0.12, 0.05, 0.02), (0.35, 0.18, 0.08))
    item = _made_of(
        _grid("Vase", at, 128, 96),
        Material("Glaze", {"Base Color": glaze, "Roughness": 0.55, "Coat Weight": 1.0}, 2.0),
        Material("Gold", {"Base Color": GOLD, "Metallic": 1.0, "Roughness": 0.25}),
        Material("Wood", {"Base Color": wood, "Roughness": 0.75}, 3.0),
    )
    row = np.arange(len(item.data.polygons)) // 128
    slots = np.where(row < 14, 2, np.where((row > 56) & (row < 68), 1, 0))
    item.data.polygons.foreach_set("material_index", slots.astype(np.int32))
    return item


def textured_sphere() -> bpy.types.Object:
    """A sphere of another color, roughness, metallic and normal everywhere: four images together."""
    color = np.dstack([made.noise(seed, 6.0) for seed in (21, 22, 23)])
    inputs = {
        "Base Color": color,
        "Roughness": 0.25 + 0.6 * made.noise(24, 5.0),
        "Metallic": made.above(made.noise(25, 4.0), 0.5, 0.1),
    }
    material = Material("Textured", inputs, 2.0).mapped(6.0 * made.noise(26, 8.0, 2.5))
    return _made_of(_sphere("Textured sphere"), material)


def coated_sphere() -> bpy.types.Object:
    """A sphere of coated plastic."""
    inputs = {"Base Color": RED, "Roughness": 0.5, "Coat Weight": 1.0, "Coat Roughness": 0.15}
    return _made_of(_sphere("Coated sphere"), Material("Coated plastic", inputs))


SHOWN = (wall, ring, ball, cushion, suzanne, leaf, vase)
SPHERES = (textured_sphere, coated_sphere)
