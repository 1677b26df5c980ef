"""Light for engines, read back as their loaders do, by nothing of ours, against the sum over all texels."""

import re
import struct
import subprocess
import warnings
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from rsibr.rsibr_addon.command_line.main import run
from rsibr.rsibr_addon.core.environment import Environment
from rsibr.rsibr_addon.core.errors import OutputFileError, RangeError, RsibrWarning
from rsibr.rsibr_addon.core.filtering.irradiance import irradiance_from_harmonics
from rsibr.rsibr_addon.core.kinds.kernel_pyramid.atlas import atlas_texels
from rsibr.rsibr_addon.core.kinds.kernel_pyramid.bake import bake_pyramid
from rsibr.rsibr_addon.core.kinds.mip_chain.chain import MipChain
from rsibr.rsibr_addon.core.kinds.reflection_tables.tables import ReflectionTables, Role
from rsibr.rsibr_addon.core.maps.representation import representation
from rsibr.rsibr_addon.core.progress import drain
from rsibr.rsibr_addon.files.kinds import mip_chain, reflection_tables
from rsibr.rsibr_addon.files.kinds.kernel_pyramid import shipped_families
from rsibr.rsibr_addon.files.map_set import write_map_set
from rsibr.rsibr_addon.files.map_set_header import Origin
from rsibr.rsibr_addon.files.radiance_pictures import read_radiance, write_radiance
from rsibr.rsibr_addon.tasks.export.engines import lobes
from rsibr.rsibr_addon.tasks.export.engines.engine import CubeEngine
from rsibr.rsibr_addon.tasks.export.engines.engines import ENGINES
from rsibr.rsibr_addon.tasks.export.engines.export import export_for_engine
from rsibr.rsibr_addon.tasks.export.engines.settings import AnySettings, CubeSettings, LobesSettings
from rsibr.tests.core.test_bc6h import decoded
from rsibr.tests.engine_light import (
    EQUIRECT,
    SUM,
    check_cube,
    cube_directions,
    diffuse_truth,
    exported,
    from_mirrored_x,
    from_y_up,
    sky,
    sky_file,
    some_texels,
    truth,
)
from rsibr.tests.files.test_export import read as read_ktx2
from rsibr.tests.pages import PAGES, calls

RNG = np.random.default_rng(3)
HALF = 2.0**-11
"""What 16-bit floats lose."""


def test_bevy_shows_the_light_upright(tmp_path: Path) -> None:
    specular, diffuse = exported(tmp_path, "bevy", ".ktx2")
    assert (specular.name, diffuse.name) == ("sky.ktx2", "sky-diffuse.ktx2")

    def world(direction: np.ndarray) -> np.ndarray:
        # "Cubemaps are left-handed, so we negate the Z coordinate"
        return from_y_up(direction * (1.0, 1.0, -1.0))

    texture = read_ktx2(specular)
    assert (texture.faces, texture.layers, texture.format) == (6, 0, 97)
    # The shader looks up at roughness times the last level
    check_cube([level[..., :3] for level in texture.levels], [0.0, 1 / 3, 2 / 3, 1.0], world, HALF)
    (level,) = read_ktx2(diffuse).levels
    assert level.shape == (6, 32, 32, 4)
    wanted = diffuse_truth(world(cube_directions(32)))
    np.testing.assert_allclose(level[..., :3], wanted, rtol=HALF, atol=SUM * wanted.max())
    for path in (specular, diffuse):
        assert read_ktx2(path).notes.keys() == {"KTXorientation", "KTXwriter"}


# The shader looks up at last (2 r - r^2), down to 8 texels
THREE_ROUGHNESS = [1.0 - np.sqrt(1.0 - mip / 3) for mip in range(4)]


def test_three_takes_half_floats(tmp_path: Path) -> None:
    (path,) = exported(tmp_path, "three", ".ktx2")
    texture = read_ktx2(path)
    assert (texture.faces, texture.format) == (6, 97)
    check_cube([level[..., :3] for level in texture.levels], THREE_ROUGHNESS, from_mirrored_x, HALF)


