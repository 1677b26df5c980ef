"""One function of the shader library, run on the GPU over many arguments at once."""

from collections.abc import Sequence

import gpu
import numpy as np
from rsibr.rsibr_addon.device import buffers
from rsibr.rsibr_addon.device.context import ensure_context
from rsibr.rsibr_addon.device.shader_source import shader_source
from rsibr.rsibr_addon.device.shaders import kept_until_exit
from rsibr.rsibr_addon.device.textures import GpuTexture

WIDTH = 512

Samplers = dict[str, tuple[str, gpu.types.GPUTexture]]
"""Name in the shader -> its type in Blender's words, and the texture."""


def evaluate(
    library: str,
    code: str,
    arguments: Sequence[np.ndarray],
    results: int = 1,
    samplers: Samplers | None = None,
    defines: Sequence[str] = (),
) -> np.ndarray:
    """Run a statement for each row of its arguments.

    Parameters
    ----------
    library : str
        The file in gpu_shaders/lib that is included.
    code : str
        GLSL that reads the vec4 in_0, in_1, ... and writes to the vec4 result_0, result_1, ...
    arguments : sequence of ndarray, shape (n, up to 4), float32
    results : int
        How many results there are.
    samplers : dict, optional
        Textures that the statement knows by name.
    defines : sequence of str, optional
        Names that are defined.

    Returns
    -------
    ndarray, shape (n, results, 4), float64
    """
    ensure_context()
    samplers = samplers or {}
    count = len(arguments[0])
    rows = -(-count // WIDTH)
    packed = np.zeros(
        (len(arguments) + 1, rows * WIDTH, 4), np.float32
    )  # One layer more: never a single one.
    for layer, argument in zip(packed, arguments, strict=False):
        layer[:count, : argument.shape[1]] = argument
    table = GpuTexture("table", packed.reshape(-1, rows, WIDTH, 4)).whole()
    shader = _shader(library, code, len(arguments), results, samplers, defines)
    targets = tuple(gpu.types.GPUTexture((WIDTH, rows), format="RGBA32F") for _ in range(results))
    framebuffer = gpu.types.GPUFrameBuffer(color_slots=targets)
    corners = np.array([[-1.0, -1.0], [3.0, -1.0], [-1.0, 3.0]])
    screen = buffers.triangles(shader, {"position": corners}, np.array([[0, 1, 2]]))
    with framebuffer.bind():
        shader.bind()
        shader.uniform_sampler("arguments", table)
        for name, (_, texture) in samplers.items():
            shader.uniform_sampler(name, texture)
        screen.draw(shader)
        found = [framebuffer.read_color(0, 0, WIDTH, rows, 4, slot, "FLOAT") for slot in range(results)]
    return np.stack([np.array(values, np.float64).reshape(-1, 4)[:count] for values in found], axis=1)


def _shader(
    library: str, code: str, arguments: int, results: int, samplers: Samplers, defines: Sequence[str]
) -> gpu.types.GPUShader:
    info = gpu.types.GPUShaderCreateInfo()
    for name in defines:
        info.define(name)
    info.sampler(0, "FLOAT_2D_ARRAY", "arguments")
    for slot, (name, (kind, _)) in enumerate(samplers.items(), start=1):
        info.sampler(slot, kind, name)
    info.vertex_in(0, "VEC2", "position")
    varyings = gpu.types.GPUStageInterfaceInfo("rsibr_screen")
    varyings.smooth("VEC2", "map_uv")
    info.vertex_out(varyings)
    for slot in range(results):
        info.fragment_out(slot, "VEC4", f"result_{slot}")
    fetches = [
        f"vec4 in_{i} = texelFetch(arguments, ivec3(ivec2(gl_FragCoord.xy), {i}), 0);"
        for i in range(arguments)
    ]
    zeros = [f"result_{i} = vec4(0.0);" for i in range(results)]
    body = "\n".join([*fetches, *zeros, code])
    info.vertex_source(shader_source("screen_vert.glsl"))
    info.fragment_source(f"{shader_source(f'lib/{library}')}\nvoid main()\n{{\n{body}\n}}\n")
    program = gpu.shader.create_from_info(info)
    _programs().append(program)
    return program


@kept_until_exit
def _programs() -> list[gpu.types.GPUShader]:
    """All that were made: Blender goes back to the last one when it has filled an image's mips."""
    return []
