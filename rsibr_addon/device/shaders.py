"""Interfaces of the GPU programs; their sources are in `gpu_shaders`.

Each raises a DeviceError where the driver refuses the program.
"""

import atexit
from collections.abc import Callable, Mapping, Sequence
from functools import cache, wraps
from threading import get_ident, main_thread
from typing import Any, ParamSpec

import gpu

from ..core.errors import DeviceError
from .passes import screen_interface
from .shader_source import shader_source

# Uniform blocks hold only vec4 and mat4, so that the layout is the same for every driver.
DRAW_STRUCT = "struct Draw { mat4 model; mat4 view; mat4 projection; mat4 turn; vec4 eye; vec4 strength; };"

G_BUFFER = tuple(f"g_buffer_{number}" for number in range(5))
"""Textures of what deferred shading needs of a sample, RGBA32F: see gpu_shaders/g_buffer_frag.glsl."""

Given = ParamSpec("Given")


def kept_until_exit(build: Callable[Given, gpu.types.GPUShader]) -> Callable[Given, gpu.types.GPUShader]:
    """Build a program on first use, one for all that is given, and free it before Blender's graphics end.

    A program that is freed after them ends the process with a segmentation fault. The values that are set of
    one belong to all threads, so renders, which have a thread of their own in a window, have programs of
    their own.
    """
    cached: Any = cache(lambda of_render, *given, **named: build(*given, **named))
    _kept.append(cached.cache_clear)

    @wraps(build)
    def program(*given: Given.args, **named: Given.kwargs) -> gpu.types.GPUShader:
        shader: gpu.types.GPUShader = cached(get_ident() != main_thread().ident, *given, **named)
        return shader

    return program


_kept: list[Callable[[], None]] = []


@atexit.register
def release_programs() -> None:
    """Free every program; programs that are needed again are built again."""
    for release in _kept:
        release()


@kept_until_exit
def g_buffer_shader() -> gpu.types.GPUShader:
    """Stores what deferred shading needs of a mesh's samples."""
    info = _surface_interface("")
    for slot, name in enumerate(G_BUFFER):
        info.fragment_out(slot, "VEC4", name)
    return build("g_buffer", info, "mesh_vert.glsl", "g_buffer_frag.glsl")


@kept_until_exit
def views_texel_shader() -> gpu.types.GPUShader:
    """Makes the destination maps of one view, `texel` mode."""
    varyings = gpu.types.GPUStageInterfaceInfo("rsibr_screen")
    varyings.smooth("VEC2", "map_uv")
    varyings.flat("VEC3", "view_dir")
    info = _destination_interface(varyings)
    return build("views_texel", info, "views_texel_vert.glsl", "views_texel_frag.glsl")


@kept_until_exit
def views_disk_shader() -> gpu.types.GPUShader:
    """Makes the destination maps of one view, `paper` mode, drawn on the tessellated disk."""
    varyings = gpu.types.GPUStageInterfaceInfo("rsibr_disk")
    for warp in ("normal", "mirror"):
        for source in range(3):
            varyings.smooth("VEC4", f"{warp}_seen_{source}")
    info = _destination_interface(varyings)
    return build("views_disk", info, "views_disk_vert.glsl", "views_disk_frag.glsl")


def mesh_interface(blocks: str) -> gpu.types.GPUShaderCreateInfo:
    """The interface that programs of meshes share: the block `draw` in slot 0, mesh_vert.glsl's varyings.

    Parameters
    ----------
    blocks : str
        The structs of the program's other uniform blocks.

    Returns
    -------
    GPUShaderCreateInfo
        To be completed with these blocks and with samplers, and built with mesh_vert.glsl.
    """
    info = _surface_interface(blocks)
    info.fragment_out(0, "VEC4", "radiance")
    return info


def _surface_interface(blocks: str) -> gpu.types.GPUShaderCreateInfo:
    """The same without what fragments write."""
    info = gpu.types.GPUShaderCreateInfo()
    # Once for all blocks: a second call would replace the first.
    info.typedef_source(DRAW_STRUCT + blocks)
    info.uniform_buf(0, "Draw", "draw")
    info.vertex_in(0, "VEC3", "position")
    info.vertex_in(1, "VEC3", "normal")
    varyings = gpu.types.GPUStageInterfaceInfo("rsibr_surface")
    varyings.smooth("VEC3", "world_position")
    varyings.smooth("VEC3", "world_normal")
    info.vertex_out(varyings)
    return info


