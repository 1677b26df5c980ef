"""Interfaces of the GPU programs of changing light; their sources are in `gpu_shaders`.

Each raises a DeviceError where the driver refuses the program.
"""

import gpu

from ..passes import screen_interface
from ..shaders import build, kept_until_exit


@kept_until_exit
def face_shader() -> gpu.types.GPUShader:
    """Copies a render into the strip of faces."""
    return _build_pass("live_face", ("seen",), ("face",))


@kept_until_exit
def bordered_shader() -> gpu.types.GPUShader:
    """Copies a mip from a strip to the atlas."""
    return _build_pass("live_bordered", ("strip",), ("first_size", "mip"))


@kept_until_exit
def box_shader() -> gpu.types.GPUShader:
    """Halves a mip of the atlas into a strip, by means of two by two texels."""
    return _build_pass("live_halved", ("atlas",), ("first_size", "mip"))


@kept_until_exit
def tent_shader() -> gpu.types.GPUShader:
    """Halves a mip of the atlas into a strip, across the faces' borders."""
    return _build_pass("live_halved", ("atlas", "solid_angles"), ("first_size", "mip"), "TENT")


@kept_until_exit
def rows_shader() -> gpu.types.GPUShader:
    """Sums each row's share of the coefficients."""
    return _build_pass("live_rows", ("strip", "solid_angles"), ())


@kept_until_exit
def harmonics_shader() -> gpu.types.GPUShader:
    """Sums the rows' shares, and makes irradiance of radiance."""
    return _build_pass("live_harmonics", ("rows",), ())


@kept_until_exit
def mirror_shader() -> gpu.types.GPUShader:
    """Makes an octahedral map of six faces."""
    return _build_pass("live_mirror", ("faces",), ("width",))


@kept_until_exit
def tapped_shader(defines: tuple[str, ...]) -> gpu.types.GPUShader:
    """Makes a map of a pyramid of a sharper one; defines: `SUNS`, or nothing."""
    return _build_pass("live_tapped", ("sources", "taps", "lookups"), ("row",), *defines)


def _build_pass(
    name: str, samplers: tuple[str, ...], whole_numbers: tuple[str, ...], *defines: str
) -> gpu.types.GPUShader:
    """A program that draws the triangle of the whole target: from maps to a map."""
    info = screen_interface()
    for define in defines:
        info.define(define)
    for slot, sampler in enumerate(samplers):
        info.sampler(slot, "FLOAT_2D", sampler)
    for number in whole_numbers:
        info.push_constant("INT", number)
    info.fragment_out(0, "VEC4", "texel")
    return build(name, info, "screen_vert.glsl", f"{name}_frag.glsl")
