"""The functions that changing light is filtered with against their numpy twins."""

import numpy as np
import pytest
from rsibr.rsibr_addon.core.filtering.irradiance import real_harmonics
from rsibr.rsibr_addon.core.kinds.live_environment import harmonics_of_faces, solid_angle_texels
from rsibr.rsibr_addon.core.kinds.mip_chain import texture_space
from rsibr.rsibr_addon.core.kinds.mip_chain.chain import MipChain
from rsibr.rsibr_addon.core.kinds.mip_chain.texture_space import filtered_mips, with_borders
from rsibr.rsibr_addon.core.maps import cube_map
from rsibr.rsibr_addon.device import buffers
from rsibr.rsibr_addon.device.kinds.mip_chain import atlas_texels
from rsibr.tests.glsl.evaluation import Samplers, evaluate
from rsibr.tests.glsl.twins import AXES, COUNT, ULP, Twin, check, single, unit_vectors

RNG = np.random.default_rng(41)
SIZE = 16
FACES = RNG.random((6, SIZE, SIZE, 3), dtype=np.float32)
NINE = single(RNG.normal(size=(9, 3)))
MIPS = filtered_mips(FACES, texture_space.tent_halved)


def texels(image: np.ndarray) -> np.ndarray:
    """Shape (height, width, 3) with an alpha of 1."""
    return np.concatenate([image, np.ones_like(image[..., :1])], axis=-1)


def strip_of(faces: np.ndarray) -> np.ndarray:
    return texels(np.concatenate(list(faces), axis=1))


def samplers() -> Samplers:
    chain = MipChain(tuple(mip.astype(np.float32) for mip in MIPS), NINE)
    solid_angles = np.repeat(solid_angle_texels(SIZE)[..., None], 4, axis=-1)
    return {
        "strip": ("FLOAT_2D", buffers.texture(strip_of(FACES))),
        "atlas": ("FLOAT_2D", buffers.texture(atlas_texels(chain))),
        "solid_angles": ("FLOAT_2D", buffers.texture(solid_angles)),
    }


def places_on_faces() -> list[np.ndarray]:
    """Points of faces, their edges and corners among them, and the faces' numbers."""
    uv = RNG.random((COUNT, 2))
    uv[:4] = [(0.0, 0.0), (1.0, 1.0), (0.0, 0.5), (1.0, 0.25)]
    return [single(uv), RNG.integers(0, 6, (COUNT, 1)).astype(np.float64)]


def faces_numbered() -> list[np.ndarray]:
    return [(np.arange(COUNT) % 6).astype(np.float64)[:, None]]


TWINS = {
    "cube_axes": Twin(
        "cube_map_lib.glsl",
        "mat3 axes = cube_axes(int(in_0.x));"
        "result_0.xyz = axes[0]; result_1.xyz = axes[1]; result_2.xyz = axes[2];",
        faces_numbered,
        lambda face: cube_map.FACES[face[:, 0].astype(int)],
        0.0,
        results=3,
    ),
    "cube_direction": Twin(
        "cube_map_lib.glsl",
        "result_0.xyz = cube_direction(in_0.xy, int(in_1.x));",
        places_on_faces,
        lambda uv, face: cube_map.direction_from_uv(uv, face[:, 0].astype(int)),
        # A length of five roundings, and a quotient.
        8 * ULP,
    ),
    "real_harmonic": Twin(
        "irradiance_lib.glsl",
        "for (int i = 0; i < 3; i++) {"
        " result_0[i] = real_harmonic(i, in_0.xyz);"
        " result_1[i] = real_harmonic(i + 3, in_0.xyz);"
        " result_2[i] = real_harmonic(i + 6, in_0.xyz); }",
        lambda: [unit_vectors(42, AXES)],
        lambda direction: real_harmonics(direction, 2),
        # Two steps of some four roundings of numbers up to 1.
        8 * ULP,
        results=3,
    ),
    "real_harmonic of degree 20": Twin(
        "irradiance_lib.glsl",
        "for (int i = 0; i < 3; i++) {"
        " result_0[i] = real_harmonic(400 + i, in_0.xyz);"
        " result_1[i] = real_harmonic(419 + i, in_0.xyz);"
        " result_2[i] = real_harmonic(438 + i, in_0.xyz); }",
        lambda: [unit_vectors(43, AXES)],
        lambda direction: real_harmonics(direction, 20)[:, [400, 401, 402, 419, 420, 421, 438, 439, 440]],
        # At a pole, the harmonic of degree l is 1.8 and grows l (l + 1) / 2 times as fast as z is rounded.
        1.9 * 210 * ULP,
        results=3,
    ),
}


@pytest.mark.parametrize("name", TWINS)
def test_twin(name: str) -> None:
    check(TWINS[name])