def test_three_takes_bc6h(tmp_path: Path) -> None:
    (path,) = exported(tmp_path, "three", ".dds")
    data = path.read_bytes()
    magic, size, flags, height, width, length, _, mips = struct.unpack_from("<4s7I", data)
    assert (magic, size, height, width, length, mips) == (b"DDS ", 124, 64, 64, 16 * 16 * 16, 4)
    # Caps, height, width, format, mips and the length of the first; the cube with all faces
    assert flags == 0x1 | 0x2 | 0x4 | 0x1000 | 0x20000 | 0x80000
    assert struct.unpack_from("<2I4s", data, 76) == (32, 4, b"DX10")
    assert struct.unpack_from("<2I", data, 108) == (0x1000 | 0x400000 | 0x8, 0x200 | 0xFC00)
    assert struct.unpack_from("<5I", data, 128) == (95, 3, 4, 1, 0)
    blocks, at = {}, 148
    for face in range(6):
        for mip in range(4):
            count = 16 >> mip
            blocks[face, mip] = np.frombuffer(data, np.uint8, 16 * count**2, at).reshape(count, count, 16)
            at += 16 * count**2
    assert at == len(data)
    for mip, rough in enumerate(THREE_ROUGHNESS):
        found = np.stack([decoded(blocks[face, mip], False, tmp_path) for face in range(6)])
        at_texels = some_texels(64 >> mip)
        wanted = truth(from_mirrored_x(cube_directions(64 >> mip)[*at_texels]), rough)
        # Two per cent in the median is what blocks of so few texels lose
        assert np.median(np.abs(found[*at_texels] - wanted) / wanted) < 0.02


