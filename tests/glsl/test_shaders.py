"""Shader files: includes, names, no warnings; and the words for what a driver refuses."""

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest
from rsibr.rsibr_addon.core.errors import DeviceError
from rsibr.rsibr_addon.core.kinds.reflection_tables.shading import AVERAGED
from rsibr.rsibr_addon.device import floor_shadow, preview, shaders, stage_shaders, textures
from rsibr.rsibr_addon.device import shader_source as sources
from rsibr.rsibr_addon.device.context import ensure_context
from rsibr.rsibr_addon.device.kinds import (
    environment,
    kernel_pyramid,
    live_environment_shaders,
    lobe_stack,
    mip_chain_shaders,
    reflection_tables,
)
from rsibr.rsibr_addon.device.own_materials import SMOOTH_DIFFUSE, TRANSLUCENT, UNCOATED
from rsibr.rsibr_addon.device.shader_source import SHADER_FOLDER, shader_source


def any_material_shader() -> object:
    return kernel_pyramid.material_shader(())


def plain_translucent_material_shader() -> object:
    return kernel_pyramid.material_shader((TRANSLUCENT, UNCOATED, SMOOTH_DIFFUSE))


FILES = sorted(path.relative_to(SHADER_FOLDER).as_posix() for path in SHADER_FOLDER.rglob("*.*"))
PROGRAMS = [
    shaders.views_fragment_shader,
    shaders.views_destination_shader,
    shaders.views_texel_shader,
    shaders.views_disk_shader,
    mip_chain_shaders.mip_chain_shader,
    reflection_tables.tables_program(),
    reflection_tables.tables_program(AVERAGED),
    environment.environment_shader,
    lobe_stack.lobe_stack_shader,
    kernel_pyramid.principled_shader,
    kernel_pyramid.sunlit_shader,
    any_material_shader,
    plain_translucent_material_shader,
    kernel_pyramid.depth_first_shader,
    preview.sample_means_shader,
    floor_shadow.floor_shadow_shader,
    textures.texels_shader,
    stage_shaders.composite_shader,
    stage_shaders.occluder_shader,
    live_environment_shaders.face_shader,
    live_environment_shaders.bordered_shader,
    live_environment_shaders.box_shader,
    live_environment_shaders.tent_shader,
    live_environment_shaders.rows_shader,
    live_environment_shaders.harmonics_shader,
]


@pytest.fixture
def shader_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A shader folder of the test's own."""
    monkeypatch.setattr(sources, "SHADER_FOLDER", tmp_path)
    shader_source.cache_clear()
    yield tmp_path
    shader_source.cache_clear()


@pytest.mark.parametrize("name", FILES)
def test_a_file_s_name_says_its_role(name: str) -> None:
    assert re.fullmatch(r"lib/\w+_lib\.glsl|\w+_(vert|frag|comp)\.glsl", name)
    text = (SHADER_FOLDER / name).read_text()
    assert text.startswith("// ")
    assert ("void main()" in text) != name.startswith("lib/")
    assert max(map(len, text.splitlines())) <= 110


@pytest.mark.parametrize(
    ("text", "name"), [("dFdx(", "lib/footprint_lib.glsl"), ("3.141", "lib/directions_lib.glsl")]
)
def test_pixels_sides_and_pi_are_said_once(text: str, name: str) -> None:
    assert [each for each in FILES if text in (SHADER_FOLDER / each).read_text()] == [name]


def test_twins_name_each_other_rightly() -> None:
    package = SHADER_FOLDER.parent / "rsibr_addon"
    for name in FILES:
        for module in re.findall(r"(?:core|device)/[\w/]+\.py", (SHADER_FOLDER / name).read_text()):
            assert (package / module).exists(), f"{name} speaks of {module}"
    for path in package.rglob("*.py"):
        text = re.sub(r"\s+", " ", path.read_text())
        for name, function in re.findall(r"gpu_shaders/([\w/]+\.glsl)(?: `(\w+)`)?", text):
            assert name in FILES, f"{path} speaks of {name}"
            if function:
                assert f" {function}(" in (SHADER_FOLDER / name).read_text(), f"{path} speaks of {function}"


@pytest.mark.parametrize("name", FILES)
def test_includes_are_resolved_once(name: str) -> None:
    text = shader_source(name)
    assert "#include" not in text
    functions = re.findall(r"^\w+ \w+\(.*", text, flags=re.MULTILINE)
    assert len(functions) == len(set(functions))


def test_line_numbers_are_those_of_the_files(shader_folder: Path) -> None:
    (shader_folder / "a.glsl").write_text('// a\n#include "b.glsl"\n#include "c.glsl"\nint a;\n')
    (shader_folder / "b.glsl").write_text('#include "c.glsl"\nint b;\n')
    (shader_folder / "c.glsl").write_text("int c;\n")
    # What stands below "#line n" is line n of its file; c.glsl comes once, where it is wanted first.
    expected = "#line 1|// a|#line 1|#line 1|int c;|#line 2|int b;|#line 3|int a;"
    assert shader_source("a.glsl").splitlines() == expected.split("|")


def test_a_missing_include_is_named(shader_folder: Path) -> None:
    (shader_folder / "a.glsl").write_text('#include "lib/lost_lib.glsl"\n')
    with pytest.raises(DeviceError, match=r"^The shader lib/lost_lib\.glsl is missing: install .* again\.$"):
        shader_source("a.glsl")
    with pytest.raises(DeviceError, match=r"^The shader nowhere\.glsl is missing"):
        shader_source("nowhere.glsl")


@pytest.mark.parametrize("broken", ["views_texel_vert.glsl", "views_texel_frag.glsl"])
def test_a_program_that_does_not_compile_is_named(broken: str, monkeypatch: pytest.MonkeyPatch) -> None:
    ensure_context()

    def source(name: str) -> str:
        return "void main() { this is no GLSL; }" if name == broken else shader_source(name)

    monkeypatch.setattr(shaders, "shader_source", source)
    with pytest.raises(DeviceError, match=r"refused the shader views_texel .*: update the driver\.$"):
        shaders.views_texel_shader.__wrapped__()


@pytest.mark.parametrize("program", PROGRAMS, ids=lambda program: program.__name__)
def test_a_program_is_built_once(program) -> None:
    ensure_context()
    assert program() is program()


def test_the_compiler_has_nothing_to_say(tmp_path: Path) -> None:
    script = (
        "from rsibr.tests.glsl.test_shaders import PROGRAMS, ensure_context\n"
        "ensure_context()\nfor program in PROGRAMS: program()\n"
    )
    # Mesa writes each shader with what its compiler says about it to a file in the working folder.
    environment = os.environ | {"MESA_GLSL": "log", "MESA_SHADER_CACHE_DISABLE": "true"}
    subprocess.run(
        [sys.executable, "-c", script], cwd=tmp_path, env=environment, check=True, capture_output=True
    )
    logs = [path.read_text() for path in tmp_path.glob("shader_*")]
    if not logs:
        pytest.skip("the graphics driver is not Mesa's, which keeps the compiler's log")
    ours = [log for log in logs if re.search(r"\b(world_position|map_uv|mirror_seen_0|by_mirror)\b", log)]
    assert len(ours) >= 2 * len(PROGRAMS) - 1  # two programs share a vertex shader's text
    for log in ours:
        assert re.search(r"/\* Compile status: ok \*/\s*/\* Log Info: \*/\s*$", log), log[-500:]
