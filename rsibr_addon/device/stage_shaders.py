"""Interfaces of the GPU programs of viewports; their sources are in `gpu_shaders`.

Each raises a DeviceError where the driver refuses the program.
"""

import gpu

from .passes import screen_interface
from .shaders import build, kept_until_exit, mesh_interface


@kept_until_exit
def occluder_shader() -> gpu.types.GPUShader:
    """Draws a mesh without coverage that hides surfaces behind it."""
    return build("viewport_occluder", mesh_interface(""), "mesh_vert.glsl", "viewport_occluder_frag.glsl")


@kept_until_exit
def composite_shader() -> gpu.types.GPUShader:
    """Brings a frame's previews to the display."""
    info = screen_interface()
    info.push_constant("FLOAT", "scale")
    info.push_constant("FLOAT", "left")
    info.push_constant("FLOAT", "right")
    info.push_constant("FLOAT", "line")
    info.push_constant("FLOAT", "ui_scale")
    info.push_constant("FLOAT", "least")
    info.push_constant("FLOAT", "most")
    info.push_constant("FLOAT", "as_radiance")
    info.push_constant("FLOAT", "full")
    info.push_constant("FLOAT", "others_scale")
    info.sampler(0, "FLOAT_2D", "previews")
    info.sampler(1, "DEPTH_2D", "depths")
    info.sampler(2, "FLOAT_3D", "display")
    info.sampler(3, "FLOAT_2D", "others")
    info.fragment_out(0, "VEC4", "colour")
    info.depth_write("ANY")
    return build("viewport_composite", info, "screen_vert.glsl", "viewport_composite_frag.glsl")