@pytest.mark.parametrize("name", ENGINES)
def test_what_an_engine_cannot_take_is_told(name: str, tmp_path: Path) -> None:
    engine, source = ENGINES[name], sky_file(tmp_path)
    (ending, *_) = engine.endings
    with pytest.raises(OutputFileError, match=rf"does not end in \{ending}.*, as {engine.label} wants"):
        drain(export_for_engine(source, tmp_path / "sky.gif", name))
    output = tmp_path / f"there{ending}"
    for there in engine.files_of(output):
        there.touch()
        with pytest.raises(OutputFileError, match=rf"{there.name} exists"):
            next(export_for_engine(source, output, name))  # before anything is filtered
        there.unlink()
    if isinstance(engine, CubeEngine):
        small = engine.settings(size=engine.least // 2)
        with pytest.raises(RangeError, match=rf"{engine.label} takes cubes from {engine.least} texels on"):
            drain(export_for_engine(source, tmp_path / f"new{ending}", name, small))
    assert {path.name for path in tmp_path.iterdir()} == {"sky.exr"}


def test_of_any_map_set_the_light_is_taken(tmp_path: Path) -> None:
    tables, light = tmp_path / "tables.rsibr.exr", Environment(sky(8), "sky.exr")
    maps = {role: np.ones((4, 8, 3), np.float32) for role in (Role.DIFFUSE, Role.SPECULAR)}
    held = ReflectionTables(maps, np.ones((len(Role), 3, 3), dtype=np.float32))
    write_map_set(tables, reflection_tables.to_map_set(held, Origin(light, {}, "a test")))
    write_radiance(tmp_path / "sky.exr", light.radiance)
    for name, ending in (("any", ".ktx2"), ("lobes", ".ktx2"), ("unreal", ".exr")):
        settings = {"any": AnySettings(size=32), "lobes": LobesSettings(widest=32)}.get(name)
        written = [tmp_path / f"{name}-of-{source}{ending}" for source in ("tables", "sky")]
        for source, output in zip((tables, tmp_path / "sky.exr"), written, strict=True):
            drain(export_for_engine(source, output, name, settings))
        assert written[0].read_bytes() == written[1].read_bytes()


ANY = [
    (AnySettings(size=32, texels="half"), lambda d: from_y_up(d), [0.0, 0.5, 1.0]),
    (
        AnySettings(size=32, up="z", mirror="y", texels="half"),
        lambda d: d * (1.0, -1.0, 1.0),
        [0.0, 0.5, 1.0],
    ),
    (
        AnySettings(size=32, mirror="z", rule="quadratic", last=4, texels="half"),
        lambda d: from_y_up(d * (1.0, 1.0, -1.0)),
        [1.0 - np.sqrt(1.0 - mip / 3) for mip in range(4)],
    ),
]


@pytest.mark.parametrize(("settings", "world", "roughness"), ANY)
def test_any_engine_takes_what_is_asked_for(
    settings: AnySettings, world: Callable[[np.ndarray], np.ndarray], roughness: list[float], tmp_path: Path
) -> None:
    source = sky_file(tmp_path)
    (ktx,) = drain(export_for_engine(source, tmp_path / "sky.ktx2", "any", settings))
    (dds,) = drain(export_for_engine(source, tmp_path / "sky.dds", "any", settings))
    texture = read_ktx2(ktx)
    levels = [level[..., :3] for level in texture.levels]
    # The first mip is the mean over its texels, which others are filtered without
    check_cube(levels[1:], roughness[1:], world, HALF)
    assert texture.note["roughness"] == pytest.approx(roughness)
    normal = cube_directions(4)
    shown = irradiance_from_harmonics(np.array(texture.note["harmonics"]), normal) / np.pi
    wanted = diffuse_truth(world(normal))
    assert np.abs(shown - wanted).max() < 0.06 * wanted.mean()
    # The same texels, face by face
    data, at = dds.read_bytes(), 148
    assert struct.unpack_from("<I", data, 128) == (10,)
    for face in range(6):
        for level in texture.levels:
            size = level.shape[1]
            texels = np.frombuffer(data, "<f2", 4 * size**2, at).reshape(size, size, 4)
            np.testing.assert_array_equal(texels, level[face])
            at += 8 * size**2
    assert at == len(data)


def test_any_engine_takes_bc6h_in_either_format(tmp_path: Path) -> None:
    settings, source = AnySettings(size=32, texels="bc6h"), sky_file(tmp_path)
    (ktx,) = drain(export_for_engine(source, tmp_path / "sky.ktx2", "any", settings))
    (dds,) = drain(export_for_engine(source, tmp_path / "sky.dds", "any", settings))
    data, blocks = ktx.read_bytes(), dds.read_bytes()[148:]
    number, unit, width, height, _, layers, faces, count, packing = struct.unpack_from("<9I", data, 12)
    assert (number, unit, width, height, layers, faces, count, packing) == (143, 1, 32, 32, 0, 6, 3, 0)
    described_at, described = struct.unpack_from("<2I", data, 48)
    # Blocks of 4 x 4 texels in 16 bytes, one unsigned sample of 128 bits: Khronos Data Format 1.3
    assert described == 44
    assert data[described_at + 12 : described_at + 28] == bytes((133, 1, 1, 0, 3, 3, 0, 0, 16, *7 * (0,)))
    assert struct.unpack_from("<HBBIff", data, described_at + 28) == (0, 127, 0x80, 0, 0.0, 1.0)
    sizes = [16 * (8 >> mip) ** 2 for mip in range(3)]
    for mip, size in enumerate(sizes):
        place, length, _ = struct.unpack_from("<3Q", data, 80 + 24 * mip)
        assert (place % 16, length) == (0, 6 * size)
        for face in range(6):
            at = face * sum(sizes) + sum(sizes[:mip])
            assert data[place + face * size : place + (face + 1) * size] == blocks[at : at + size]


def test_of_a_mip_chain_its_environment_is_filtered_again(tmp_path: Path) -> None:
    (of_picture,) = exported(tmp_path, "three", ".ktx2")
    mips = tuple(RNG.random((6, size, size, 3)).astype(np.float32) for size in (64, 32))
    chain = MipChain(mips, RNG.standard_normal((9, 3)))
    origin = Origin(Environment(sky(), "sky.exr"), {}, "a test", {"filter": "box"})
    write_map_set(tmp_path / "chain.rsibr.exr", mip_chain.to_map_set(chain, origin))
    (of_chain,) = drain(export_for_engine(tmp_path / "chain.rsibr.exr", tmp_path / "chain.ktx2", "three"))
    assert of_chain.read_bytes() == of_picture.read_bytes()


def unity_direction(u: np.ndarray, v: np.ndarray) -> np.ndarray:
    """Blender's direction where Unity's Skybox/Panoramic finds (u, v); Blender's (x, y, z) is (-x, z, -y)."""
    longitude, latitude = (0.5 - u) * 2.0 * np.pi, (1.0 - v) * np.pi
    x, y, z = np.sin(latitude) * np.cos(longitude), np.cos(latitude), np.sin(latitude) * np.sin(longitude)
    return np.stack([-x, -z, y], axis=-1)


def godot_direction(u: np.ndarray, v: np.ndarray) -> np.ndarray:
    """Blender's direction where Godot's sky shader does: atan(x, -z) from the left, acos(y) from the top."""
    longitude, latitude = u * 2.0 * np.pi, (1.0 - v) * np.pi
    x, y, z = np.sin(latitude) * np.sin(longitude), np.cos(latitude), -np.sin(latitude) * np.cos(longitude)
    return from_y_up(np.stack([x, y, z], axis=-1))


def blender_direction(u: np.ndarray, v: np.ndarray) -> np.ndarray:
    """Where Blender finds it, and the picture for Unreal Engine is as in Blender."""
    return EQUIRECT.direction_from_uv(np.stack([u, v], axis=-1), np.array(0))


@pytest.mark.parametrize(
    ("name", "direction"),
    [("unity", unity_direction), ("godot", godot_direction), ("unreal", blender_direction)],
)
@pytest.mark.parametrize(("ending", "relative"), [(".exr", 1e-6), (".hdr", 2.0**-7)])
def test_a_panorama_stands_as_in_blender(
    name: str,
    direction: Callable[[np.ndarray, np.ndarray], np.ndarray],
    ending: str,
    relative: float,
    tmp_path: Path,
) -> None:
    (path,) = drain(export_for_engine(sky_file(tmp_path), tmp_path / f"made{ending}", name))
    shown = read_radiance(path)
    height, width = shown.shape[:2]
    u, v = np.meshgrid((np.arange(width) + 0.5) / width, (np.arange(height) + 0.5) / height)
    # Radiance HDR is as exact as the largest of three colours
    wanted = truth(direction(u, v), 0.0).max(axis=-1)
    np.testing.assert_allclose(shown.max(axis=-1), wanted, rtol=relative)


@pytest.mark.parametrize(
    ("scale", "told"),
    [(1e6, "a half float ends at 65504"), (1e-7, "half floats round it by more than a thousandth")],
)
@pytest.mark.parametrize("name", ["three", "bevy"])
def test_engines_that_need_half_floats_get_them(name: str, scale: float, told: str, tmp_path: Path) -> None:
    write_radiance(tmp_path / "sky.exr", scale * sky(64))
    with pytest.warns(RsibrWarning, match=told):
        paths = drain(
            export_for_engine(tmp_path / "sky.exr", tmp_path / "sky.ktx2", name, CubeSettings(size=16))
        )
    assert {read_ktx2(path).format for path in paths} == {97}


@pytest.mark.parametrize(
    ("name", "ending", "darkest"),
    [("three", "dds", 6e-5), ("filament", "ktx", 6e-5), ("babylon", "env", 0.01), ("gltf", "glb", 0.01)],
)
def test_light_that_the_texels_do_not_hold_well_is_told_of(
    name: str, ending: str, darkest: float, tmp_path: Path
) -> None:
    mean = float(np.mean(sky(64)))
    for share, told in ((2.0, False), (0.5, True)):
        write_radiance(tmp_path / "sky.exr", share * darkest / mean * sky(64), force=True)
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            export = export_for_engine(
                tmp_path / "sky.exr", tmp_path / f"sky.{ending}", name, CubeSettings(size=32), force=True
            )
            drain(export)
        assert [" is coarse below " in str(warning.message) for warning in caught] == [True] * told


def test_the_pages_commands_do_what_they_say(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    bake = ["bake", "mip-chain", "--environment", str(sky_file(tmp_path)), "--size", "64"]
    assert run([*bake, "-o", "court.rsibr.exr"]) == 0
    exports = [words for page in PAGES if page.startswith("docs/engines/") for words in calls(page, "rsibr")]
    assert {words[words.index("--for") + 1] for words in exports} == ENGINES.keys()
    for words in exports:
        assert run([*words, "--force"]) == 0, words


def lobes_of_sky(folder: Path) -> list[Path]:
    settings = LobesSettings(widest=64)
    return drain(export_for_engine(sky_file(folder), folder / "sky.ktx2", "lobes", settings))


def test_lobes_say_how_light_is_shaded(tmp_path: Path) -> None:
    """Weights sum to the albedos beside them, and the map of diffuse light lies where the shader says."""
    files = lobes_of_sky(tmp_path)
    assert [path.name for path in files] == ["sky.ktx2", "sky-lobes.ktx2", "sky.glsl", "sky.wgsl", "sky.hlsl"]
    (table,) = read_ktx2(files[1]).levels
    assert table.shape == (38, 32, 49, 4)
    weights = table[1:37].astype(np.float64).reshape(12, 3, 32, 49, 4)
    np.testing.assert_allclose(weights.sum(axis=(0, 4)), np.moveaxis(table[37, ..., :3], -1, 0), rtol=HALF)
    (light,) = read_ktx2(files[0]).levels
    listed = re.findall(r"vec4\(([^)]*)\)", files[2].read_text().partition("PLACES")[2].partition(";")[0])
    left, bottom, width, _ = map(float, listed[13].split(","))
    size = round(width * light.shape[2])
    corner = round(bottom * light.shape[1]), round(left * light.shape[2])
    shown = light[0, corner[0] : corner[0] + size, corner[1] : corner[1] + size, :3]
    direction = representation("octahedral").texel_directions(size)[0]
    wanted = diffuse_truth(direction.reshape(-1, 3)).reshape(size, size, 3)
    np.testing.assert_allclose(shown, wanted, rtol=HALF, atol=SUM * wanted.max())


def test_lobes_take_suns_apart(tmp_path: Path, recwarn: pytest.WarningsRecorder) -> None:
    """So they may be brighter than half floats, which hold the rest of the light."""
    light = sky()
    light[90, 100] = 2e5, 1.8e5, 1.5e5
    pyramid, output = drain(bake_pyramid(light, 64)).pyramid, tmp_path / "sun.ktx2"
    families = shipped_families()
    pyramid = replace(pyramid, suns=replace(pyramid.suns, narrowest=float(families.ggx.alpha[0])))
    texels, *_ = lobes.write(pyramid, families, "sun", output, False)
    assert not recwarn.list
    (sun,), (irradiance,) = pyramid.suns.direction, pyramid.suns.irradiance
    (shown,) = read_ktx2(texels).levels
    wanted, _ = atlas_texels(replace(pyramid, mirror=np.minimum(pyramid.mirror, pyramid.suns.ceiling)))
    np.testing.assert_allclose(shown[0], wanted, rtol=HALF)
    for ending, vector in ((".glsl", "vec3"), (".wgsl", "vec3f"), (".hlsl", "float3")):
        shader = output.with_suffix(ending).read_text()
        for name, numbers in (("DIRECTIONS", sun), ("IRRADIANCES", irradiance)):
            listed = re.findall(rf"SUN_{name}\b.*\n    {vector}\((.*?)\)", shader)
            assert [float(number) for number in listed[0].split(",")] == pytest.approx(numbers)


@pytest.mark.parametrize(
    "command",
    [
        pytest.param(command, marks=pytest.mark.needs(command.partition(" ")[0]))
        for command in (
            "naga sky.wgsl",
            "glslangValidator -D -e rsibr -V -S frag -o sky.spv entry.hlsl",
            "glslangValidator entry.frag",
        )
    ],
)
def test_shaders_of_lobes_compile(command: str, tmp_path: Path) -> None:
    lobes_of_sky(tmp_path)
    white, up = "float3(1, 1, 1)", "float3(0, 0, 1)"
    (tmp_path / "entry.hlsl").write_text(
        '#include "sky.hlsl"\n'
        f"float4 rsibr() : SV_Target {{ return float4(rsibr_shade({white}, 0.5, 0.5, {up}, {up}), 1); }}\n"
    )
    shader = (tmp_path / "sky.glsl").read_text()
    entry = "out vec4 c; void main() { c = vec4(rsibr_shade(vec3(1), 0.5, 0.5, vec3(1), vec3(1)), 1); }\n"
    (tmp_path / "entry.frag").write_text(f"#version 330\n{shader}{entry}")
    done = subprocess.run(command.split(), cwd=tmp_path, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr
