"""Worlds for renders."""

from pathlib import Path

import bpy
import numpy as np


def add_sky(scene: bpy.types.Scene, folder: Path) -> None:
    """Have the world be a picture, turned."""
    rows, columns = np.mgrid[:16, :32]
    waves = [np.sin(columns * np.pi / 16 + phase) * np.sin(rows * np.pi / 8) for phase in (0, 2, 4, 6)]
    image = bpy.data.images.new("sky", 32, 16, float_buffer=True)
    image.pixels.foreach_set((1.0 + 0.9 * np.stack(waves, axis=-1)).ravel().astype(np.float32))
    image.filepath_raw, image.file_format = str(folder / "sky.exr"), "OPEN_EXR"
    image.save()
    tree = scene.world.node_tree
    texture, mapping, place = (
        tree.nodes.new(f"ShaderNode{name}") for name in ("TexEnvironment", "Mapping", "TexCoord")
    )
    texture.image, mapping.vector_type = bpy.data.images.load(str(folder / "sky.exr")), "POINT"
    mapping.inputs["Rotation"].default_value = (0.3, 0.2, 1.0)
    tree.links.new(place.outputs["Generated"], mapping.inputs["Vector"])
    tree.links.new(mapping.outputs["Vector"], texture.inputs["Vector"])
    tree.links.new(texture.outputs["Color"], tree.nodes["Background"].inputs["Color"])
    tree.nodes["Background"].inputs["Strength"].default_value = 1.5
