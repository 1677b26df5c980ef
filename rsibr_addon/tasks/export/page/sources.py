"""Programs for WebGL 2: the extension's own shaders as GLSL ES 3.00, behind interfaces like Blender's."""

import re
from collections.abc import Mapping
from pathlib import Path

from ....device.floor_shadow import floor_shadow_shader
from ....device.matte_layer import caught_shadow_shader
from ....device.own_materials import MOST_TEXTURES
from ....device.shader_source import shader_source
from ....device.shaders import DRAW_STRUCT, MeshProgram
from ....device.textured_materials import MATERIAL_STRUCT

HEAD = """#version 300 es
precision highp float;
precision highp int;
precision highp sampler2D;
precision highp sampler2DArray;
precision highp sampler3D;
"""

LOOKUPS = Path(__file__).with_name("lookups.glsl")
"""What takes the place of `textureLod` at level 0."""

CORNERS = Path(__file__).with_name("corners.glsl")
"""The end of vertex shaders: where they place a corner."""

SAMPLES = Path(__file__).with_name("samples.glsl")
"""What brings a surface to the middle of a sample."""

SAMPLER_TYPES = {"FLOAT_2D": "sampler2D", "FLOAT_2D_ARRAY": "sampler2DArray", "FLOAT_3D": "sampler3D"}

_DRAW = f"{DRAW_STRUCT}\nlayout(std140) uniform DrawBlock {{ Draw draw; }};\n"
_RADIANCE = "out vec4 radiance;\n"
_SCREEN = "layout(location = 0) in vec2 position;\nout vec2 map_uv;\n"
_MEANS = "uniform highp int per_axis;\nuniform sampler2D samples;\nout vec4 mean;\n"
_DISPLAY = "uniform float scale;\nuniform sampler2D picture;\nuniform sampler3D display;\nout vec4 colour;\n"
_LAYER = "uniform float {0};\nuniform sampler2D layer;\nout vec4 colour;\n"
_BEHIND = {
    "backdrop": "in vec2 map_uv;\nuniform mat4 environment_from_clip;\nuniform float scale;\n"
    "uniform sampler2D environment;\nout vec4 colour;\n",
    "picture_backdrop": "in vec2 map_uv;\nuniform vec2 size;\nuniform vec2 middle;\nuniform float scale;\n"
    "uniform sampler2D picture;\nout vec4 colour;\n",
    "matte_layer": _LAYER.format("on_nothing"),
    "layer": _LAYER.format("scale"),
}

_CORNERS = "layout(location = 0) in vec3 position;\nlayout(location = 1) in vec3 normal;\n"
_TEXTURED_CORNERS = (
    f"{_CORNERS}layout(location = 2) in vec4 tangent;\n"
    "layout(location = 3) in vec4 uv_a;\nlayout(location = 4) in vec4 uv_b;\n"
)
_SURFACE = {"world_position": "vec3", "world_normal": "vec3"}
_TEXTURED_SURFACE = {
    **_SURFACE,
    "object_normal": "vec3",
    "object_tangent": "vec4",
    "uv_01": "vec4",
    "uv_23": "vec4",
}
"""What the vertices of a mesh tell its fragments."""


def page_sources(program: MeshProgram) -> dict[str, tuple[str, str]]:
    """The programs of a page.

    Returns
    -------
    dict of str to (str, str)
        "surface", which draws the mesh, "means" and "display" -> vertex and fragment shader.
    """
    screen = _source(_SCREEN, "screen_vert.glsl")
    return {
        "surface": _mesh_sources(program),
        "means": (screen, _source(_MEANS, "sample_means_frag.glsl")),
        "display": (screen, _source(_DISPLAY, "page_display_frag.glsl")),
    }


