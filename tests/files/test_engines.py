"""Light for engines, read back as their loaders do, by nothing of ours, against the sum over all texels."""

import base64
import json
import shutil
import struct
import subprocess
from collections.abc import Callable
from pathlib import Path

import numpy as np
import OpenImageIO
import pytest
from rsibr.rsibr_addon.core.environment import Environment
from rsibr.rsibr_addon.core.errors import OutputFileError, RangeError, RsibrWarning
from rsibr.rsibr_addon.core.filtering.irradiance import irradiance_from_harmonics, real_harmonics
from rsibr.rsibr_addon.core.kinds.mip_chain.chain import MipChain
from rsibr.rsibr_addon.core.kinds.reflection_tables.tables import ReflectionTables, Role
from rsibr.rsibr_addon.core.progress import drain
from rsibr.rsibr_addon.core.rgbd import rgbd_from_radiance
from rsibr.rsibr_addon.files.kinds import mip_chain, reflection_tables
from rsibr.rsibr_addon.files.map_set import write_map_set
from rsibr.rsibr_addon.files.map_set_header import Origin
from rsibr.rsibr_addon.files.radiance_hdr import write_hdr
from rsibr.rsibr_addon.files.radiance_pictures import read_radiance, write_radiance
from rsibr.rsibr_addon.tasks.export.engines.engine import CubeEngine
from rsibr.rsibr_addon.tasks.export.engines.engines import ENGINES
from rsibr.rsibr_addon.tasks.export.engines.export import export_for_engine
from rsibr.rsibr_addon.tasks.export.engines.settings import AnySettings, CubeSettings
from rsibr.tests.core.test_bc6h import decoded
from rsibr.tests.engine_light import cube_directions, diffuse_truth, from_y_up, sky, sky_file, truth
from rsibr.tests.files.test_export import read as read_ktx2

RNG = np.random.default_rng(3)
HALF = 2.0**-11
"""What 16-bit floats lose."""

SUM = 1e-3
"""Of the brightest: to what mips are filtered; harmonics lose a little of the widest lobes' kink."""


def exported(
    folder: Path,
    engine: str,
    ending: str,
) -> list[Path]:
    output = folder / f"sky{ending}"
    return drain(export_for_engine(sky_file(folder), output, engine, CubeSettings(size=64)))


def some(size: int) -> np.ndarray:
    """Indices of at most 100 texels of a cube, shape (3, n)."""
    texels = np.indices((6, size, size)).reshape(3, -1)
    return texels[:, RNG.permutation(texels.shape[1])[:100]]


def check_cube(
    levels: list[np.ndarray],
    roughness: list[float],
    world: Callable[[np.ndarray], np.ndarray],
    relative: np.ndarray | float,
) -> None:
    """Hold every level to the truth; `world` makes directions of Blender's from the texture's."""
    assert len(levels) == len(roughness)
    for faces, rough in zip(levels, roughness, strict=True):
        at = some(faces.shape[1])
        wanted = truth(world(cube_directions(faces.shape[1])[*at]), rough)
        error = np.abs(faces[*at] - wanted)
        assert np.all(error <= relative * wanted + SUM * wanted.max()), (rough, (error / wanted).max())


