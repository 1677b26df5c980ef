"""Map sets as KTX 2.0 textures, read back as the specification says, by nothing of ours."""

import json
import struct
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from rsibr.rsibr_addon.core.environment import Environment
from rsibr.rsibr_addon.core.errors import OutputFileError, RangeError
from rsibr.rsibr_addon.core.filtering.irradiance import irradiance_from_harmonics
from rsibr.rsibr_addon.core.geometry.directions import normalize
from rsibr.rsibr_addon.core.kinds.kernel_pyramid.bake import BakedPyramid, FilterErrors
from rsibr.rsibr_addon.core.kinds.kernel_pyramid.pyramid import OCTAHEDRAL, Pyramid
from rsibr.rsibr_addon.core.kinds.mip_chain.chain import MipChain
from rsibr.rsibr_addon.core.kinds.reflection_tables.tables import ReflectionTables, Role
from rsibr.rsibr_addon.core.lobes.bank import KernelBank
from rsibr.rsibr_addon.core.maps.representation import representation
from rsibr.rsibr_addon.core.progress import drain
from rsibr.rsibr_addon.core.resample import bilinear, clamp_to_edge, lookup
from rsibr.rsibr_addon.files.kinds import kernel_pyramid, mip_chain, reflection_tables
from rsibr.rsibr_addon.files.ktx2 import write_ktx2
from rsibr.rsibr_addon.files.map_set import write_map_set
from rsibr.rsibr_addon.files.map_set_header import Origin
from rsibr.rsibr_addon.files.textures import Texture, Up
from rsibr.rsibr_addon.tasks.export.export import export
from rsibr.rsibr_addon.tasks.export.ktx2 import Ktx2Settings

RNG = np.random.default_rng(5)
SKY = Environment(RNG.random((8, 16, 3)).astype(np.float32), "sky.exr")
CHAIN = MipChain(
    tuple(RNG.random((6, n, n, 3)).astype(np.float32) for n in (8, 4, 2, 1)),
    RNG.standard_normal((9, 3)),
    (0.0, 0.3, 0.6, 1.0),
)
CUBE = representation("cube_map")


@dataclass(frozen=True)
class Read:
    """What a file says: its levels have shape (layers or faces, height, width, 4)."""

    levels: list[np.ndarray]
    layers: int
    faces: int
    notes: dict[str, str]
    format: int

    @property
    def note(self) -> dict[str, Any]:
        return json.loads(self.notes["rsibr"])