def matte_sources() -> dict[str, tuple[str, str]]:
    """The programs of what lies behind the objects, as `device` has them.

    Returns
    -------
    dict of str to (str, str)
        "backdrop", "picture_backdrop", "floor_shadow", "caught_shadow", "matte_layer" and "layer".
    """
    screen = _source(_SCREEN, "screen_vert.glsl")
    meshes = {each.name: _mesh_sources(each) for each in (floor_shadow_shader, caught_shadow_shader)}
    return meshes | {name: (screen, _source(text, f"{name}_frag.glsl")) for name, text in _BEHIND.items()}


def _mesh_sources(program: MeshProgram) -> tuple[str, str]:
    block = (
        f"{program.struct}\nlayout(std140) uniform LookBlock {{ {program.block_type} {program.block}; }};\n"
    )
    fragment = _defined(program) + _DRAW + block + _samplers(program.samplers) + _RADIANCE
    return (
        _at_corners(_DRAW + _CORNERS, _SURFACE, "mesh_vert.glsl"),
        _at_samples(fragment, _SURFACE, f"{program.name}_frag.glsl"),
    )


def own_sources(program: MeshProgram) -> dict[str, tuple[str, str]]:
    """The programs of objects in their own materials, in the place of "surface".

    Parameters
    ----------
    program : MeshProgram
        Whose textures light them.

    Returns
    -------
    dict of str to (str, str)
        "surface", and "translucent", which has the uniform `whole`: see `device.textured_materials`.
    """
    images = {f"image_{number}": "FLOAT_2D" for number in range(MOST_TEXTURES)}
    block = f"{MATERIAL_STRUCT}\nlayout(std140) uniform LookBlock {{ Material material; }};\n"
    fragment = _defined(program) + _DRAW + block + _samplers({**program.samplers, **images}) + _RADIANCE
    vertex = _at_corners(_DRAW + _TEXTURED_CORNERS, _TEXTURED_SURFACE, "textured_mesh_vert.glsl")
    name = "principled_textured_frag.glsl"
    translucent = f"#define TRANSLUCENT\nuniform float whole;\n{fragment}"
    return {
        "surface": (vertex, _at_samples(fragment, _TEXTURED_SURFACE, name)),
        "translucent": (vertex, _at_samples(translucent, _TEXTURED_SURFACE, name)),
    }


def _at_corners(interface: str, surface: Mapping[str, str], name: str) -> str:
    """A vertex shader, which tells its fragments where they would be seen as well."""
    told = "".join(
        f"out {kind} drawn_{each};\n#define {each} drawn_{each}\n" for each, kind in surface.items()
    )
    return _source(f"{interface}{told}#define main place\n", name) + _own(CORNERS)


def _at_samples(interface: str, surface: Mapping[str, str], name: str) -> str:
    """A fragment shader, whose surface is that at the sample: see `SAMPLES`."""
    told = "".join(f"in {kind} drawn_{each};\n{kind} {each};\n" for each, kind in surface.items())
    taken = " ".join(f"{each} = at_sample(drawn_{each}, away);" for each in surface)
    main = f"#undef main\nvoid main() {{ vec2 away = away_from_sample(); {taken} shade(); }}\n"
    return _source(f"{interface}{_own(SAMPLES)}{told}#define main shade\n", name) + main


def _defined(program: MeshProgram) -> str:
    return "".join(f"#define {name}\n" for name in program.defines)


def _own(path: Path) -> str:
    return _stripped(path.read_text(encoding="utf-8"))


def _samplers(samplers: Mapping[str, str]) -> str:
    return "".join(f"uniform {SAMPLER_TYPES[kind]} {name};\n" for name, kind in samplers.items())


def _source(interface: str, name: str) -> str:
    text = _stripped(shader_source(name))
    exact = re.sub(r"\btextureLod\((\w+), (.*), 0\.0\)", r"looked_up(\1, \2)", text)
    lookups = _own(LOOKUPS) if exact != text else ""
    return HEAD + interface + lookups + exact


def _stripped(shader: str) -> str:
    """A shader without comments, which a page has no room for."""
    lines = (re.sub(r"//.*|^#line.*", "", line).rstrip() for line in shader.splitlines())
    return "\n".join(filter(None, lines)) + "\n"
