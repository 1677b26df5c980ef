"""Programs for WebGL 2: the extension's own shaders as GLSL ES 3.00, behind interfaces like Blender's."""

import re

from ....device.shader_source import shader_source
from ....device.shaders import DRAW_STRUCT, MeshProgram

HEAD = """#version 300 es
precision highp float;
precision highp int;
precision highp sampler2D;
precision highp sampler2DArray;
precision highp sampler3D;
"""

SAMPLER_TYPES = {"FLOAT_2D": "sampler2D", "FLOAT_2D_ARRAY": "sampler2DArray", "FLOAT_3D": "sampler3D"}

_DRAW = f"{DRAW_STRUCT}\nlayout(std140) uniform DrawBlock {{ Draw draw; }};\n"
_SCREEN = "layout(location = 0) in vec2 position;\nout vec2 map_uv;\n"
_MEANS = "uniform highp int per_axis;\nuniform sampler2D samples;\nout vec4 mean;\n"
_DISPLAY = "uniform float scale;\nuniform sampler2D picture;\nuniform sampler3D display;\nout vec4 colour;\n"


def page_sources(program: MeshProgram) -> dict[str, tuple[str, str]]:
    """The programs of a page.

    Returns
    -------
    dict of str to (str, str)
        "surface", which draws the mesh, "means" and "display" -> vertex and fragment shader.
    """
    samplers = "".join(f"uniform {SAMPLER_TYPES[kind]} {name};\n" for name, kind in program.samplers.items())
    block = (
        f"{program.struct}\nlayout(std140) uniform LookBlock {{ {program.block_type} {program.block}; }};\n"
    )
    corners = "layout(location = 0) in vec3 position;\nlayout(location = 1) in vec3 normal;\n"
    surface = "{0} vec3 world_position;\n{0} vec3 world_normal;\n"
    screen = _source(_SCREEN, "screen_vert.glsl")
    return {
        "surface": (
            _source(_DRAW + corners + surface.format("out"), "mesh_vert.glsl"),
            _source(
                _DRAW + block + samplers + surface.format("in") + "out vec4 radiance;\n",
                f"{program.name}_frag.glsl",
            ),
        ),
        "means": (screen, _source(_MEANS, "sample_means_frag.glsl")),
        "display": (screen, _source(_DISPLAY, "page_display_frag.glsl")),
    }


def _source(interface: str, name: str) -> str:
    """A shader without comments, which a page has no room for."""
    lines = (re.sub(r"//.*|^#line.*", "", line).rstrip() for line in shader_source(name).splitlines())
    return HEAD + interface + "\n".join(filter(None, lines)) + "\n"
