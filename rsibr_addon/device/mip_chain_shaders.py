"""The GPU program of mip chains: its interface; its sources stand in `gpu_shaders`."""

import gpu

from .shaders import build, kept_until_exit, mesh_interface

_LOOK_BLOCK = (
    "struct MipLook { mat4 irradiance_red; mat4 irradiance_green; mat4 irradiance_blue; "
    "vec4 f_lambda; vec4 k_d; float level; float clamped; float unused_0; float unused_1; };"
)


@kept_until_exit
def mip_chain_shader() -> gpu.types.GPUShader:
    """Draws a mesh from a mip chain.

    Raises
    ------
    DeviceError
        The driver refuses the program.
    """
    info = mesh_interface(_LOOK_BLOCK)
    info.uniform_buf(1, "MipLook", "look")
    info.sampler(0, "FLOAT_2D", "atlas")
    return build("mip_chain", info, "mesh_vert.glsl", "mip_chain_frag.glsl")