def read(path: Path) -> Read:
    data = path.read_bytes()
    assert data[:12] == b"\xabKTX 20\xbb\r\n\x1a\n"
    texel_format, type_size, width, height, depth, layers, faces, count, packing = struct.unpack_from(
        "<9I", data, 12
    )
    described_at, described, noted_at, noted, shared_at, shared = struct.unpack_from("<4I2Q", data, 48)
    assert (depth, packing, shared_at, shared) == (0, 0, 0, 0)
    half = texel_format == 97
    assert type_size == (2 if half else 4)
    # The basic block: all of the descriptor, linear, Rec. 709, texels of so many bytes, four samples
    assert struct.unpack_from("<IIHH", data, described_at) == (described, 0, 2, described - 4)
    assert data[described_at + 12 : described_at + 21] == bytes((1, 1, 1, 0, 0, 0, 0, 0, 8 if half else 16))
    samples = [struct.unpack_from("<HBB", data, described_at + 28 + 16 * i) for i in range(4)]
    bits = 16 if half else 32
    assert samples == [(i * bits, bits - 1, 0xC0 + c) for i, c in enumerate((0, 1, 2, 15))]
    notes, at = {}, noted_at
    while at < noted_at + noted:
        (length,) = struct.unpack_from("<I", data, at)
        key, value, _ = data[at + 4 : at + 4 + length].split(b"\0")
        notes[key.decode()] = value.decode()
        at += 4 + -(-length // 4) * 4
    assert list(notes) == sorted(notes)
    levels = []
    for level in range(count):
        place, length, unpacked = struct.unpack_from("<3Q", data, 80 + 24 * level)
        assert place % (8 if half else 16) == 0
        assert length == unpacked
        shape = (max(layers, 1) * faces, height >> level, width >> level, 4)
        levels.append(
            np.frombuffer(data, "<f2" if half else "<f4", length // type_size, place).reshape(shape)
        )
    return Read(levels, layers, faces, notes, texel_format)


def chain_file(folder: Path) -> Path:
    path = folder / "sky.rsibr.exr"
    write_map_set(path, mip_chain.to_map_set(CHAIN, Origin(SKY, {}, "a test", {"filter": "ggx"})))
    return path


def test_a_chain_is_a_cube_with_its_mips(tmp_path: Path) -> None:
    (path,) = drain(export(chain_file(tmp_path), tmp_path / "sky.ktx2"))
    texture = read(path)
    assert (texture.layers, texture.faces, len(texture.levels)) == (0, 6, 4)
    for level, mip in zip(texture.levels, CHAIN.mips, strict=True):
        # 11 significant bits
        np.testing.assert_allclose(level[..., :3], mip, rtol=2.0**-11)
        assert np.all(level[..., 3] == 1.0)
    assert texture.notes["KTXorientation"] == "rd"
    assert texture.note["kind"] == "mip_chain"
    assert texture.note["roughness"] == [0.0, 0.3, 0.6, 1.0]
    assert texture.note["spread"] is None
    np.testing.assert_allclose(texture.note["numbers"]["harmonics"]["rows"], CHAIN.harmonics[None], rtol=1e-6)


def test_with_y_up_directions_show_what_they_showed(tmp_path: Path) -> None:
    (path,) = drain(export(chain_file(tmp_path), tmp_path / "sky.ktx2", Ktx2Settings(up=Up.Y)))
    texture = read(path)
    here = RNG.standard_normal((500, 3))
    here /= np.linalg.norm(here, axis=-1, keepdims=True)
    there = np.stack([here[:, 0], -here[:, 2], here[:, 1]], axis=-1)
    for level, mip in zip(texture.levels, CHAIN.mips, strict=True):
        found = lookup(level[..., :3].astype(np.float64), here, CUBE)
        np.testing.assert_allclose(found, lookup(mip.astype(np.float64), there, CUBE), rtol=2.0**-10)
    (rows,) = texture.note["numbers"]["harmonics"]["rows"]
    # The file has the coefficients as 32-bit floats
    np.testing.assert_allclose(
        irradiance_from_harmonics(rows, here), irradiance_from_harmonics(CHAIN.harmonics, there), atol=1e-5
    )


def test_tables_of_several_sizes_are_several_textures(tmp_path: Path) -> None:
    maps = {Role.DIFFUSE: RNG.random((4, 8, 3)), Role.SPECULAR: RNG.random((8, 16, 3))}
    single = {role: values.astype(np.float32) for role, values in maps.items()}
    tables = ReflectionTables(single, np.ones((len(Role), 3, 3), dtype=np.float32))
    source = tmp_path / "tables.rsibr.exr"
    write_map_set(source, reflection_tables.to_map_set(tables, Origin(SKY, {}, "a test")))
    textures = drain(export(source, tmp_path / "out.ktx2"))
    assert [path.name for path in textures] == ["out-diffuse.ktx2", "out-specular.ktx2"]
    for path, (role, values) in zip(textures, maps.items(), strict=True):
        texture = read(path)
        assert texture.notes["KTXorientation"] == "ru"
        assert [layer["role"] for layer in texture.note["layers"]] == [role]
        np.testing.assert_allclose(texture.levels[0][0, ..., :3], values, rtol=2.0**-11, atol=2.0**-25)
        weights = texture.note["numbers"]["weights"]
        assert weights["rows"] == np.ones((len(Role), 3, 3)).tolist()
        assert weights["part"]["rows"] == [role.value for role in Role]
    with pytest.raises(RangeError, match=r"cannot be turned: export it with Z up"):
        drain(export(source, tmp_path / "turned.ktx2", Ktx2Settings(up=Up.Y)))


def test_maps_of_one_role_and_several_sizes_are_told_apart(tmp_path: Path) -> None:
    mirror, *maps = (RNG.random((1, n, n, 3), dtype=np.float32) for n in (16, 4, 4, 8))
    diffuse, rings = RNG.random((2, 2, 2, 3)), RNG.random((3, 3, 3, 3))
    pyramid = Pyramid(KernelBank((0.5, 1.0, 2.0)), mirror, tuple(maps), diffuse, rings)
    errors = FilterErrors(np.zeros(3), 0.0)
    baked = BakedPyramid(pyramid, (errors,) * 3, (errors,) * 2, (errors,) * 3)
    source = tmp_path / "pyramid.rsibr.exr"
    write_map_set(source, kernel_pyramid.to_map_set(baked, Origin(SKY, {}, "a test")))
    textures = {path.stem: read(path) for path in drain(export(source, tmp_path / "out.ktx2"))}
    layers = {name: [each["name"] for each in made.note["layers"]] for name, made in textures.items()}
    assert layers == {
        "out-mirror": ["mirror"],
        "out-prefiltered-4": ["kernel00", "kernel01"],
        "out-prefiltered-8": ["kernel02"],
        "out-diffuse-leaning": ["diffuse", "leaning"],
        "out-ring": ["ring00", "ring01", "ring02"],
    }
    made = textures["out-prefiltered-8"]
    found = made.levels[0][0, ..., :3].astype(np.float64)
    np.testing.assert_allclose(found[1:-1, 1:-1], maps[2][0], rtol=2.0**-11, atol=2.0**-25)
    # Lookups that clamp find what continues a map beyond its edges
    assert made.note["border"] == 1
    direction = normalize(RNG.standard_normal((2000, 3)))
    uv, _ = OCTAHEDRAL.uv_from_direction(direction)
    shown = bilinear(found, (uv * 8.0 + 1.0) / 10.0, clamp_to_edge)
    np.testing.assert_allclose(shown, lookup(maps[2], direction, OCTAHEDRAL), rtol=2.0**-10, atol=1e-6)


def test_light_too_bright_for_half_floats_is_kept(tmp_path: Path) -> None:
    sun = np.full((3, 2, 5, 3), 1e6, dtype=np.float32)
    write_ktx2(tmp_path / "sun.ktx2", Texture((sun,)), {})
    texture = read(tmp_path / "sun.ktx2")
    assert (texture.format, texture.layers) == (109, 3)
    np.testing.assert_array_equal(texture.levels[0][..., :3], sun)


@pytest.mark.parametrize(("scale", "texel_format"), [(1.0, 97), (1e-2, 97), (1e-5, 109), (1e-7, 109)])
def test_dark_light_is_kept(tmp_path: Path, scale: float, texel_format: int) -> None:
    # From the mean's hundredth to its hundredfold, as rooms have it
    light = np.geomspace(0.01, 100.0, 3 * 4 * 8).reshape(1, 4, 8, 3)
    write_ktx2(tmp_path / "night.ktx2", Texture(((scale * light).astype(np.float32),)), {})
    texture = read(tmp_path / "night.ktx2")
    assert texture.format == texel_format
    np.testing.assert_allclose(texture.levels[0][..., :3], scale * light, rtol=1e-3)


def test_black_beside_light_does_not_matter(tmp_path: Path) -> None:
    light = np.array([0.0, 1e-12, 1.0]).reshape(1, 1, 1, 3)
    write_ktx2(tmp_path / "day.ktx2", Texture((light,)), {})
    assert read(tmp_path / "day.ktx2").format == 97


def test_what_cannot_be_exported_is_told_before_anything_is_written(tmp_path: Path) -> None:
    source = chain_file(tmp_path)
    with pytest.raises(OutputFileError, match=r"does not end in \.ktx2"):
        drain(export(source, tmp_path / "sky.dds"))
    (tmp_path / "sky.ktx2").write_text("mine")
    with pytest.raises(OutputFileError, match=r"exists"):
        drain(export(source, tmp_path / "sky.ktx2"))
    assert (tmp_path / "sky.ktx2").read_text() == "mine"