def read_ktx1(path: Path) -> tuple[list[np.ndarray], dict[str, str], tuple[int, ...]]:
    """Levels, notes and header of a KTX 1 file of packed floats."""
    data = path.read_bytes()
    assert data[:12] == b"\xabKTX 11\xbb\r\n\x1a\n"
    header = struct.unpack_from("<13I", data, 12)
    width, mips, noted = header[6], header[11], header[12]
    notes, at = {}, 64
    while at < 64 + noted:
        (length,) = struct.unpack_from("<I", data, at)
        key, value = data[at + 4 : at + 4 + length].split(b"\0", 1)
        notes[key.decode()] = value.decode()
        at += 4 + -(-length // 4) * 4
    levels = []
    for mip in range(mips):
        (length,) = struct.unpack_from("<I", data, at)
        size = width >> mip
        assert length == 4 * size**2
        packed = np.frombuffer(data, "<u4", 6 * size**2, at + 4).reshape(6, size, size)
        levels.append(
            np.stack([small_float(packed, *place) for place in ((0, 6), (11, 6), (22, 5))], axis=-1)
        )
        at += 4 + 6 * length
    assert at == len(data)
    return levels, notes, header


def small_float(packed: np.ndarray, start: int, bits: int) -> np.ndarray:
    """The value of a float of 5 bits of exponent and so many of mantissa: OpenGL 4.6, section 2.3.4.3."""
    mantissa = (packed >> start & (1 << bits) - 1) / (1 << bits)
    exponent = (packed >> start + bits & 31).astype(np.float64)
    return np.where(exponent == 0, 2.0**-14 * mantissa, 2.0 ** (exponent - 15.0) * (1.0 + mantissa))


def filament_irradiance(text: str, normal: np.ndarray) -> np.ndarray:
    """What Filament's shader makes of the text."""
    terms = np.array([float(word) for word in text.split()]).reshape(9, 3)
    x, y, z = np.moveaxis(normal, -1, 0)
    one = np.ones_like(x)
    return np.stack([one, y, z, x, y * x, y * z, 3 * z * z - 1, z * x, x * x - y * y], axis=-1) @ terms


def test_filament_shows_the_light_upright(tmp_path: Path) -> None:
    lit, sky_box = exported(tmp_path, "filament", ".ktx")
    assert (lit.name, sky_box.name) == ("sky.ktx", "sky-skybox.ktx")
    levels, notes, _ = read_ktx1(lit)
    # The shader looks up at last (2 r - r^2), down to 16 texels
    check_cube(levels, [0.0, 1.0 - np.sqrt(0.5), 1.0], from_y_up, np.array([2.0**-7, 2.0**-7, 2.0**-6]))
    normal = cube_directions(8)
    irradiance = filament_irradiance(notes["sh"], normal)
    wanted = diffuse_truth(from_y_up(normal))
    # Degree 2 leaves at most a few per cent of the mean [Ramamoorthi2001]
    assert np.abs(irradiance - wanted).max() < 0.06 * wanted.mean()
    np.testing.assert_array_equal(read_ktx1(sky_box)[0], levels[:1])


def test_filaments_own_tool_writes_the_same(tmp_path: Path) -> None:
    if shutil.which("cmgen") is None:
        pytest.skip("cmgen is missing: it is in Debian's libfilament-tools")
    # cmgen takes a map's middle to be +Z, we take it to be +X: a quarter turn
    turned = np.roll(sky(), -len(sky()) // 2, axis=1)
    write_hdr(tmp_path / "sky.hdr", turned)
    cmgen = ["cmgen", "-q", "--format=ktx", "--size=64", "--sh-window=no", f"--deploy={tmp_path / 'theirs'}"]
    subprocess.run([*cmgen, tmp_path / "sky.hdr"], check=True)
    for ours, part in zip(exported(tmp_path, "filament", ".ktx"), ("ibl", "skybox"), strict=True):
        theirs = tmp_path / "theirs" / f"theirs_{part}.ktx"
        levels, notes, header = read_ktx1(ours)
        their_levels, their_notes, their_header = read_ktx1(theirs)
        # All but the length of the text
        assert header[:12] == their_header[:12]
        assert notes.keys() == their_notes.keys()
        for mine, other in zip(levels, their_levels, strict=True):
            # Its 1024 samples miss the sum by 3 to 6 per cent
            assert np.median(np.abs(mine - other) / mine) < 0.06
        if notes:
            normal = cube_directions(4)
            mine, other = (filament_irradiance(each["sh"], normal) for each in (notes, their_notes))
            np.testing.assert_allclose(mine, other, rtol=0.05)


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


def three_world(direction: np.ndarray) -> np.ndarray:
    """What three.js looks up by (-x, y, z)."""
    return from_y_up(direction * (-1.0, 1.0, 1.0))


# The shader looks up at last (2 r - r^2), down to 8 texels
THREE_ROUGHNESS = [1.0 - np.sqrt(1.0 - mip / 3) for mip in range(4)]


def test_three_takes_half_floats(tmp_path: Path) -> None:
    (path,) = exported(tmp_path, "three", ".ktx2")
    texture = read_ktx2(path)
    assert (texture.faces, texture.format) == (6, 97)
    check_cube([level[..., :3] for level in texture.levels], THREE_ROUGHNESS, three_world, HALF)


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
        at_texels = some(64 >> mip)
        wanted = truth(three_world(cube_directions(64 >> mip)[*at_texels]), rough)
        # Two per cent in the median is what blocks of so few texels lose
        assert np.median(np.abs(found[*at_texels] - wanted) / wanted) < 0.02


@pytest.mark.parametrize("name", ENGINES)
def test_what_an_engine_cannot_take_is_told(name: str, tmp_path: Path) -> None:
    engine, source = ENGINES[name], sky_file(tmp_path)
    (ending, *_) = engine.endings
    with pytest.raises(OutputFileError, match=rf"does not end in \{ending}.*, as {engine.label} wants"):
        drain(export_for_engine(source, tmp_path / "sky.gif", name))
    there = tmp_path / f"there{ending}"
    there.touch()
    with pytest.raises(OutputFileError, match=r"there\..* exists"):
        next(export_for_engine(source, there, name))
    there.unlink()
    if isinstance(engine, CubeEngine):
        small = engine.settings(size=engine.least // 2)
        with pytest.raises(RangeError, match=rf"{engine.label} takes cubes from {engine.least} texels on"):
            drain(export_for_engine(source, tmp_path / f"new{ending}", name, small))
    tables = tmp_path / "tables.rsibr.exr"
    maps = {role: np.ones((4, 8, 3), np.float32) for role in (Role.DIFFUSE, Role.SPECULAR)}
    held = ReflectionTables(maps, np.ones((len(Role), 3, 3), dtype=np.float32))
    write_map_set(
        tables, reflection_tables.to_map_set(held, Origin(Environment(sky(8), "sky"), {}, "a test"))
    )
    with pytest.raises(
        RangeError, match=r"of the kind Reflection Tables, which .* one of the kind Mip Chain"
    ):
        drain(export_for_engine(tables, tmp_path / f"new{ending}", name))
    assert {path.name for path in tmp_path.iterdir()} == {"sky.exr", "tables.rsibr.exr"}


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


@pytest.mark.parametrize(("name", "direction"), [("unity", unity_direction), ("godot", godot_direction)])
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


def test_light_beyond_an_encoding_is_cut_and_told(tmp_path: Path) -> None:
    sun = np.ones((8, 16, 3), np.float32)
    sun[6, 3] = 1e6
    write_radiance(tmp_path / "sun.exr", sun)
    with pytest.warns(
        RsibrWarning, match=r"sun\.exr has radiance up to 9\d+, and R11F_G11F_B10F ends at 64512"
    ):
        lit, _ = drain(export_for_engine(tmp_path / "sun.exr", tmp_path / "sun.ktx", "filament"))
    levels, _, _ = read_ktx1(lit)
    assert max(level.max() for level in levels) == 64512.0


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


def pngs_of(data: bytes, places: list[dict[str, int]], folder: Path) -> list[np.ndarray]:
    """Radiance of RGBD pictures, row 0 on top, as Babylon.js decodes it."""
    made = []
    for place in places:
        path = folder / "face.png"
        path.write_bytes(data[place["position"] : place["position"] + place["length"]])
        picture = OpenImageIO.ImageInput.open(str(path), _unassociated())
        rgbd = picture.read_image(0, 0, 0, 4, "uint8") / 255.0
        picture.close()
        made.append(rgbd[..., :3] ** 2.2 / rgbd[..., 3:])
    return made


def _unassociated() -> OpenImageIO.ImageSpec:
    """Colours as they are in the file, not times alpha."""
    spec = OpenImageIO.ImageSpec()
    spec.attribute("oiio:UnassociatedAlpha", 1)
    return spec


def test_babylon_takes_its_own_format(tmp_path: Path) -> None:
    (path,) = exported(tmp_path, "babylon", ".env")
    data = path.read_bytes()
    assert data[:8] == bytes.fromhex("86168796f6d69636")
    text, _, pictures = data[8:].partition(b"\0")
    manifest = json.loads(text)
    assert (manifest["version"], manifest["width"]) == (1, 64)
    places = manifest["specular"]["mipmaps"]
    assert len(places) == 6 * 7
    assert places[-1]["position"] + places[-1]["length"] == len(pictures)
    faces = pngs_of(pictures, places, tmp_path)
    # It uploads pictures upside down, and looks up at 0.8 log2(alpha width)
    levels = [np.stack(faces[6 * mip : 6 * mip + 6])[:, ::-1] for mip in range(7)]
    alpha = [0.0, *(min(2.0 ** (mip / 0.8) / 64, 1.0) for mip in range(1, 7))]
    # A byte of gamma 2.2 is 1 % of a tenth, the darkest here
    check_cube(levels, [each**0.5 for each in alpha], three_world, 0.01)


@pytest.mark.parametrize("ending", [".glb", ".gltf"])
def test_gltf_takes_its_extension(ending: str, tmp_path: Path) -> None:
    (path,) = exported(tmp_path, "gltf", ending)
    data = path.read_bytes()
    if ending == ".glb":
        magic, version, length, text, kind = struct.unpack_from("<4s3I4s", data)
        assert (magic, version, length, kind) == (b"glTF", 2, len(data), b"JSON")
        described = json.loads(data[20 : 20 + text])
        binary, kind = struct.unpack_from("<I4s", data, 20 + text)
        pictures = data[28 + text :]
        assert (binary, kind) == (len(pictures), b"BIN\0")
    else:
        described = json.loads(data)
        pictures = base64.b64decode(described["buffers"][0]["uri"].partition(",")[2])
    assert described["buffers"][0]["byteLength"] == len(pictures)
    assert described["extensionsUsed"] == ["EXT_lights_image_based"]
    assert described["scenes"][described["scene"]]["extensions"] == {"EXT_lights_image_based": {"light": 0}}
    (light,) = described["extensions"]["EXT_lights_image_based"]["lights"]
    views = [described["bufferViews"][described["images"][each]["bufferView"]] for each in range(18)]
    places = [{"position": view["byteOffset"], "length": view["byteLength"]} for view in views]
    faces = pngs_of(pictures, places, tmp_path)
    levels = [np.stack([faces[face] for face in mip])[:, ::-1] for mip in light["specularImages"]]
    assert light["specularImageSize"] == 64
    check_cube(levels, [0.0, 0.5, 1.0], three_world, 0.01)
    # Their sum over the nine harmonics of the specification's sources, of which odd orders are negative
    basis = real_harmonics(cube_directions(8), 2) * [1, -1, 1, -1, 1, -1, 1, -1, 1]
    wanted = diffuse_truth(three_world(cube_directions(8)))
    assert np.abs(basis @ light["irradianceCoefficients"] / np.pi - wanted).max() < 0.06 * wanted.mean()


def test_babylons_divisor_beats_the_largest() -> None:
    radiance = np.exp2(RNG.uniform(-6.0, 7.0, (4000, 3)))
    rgbd = rgbd_from_radiance(radiance) / 255.0
    # What Babylon.js's own encoder does
    largest = (
        np.floor(np.minimum(255.0 / np.maximum(radiance.max(axis=-1, keepdims=True), 1.0), 255.0)) / 255.0
    )
    colour = np.rint(255.0 * (radiance * largest) ** (1 / 2.2)) / 255.0
    ours, theirs = (
        np.abs(colours**2.2 / divisors - radiance) / radiance
        for colours, divisors in ((rgbd[:, :3], rgbd[:, 3:]), (colour, largest))
    )
    assert np.median(ours) < 0.75 * np.median(theirs)
    assert np.all(rgbd[:, 3] >= 1 / 255)
