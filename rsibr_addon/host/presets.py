"""Materials that come with us, made of nodes."""

import bpy
import numpy as np

from ..core.brdf.cycles_presets import PRESETS, Value
from .working_space import working_from_rec709


def build_preset(name: str) -> bpy.types.Material:
    """Make one of `PRESETS` a material of the open file."""
    preset = PRESETS[name]
    material = bpy.data.materials.new(name)
    tree = material.node_tree
    tree.nodes.clear()
    bsdf = tree.nodes.new(preset.node)
    for option, choice in preset.options.items():
        setattr(bsdf, option, choice)
    for input_name, value in preset.inputs.items():
        socket = bsdf.inputs[input_name]
        socket.default_value = _in_working_space(value) if socket.type == "RGBA" else value
    output = tree.nodes.new("ShaderNodeOutputMaterial")
    tree.links.new(bsdf.outputs["BSDF"], output.inputs["Surface"])
    return material


def _in_working_space(colour: Value) -> Value:
    *rgb, alpha = np.atleast_1d(colour)
    return (*working_from_rec709(np.array(rgb)), alpha)