class MeshProgram:
    """A program that draws meshes with NAME_frag.glsl, from one uniform block and textures.

    A deferred one shades the samples of a G-buffer instead, by the same source; that of what has inputs
    (`drawing.WithInputs`) takes them from gpu_shaders/lib/seen_samples_lib.glsl.

    Parameters
    ----------
    name : str
    block : str
        Type and name of the block, as "MipLook look".
    fields : str
        The block's fields.
    samplers : mapping of str to str
        Name of each texture in the order of slots -> its type.
    defines : sequence of str
        Names that are defined in it.
    """

    def __init__(
        self, name: str, block: str, fields: str, samplers: Mapping[str, str], defines: Sequence[str] = ()
    ) -> None:
        self.name, self.fields, self.samplers, self.defines = name, fields, samplers, defines
        self.__name__ = "_".join([name, *map(str.lower, defines), "shader"])
        self.block_type, self.block = block.split()
        self._built = kept_until_exit(self._build)

    @property
    def struct(self) -> str:
        """The block's type in GLSL."""
        return f"struct {self.block_type} {{ {self.fields} }};"

    def __call__(self, deferred: bool = False) -> gpu.types.GPUShader:
        """The program, built on first use.

        Parameters
        ----------
        deferred : bool
            Whether it shades a G-buffer, by screen_vert.glsl, in place of a mesh.

        Raises
        ------
        DeviceError
            The driver refuses it.
        """
        return self._built(deferred)

    def _build(self, deferred: bool) -> gpu.types.GPUShader:
        info = _deferred_interface(self.struct) if deferred else mesh_interface(self.struct)
        for name in self.defines:
            info.define(name)
        info.uniform_buf(1, self.block_type, self.block)
        stored = dict.fromkeys(G_BUFFER, "FLOAT_2D") if deferred else {}
        for slot, (sampler, sampler_type) in enumerate({**self.samplers, **stored}.items()):
            info.sampler(slot, sampler_type, sampler)
        vertex = "screen_vert.glsl" if deferred else "mesh_vert.glsl"
        return build(self.name, info, vertex, f"{self.name}_frag.glsl")


def _deferred_interface(blocks: str) -> gpu.types.GPUShaderCreateInfo:
    """The same as `mesh_interface` for what shades a G-buffer."""
    info = screen_interface()
    info.define("DEFERRED")
    info.typedef_source(DRAW_STRUCT + blocks)
    info.uniform_buf(0, "Draw", "draw")
    info.fragment_out(0, "VEC4", "radiance")
    return info


views_fragment_shader = MeshProgram(
    "views_fragment",
    "Mode mode",
    "float warping; float fading; float last_level; float antialiased;",
    {"albedo": "FLOAT_2D", "views": "FLOAT_2D_ARRAY", "sphere": "FLOAT_2D"},
)
"""Draws a mesh from radiance views, `fragment` mode."""

views_destination_shader = MeshProgram(
    "views_destination",
    "Mode mode",
    views_fragment_shader.fields,
    dict.fromkeys(("albedo", "by_normal", "by_mirror"), "FLOAT_2D"),
)
"""Draws a mesh from the destination maps of one view."""


def _destination_interface(varyings: gpu.types.GPUStageInterfaceInfo) -> gpu.types.GPUShaderCreateInfo:
    info = gpu.types.GPUShaderCreateInfo()
    info.typedef_source(DRAW_STRUCT + views_fragment_shader.struct)
    info.uniform_buf(0, "Draw", "draw")
    info.uniform_buf(1, "Mode", "mode")
    info.sampler(0, "FLOAT_2D", "albedo")
    info.sampler(1, "FLOAT_2D_ARRAY", "views")
    info.sampler(2, "FLOAT_2D", "sphere")
    varyings.flat("IVEC3", "sources")
    varyings.flat("VEC3", "weights")
    info.vertex_out(varyings)
    info.vertex_in(0, "VEC2", "position")
    info.fragment_out(0, "VEC4", "by_normal")
    info.fragment_out(1, "VEC4", "by_mirror")
    return info


def build(name: str, info: gpu.types.GPUShaderCreateInfo, vertex: str, fragment: str) -> gpu.types.GPUShader:
    """Build a program.

    Parameters
    ----------
    name : str
        For messages.
    info : GPUShaderCreateInfo
        Its interface.
    vertex, fragment : str
        Its sources, as `shader_source` takes them.

    Raises
    ------
    DeviceError
        The driver refuses it.
    """
    info.vertex_source(shader_source(vertex))
    info.fragment_source(shader_source(fragment))
    try:
        return gpu.shader.create_from_info(info)
    except Exception as error:  # Blender raises a bare Exception; the driver's log is on stderr.
        raise DeviceError(
            f"The graphics driver refused the shader {name} ({error}): update the driver."
        ) from error
