"""Interface of the GPU program of lobe stacks; its sources are in `gpu_shaders`."""

import gpu

from ..shaders import build, kept_until_exit, mesh_interface

_STACK_BLOCK = (
    "struct Stack { float layout_number; float lobes; float taps; float slices; "
    "float antialiased; float unused_0; float unused_1; float unused_2; };"
)


@kept_until_exit
def lobe_stack_shader() -> gpu.types.GPUShader:
    """Draws a mesh from a lobe stack.

    Raises
    ------
    DeviceError
        The driver refuses the program.
    """
    info = mesh_interface(_STACK_BLOCK)
    info.uniform_buf(1, "Stack", "stack")
    info.sampler(0, "FLOAT_2D", "elevations")
    info.sampler(1, "FLOAT_3D", "maps")
    return build("lobe_stack", info, "mesh_vert.glsl", "lobe_stack_frag.glsl")