def every_texel(size: int, beyond: int) -> np.ndarray:
    """Column, row and face of every texel, and of so many beyond each edge."""
    along = np.arange(-beyond, size + beyond)
    face, row, column = np.meshgrid(np.arange(6), along, along, indexing="ij")
    return np.stack([column, row, face], axis=-1).reshape(-1, 3).astype(np.float64)


def at_every_texel(code: str, size: int, beyond: int) -> np.ndarray:
    """A function's values, shape (faces, rows, columns, 3); `texel` and `face` are known to the code."""
    places = every_texel(size, beyond)
    whole = "ivec2 texel = ivec2(floor(in_0.xy + 0.5)); int face = int(in_0.z + 0.5);"
    found = evaluate("live_environment_lib.glsl", whole + code, [places], samplers=samplers())
    rows = size + 2 * beyond
    return found[:, 0, :3].reshape(6, rows, rows, 3)


@pytest.mark.parametrize("size", [1, 2, 7, 16])
def test_cube_wrap(size: int) -> None:
    found = at_every_texel(f"result_0.xyz = vec3(cube_wrap(texel, face, {size}));", size, size)
    column, row, face = np.moveaxis(every_texel(size, size).astype(int), -1, 0)
    columns, rows, sheet = cube_map.wrap(column, row, face, size, size)
    there = sheet != cube_map.NOWHERE
    expected = np.where(there[:, None], np.stack([columns, rows, sheet], axis=-1), [0, 0, -1])
    np.testing.assert_array_equal(found.reshape(-1, 3), expected)
    assert np.count_nonzero(~there) == 6 * 4 * size**2


def test_bordered_texel() -> None:
    found = at_every_texel(f"result_0.xyz = bordered_texel(strip, texel, face, {SIZE});", SIZE, 1)
    # The mean of three at the corners is rounded; all else is fetched.
    assert np.abs(found - with_borders(FACES.astype(np.float64))).max() < 4 * ULP
    assert np.array_equal(found[:, 1:-1, 1:-1], FACES)


@pytest.mark.parametrize("mip", range(len(MIPS)))
def test_atlas_corner(mip: int) -> None:
    code = (
        f"ivec2 corner = atlas_corner({SIZE}, {mip}, face);"
        "result_0.xyz = texelFetch(atlas, corner + texel, 0).rgb;"
    )
    np.testing.assert_array_equal(at_every_texel(code, SIZE >> mip, 0), MIPS[mip].astype(np.float32))


@pytest.mark.parametrize("mip", range(len(MIPS) - 1))
@pytest.mark.parametrize("name", ["box_halved", "tent_halved"])
def test_halved(name: str, mip: int) -> None:
    textures = "atlas, solid_angles" if name == "tent_halved" else "atlas"
    code = f"result_0.xyz = {name}({textures}, {SIZE}, {mip}, face, texel);"
    expected = getattr(texture_space, name)(MIPS[mip])
    # Sixteen weighted terms and their sum's quotient, of values up to 1; the corners are means of three.
    assert np.abs(at_every_texel(code, SIZE >> (mip + 1), 0) - expected).max() < 24 * ULP


test_box_halved = test_tent_halved = test_halved


def rows_of_harmonics() -> np.ndarray:
    """Shares of every row, shape (6 * SIZE, 9, 3)."""
    row, index = np.meshgrid(np.arange(6 * SIZE), np.arange(9), indexing="ij")
    code = (
        f"int row = int(in_0.x + 0.5); int face = row / {SIZE};"
        f"result_0.xyz = harmonics_of_row(strip, solid_angles, int(in_0.y + 0.5), face, row % {SIZE});"
    )
    arguments = [np.stack([row, index], axis=-1).reshape(-1, 2).astype(np.float64)]
    found = evaluate("live_environment_lib.glsl", code, arguments, samplers=samplers())
    return found[:, 0, :3].reshape(6 * SIZE, 9, 3)


def test_harmonics_of_row() -> None:
    rows = rows_of_harmonics()
    for lit in (0, SIZE + 3, 6 * SIZE - 1):
        alone = np.zeros_like(FACES)
        alone[lit // SIZE, lit % SIZE] = FACES[lit // SIZE, lit % SIZE]
        # Roundings of SIZE terms, each below 1.1 * 0.02 sr.
        assert np.abs(rows[lit] - harmonics_of_faces(alone)).max() < SIZE * 0.022 * 12 * ULP


def test_harmonics_of_rows() -> None:
    shares = single(RNG.normal(size=(6 * SIZE, 9, 3)))
    found = evaluate(
        "live_environment_lib.glsl",
        "result_0.xyz = harmonics_of_rows(rows, int(in_0.x + 0.5));",
        [np.arange(9.0)[:, None]],
        samplers={"rows": ("FLOAT_2D", buffers.texture(texels(shares)))},
    )[:, 0, :3]
    # Each of the running sums is rounded, half a unit of at most the sum of all sizes.
    assert np.abs(found - shares.sum(axis=0)).max() < len(shares) * ULP * np.abs(shares).sum(axis=0).max()
