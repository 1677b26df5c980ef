"""What objects take from what lies behind them all: holes, and shadows on floors."""

import gpu
import numpy as np

from ..core.conventions import Array
from .buffers import KeptBlock
from .drawing import Draw, GpuMesh
from .floor_shadow import FloorArea
from .passes import blended, screen_interface, screen_triangle
from .shaders import MeshProgram, build, kept_until_exit, mesh_interface

caught_shadow_shader = MeshProgram(
    "caught_shadow",
    "Ground ground",
    "mat4 floor_from_world; vec4 area; vec4 irradiance;",
    {"shadow": "FLOAT_2D"},
)
"""Draws the share of its light that a floor loses."""


class CaughtShadow:
    """A floor's shadow.

    Parameters
    ----------
    floor_from_world : ndarray, shape (4, 4)
        See `floor_shadow`.
    area : FloorArea
    shadow : GPUTexture
        Irradiance that is taken, from `floor_shadow.floor_shadow`.
    irradiance : ndarray, shape (3,)
        That of the floor without shadows.
    """

    def __init__(
        self, floor_from_world: Array, area: FloorArea, shadow: gpu.types.GPUTexture, irradiance: Array
    ) -> None:
        self._fields = floor_from_world, np.append(area.middle, area.half_width), irradiance
        self._shadow, self._block = shadow, KeptBlock()

    def draw(self, mesh: GpuMesh, draw: Draw) -> None:
        """Draw the floor's mesh: the shares of light that it loses, and no coverage."""
        shader = caught_shadow_shader()
        shader.bind()
        shader.uniform_block("ground", self._block.filled(*self._fields))
        shader.uniform_sampler("shadow", self._shadow)
        mesh.draw(shader, draw)


def draw_hole(mesh: GpuMesh, draw: Draw) -> None:
    """Draw a surface that takes all light, and all coverage."""
    shader = hole_shader()
    shader.bind()
    mesh.draw(shader, draw)


def lay_matte(layer: gpu.types.GPUTexture, on_nothing: bool) -> None:
    """Take a layer's shares from the active frame buffer.

    Parameters
    ----------
    layer : GPUTexture
        Shares of light, and of coverage, that are taken, of the frame buffer's pixels.
    on_nothing : bool
        Whether the frame buffer is empty, and not filled by what lies behind.
    """
    shader = matte_layer_shader()
    shader.bind()
    shader.uniform_float("on_nothing", float(on_nothing))
    shader.uniform_sampler("layer", layer)
    with blended("ALPHA_PREMULT" if on_nothing else "MULTIPLY"):
        screen_triangle(shader).draw(shader)


@kept_until_exit
def hole_shader() -> gpu.types.GPUShader:
    """Draws a mesh that makes a hole."""
    return build("hole", mesh_interface(""), "mesh_vert.glsl", "hole_frag.glsl")


@kept_until_exit
def matte_layer_shader() -> gpu.types.GPUShader:
    """Takes shares from what is there."""
    info = screen_interface()
    info.push_constant("FLOAT", "on_nothing")
    info.sampler(0, "FLOAT_2D", "layer")
    info.fragment_out(0, "VEC4", "colour")
    return build("matte_layer", info, "screen_vert.glsl", "matte_layer_frag.glsl")
