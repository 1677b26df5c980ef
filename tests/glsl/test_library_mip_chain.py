"""The functions that mip chains are shaded with against their numpy twins."""

import numpy as np
import pytest
from rsibr.rsibr_addon.core.antialiased.footprint import parallelogram
from rsibr.rsibr_addon.core.brdf.fresnel import fresnel_schlick
from rsibr.rsibr_addon.core.filtering.irradiance import irradiance_from_harmonics, real_harmonics
from rsibr.rsibr_addon.core.filtering.radial_lobes import cosine_lobe
from rsibr.rsibr_addon.core.filtering.zonal import zonal_coefficients
from rsibr.rsibr_addon.core.geometry.directions import normalize
from rsibr.rsibr_addon.core.geometry.near_room import Room, near_direction, outside_distance
from rsibr.rsibr_addon.core.kinds.mip_chain.chain import MipChain
from rsibr.rsibr_addon.core.kinds.mip_chain.near_diffuse import cosine_lobes
from rsibr.rsibr_addon.core.kinds.mip_chain.probes import Place
from rsibr.rsibr_addon.core.kinds.mip_chain.shading import Borders, glossy_mean, glossy_radiance
from rsibr.rsibr_addon.core.kinds.mip_chain.texture_space import filtered_mips, tent_halved
from rsibr.rsibr_addon.core.maps import cube_map
from rsibr.rsibr_addon.device import buffers
from rsibr.rsibr_addon.device.kinds.mip_chain import atlas_texels, harmonics_texels
from rsibr.rsibr_addon.device.kinds.mip_chain_shaders import place_rows
from rsibr.tests.glsl.evaluation import Samplers, evaluate
from rsibr.tests.glsl.twins import COUNT, ULP, Twin, check, single, unit_vectors

RNG = np.random.default_rng(21)
NINE = np.float32(RNG.normal(size=(9, 3))).astype(np.float64)

CORNERS = normalize([(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)])
EDGES = normalize([(1.0, 1.0, 0.3), (-1.0, 0.2, 1.0), (0.1, -1.0, -1.0), (1.0, -1.0, 0.0)])


def random_chain() -> MipChain:
    """Texels that differ by 1 from their neighbours, in the first mips at least."""
    faces = np.random.default_rng(22).random((6, 16, 16, 3), dtype=np.float32)
    mips = tuple(mip.astype(np.float32) for mip in filtered_mips(faces, tent_halved))
    return MipChain(mips, NINE)


CHAIN = random_chain()


def atlas() -> Samplers:
    return {"atlas": ("FLOAT_2D", buffers.texture(atlas_texels(CHAIN)))}


def cosines() -> np.ndarray:
    return single(np.linspace(0.0, 1.0, COUNT)[:, None])


def in_a_room() -> list[np.ndarray]:
    """Points in a room, none of them close to a wall, and directions."""
    inside = np.random.default_rng(30).uniform(-0.5, 0.5, (COUNT, 3)) * (2.0, 1.5, 1.0)
    return [single(inside + (0.25, 0.0, -0.25)), unit_vectors(31)]


PLACES = (
    Place((0.5, -0.25, 0.0), Room.BOX, (4.0, 3.0, 2.0), (0.25, 0.0, -0.25), 0.5),
    Place((0.0, 0.25, 0.5), Room.SPHERE, (3.0, 2.0, 4.0), (-0.5, 0.0, 0.0), 1.0),
)


def places() -> Samplers:
    rows = np.array([place_rows(place) for place in PLACES], dtype=np.float32)
    return {"places": ("FLOAT_2D", buffers.texture(rows))}


def about_a_room() -> list[np.ndarray]:
    """Points within a room and around it."""
    return [single(np.random.default_rng(33).uniform(-4.0, 4.0, (COUNT, 3)))]


def lobes_of_a_cosine(normal: np.ndarray, number: np.ndarray) -> np.ndarray:
    """Axis and share of one lobe of each normal."""
    found = np.empty((COUNT, 4))
    for place, (direction, share) in enumerate(cosine_lobes(normal)):
        chosen = number[:, 0] == place
        found[chosen, :3], found[chosen, 3] = direction[chosen], share
    return found


def diffuse_in_a_room(position: np.ndarray, normal: np.ndarray) -> np.ndarray:
    light = np.zeros((COUNT, 3))
    for towards, share in cosine_lobes(normal):
        direction = near_direction(position, towards, Room.BOX, (2.0, 1.5, 1.0), (0.25, 0.0, -0.25))
        light += share * glossy_radiance(CHAIN, direction, 1.5, Borders.SEAMLESS)
    return light


def of_degree(degree: int) -> np.ndarray:
    """Coefficients as of an environment with a small lamp: equally large in every degree."""
    return np.random.default_rng(degree).normal(size=((degree + 1) ** 2, 3))


def coefficients(degree: int) -> Samplers:
    return {"coefficients": ("FLOAT_2D", buffers.texture(harmonics_texels(of_degree(degree))))}


def zonal_harmonics(direction: np.ndarray) -> np.ndarray:
    """Those of order 0 and degrees 19 and 20."""
    return real_harmonics(direction, 20)[:, [19 * 20, 20 * 21]]


def third_powers(direction: np.ndarray) -> np.ndarray:
    """The harmonic of degree and order 3 without sin^3 cos(3 phi), and (x + i y)^3."""
    power = (direction[:, 0] + 1j * direction[:, 1]) ** 3
    return np.stack([np.full(len(power), np.sqrt(35.0 / (64.0 * np.pi))), power.real, power.imag], axis=-1)


def expected_place(direction: np.ndarray) -> np.ndarray:
    uv, face = cube_map.uv_from_direction(direction)
    return np.c_[uv, face]


TWINS = {
    "fresnel_schlick": Twin(
        "fresnel_lib.glsl",
        "result_0.xyz = fresnel_schlick(in_0.x, in_1.xyz);",
        lambda: [cosines(), single(RNG.random((COUNT, 3)))],
        lambda cosine, f0: fresnel_schlick(cosine, f0),
        # Some eight operations on values up to 1.
        8 * ULP,
    ),
    **{
        f"irradiance of degree {degree}": Twin(
            "irradiance_lib.glsl",
            "result_0.xyz = irradiance(coefficients, in_0.xyz);",
            lambda: [unit_vectors(23)],
            lambda normal, degree=degree: irradiance_from_harmonics(of_degree(degree), normal),
            # As the docstring has it: roundings, and |n|^2 - 1 of a rounded normal.
            2e-6 * np.abs(of_degree(degree)).sum(),
            samplers=lambda degree=degree: coefficients(degree),
        )
        for degree in (0, 1, 2, 3, 8, 20)
    },
    "harmonics_degree": Twin(
        "irradiance_lib.glsl",
        "result_0.x = float(harmonics_degree(coefficients));",
        lambda: [unit_vectors(23)],
        lambda normal: np.full((COUNT, 1), 20.0),
        0.0,
        samplers=lambda: coefficients(20),
    ),
    "next_degree": Twin(
        "irradiance_lib.glsl",
        "float a = 1.0; vec2 values = vec2(0.0, FIRST_HARMONIC);"
        "for (int l = 1; l <= 20; l++) { next_degree(l, 0, in_0.z, values, a); } result_0.xy = values;",
        lambda: [unit_vectors(23)],
        zonal_harmonics,
        # At a pole, the harmonic of degree l is 1.8 and grows l (l + 1) / 2 times as fast as z is rounded.
        1.9 * 210 * ULP,
    ),
    "next_order": Twin(
        "irradiance_lib.glsl",
        "float sectoral = FIRST_HARMONIC; vec2 power = vec2(1.0, 0.0);"
        "for (int m = 0; m < 3; m++) { next_order(m, in_0.xyz, sectoral, power); }"
        "result_0.xyz = vec3(sectoral, power);",
        lambda: [unit_vectors(23)],
        third_powers,
        # Three steps of some four roundings, of values up to 1.
        12 * ULP,
    ),
    "cosine_coefficient": Twin(
        "irradiance_lib.glsl",
        "result_0.x = cosine_coefficient(int(in_0.x));",
        lambda: [(np.arange(COUNT) % 21)[:, None].astype(np.float64)],
        lambda degree: zonal_coefficients(cosine_lobe(), 20)[degree.astype(int)],
        8 * ULP * np.pi,
    ),
    **{
        f"near_direction {room}": Twin(
            "near_room_lib.glsl",
            "vec3 half_size = vec3(2.0, 1.5, 1.0), middle = vec3(0.25, 0.0, -0.25);"
            f"result_0.xyz = near_direction(in_0.xyz, in_1.xyz, {number}.0, half_size, middle);",
            in_a_room,
            lambda position, direction, room=room: near_direction(
                position, direction, room, (2.0, 1.5, 1.0), (0.25, 0.0, -0.25)
            ),
            # A quotient of a distance up to 6 by what the wall is away from the map's point, at least 0.5
            12 * 12 * ULP,
        )
        for number, room in enumerate(Room)
    },
    **{
        f"outside_distance {room}": Twin(
            "near_room_lib.glsl",
            f"result_0.x = outside_distance(in_0.xyz, {number}.0, vec3(2.0, 1.5, 1.0));",
            about_a_room,
            lambda place, room=room: outside_distance(place, room, (2.0, 1.5, 1.0))[:, None],
            # Lengths up to 7, of some roundings
            7 * 8 * ULP,
        )
        for number, room in enumerate(Room)
        if room is not Room.DISTANT
    },
    "probe_place": Twin(
        "probes_lib.glsl",
        "Place place = probe_place(places, int(in_0.x + 0.5));"
        "result_0 = vec4(place.half_size, place.room); result_1 = vec4(place.middle, place.blend);"
        "result_2 = vec4(place.captured_at, 0.0);",
        lambda: [(np.arange(COUNT) % len(PLACES))[:, None].astype(np.float64)],
        lambda number: np.array([*map(place_rows, PLACES)])[number[:, 0].astype(int)],
        0.0,
        results=3,
        samplers=places,
    ),
    "probe_weight": Twin(
        "probes_lib.glsl",
        "result_0.xy = vec2(probe_weight(probe_place(places, 0), in_0.xyz),"
        " probe_weight(probe_place(places, 1), in_0.xyz));",
        about_a_room,
        lambda position: np.stack([place.weight(position) for place in PLACES], axis=-1),
        # Lengths up to 10, of some roundings, over the blend
        10 * 8 * ULP / 0.5,
        samplers=places,
    ),
    "near_diffuse": Twin(
        "near_diffuse_lib.glsl",
        "Place place = Place(vec3(0.0), BOX, vec3(2.0, 1.5, 1.0), vec3(0.25, 0.0, -0.25), 1.0);"
        "result_0.xyz = near_diffuse(atlas, 0.0, 1.5, place, in_0.xyz, in_1.xyz);",
        in_a_room,
        diffuse_in_a_room,
        # As of glossy radiance, of places 1e-5 off
        2.0 / 256.0 + 16 * 1e-4,
        samplers=atlas,
    ),
    "cosine_lobe": Twin(
        "near_diffuse_lib.glsl",
        "result_0 = cosine_lobe(in_0.xyz, int(in_1.x + 0.5));",
        lambda: [unit_vectors(25), (np.arange(COUNT) % 14)[:, None].astype(np.float64)],
        lobes_of_a_cosine,
        # Sines, cosines and a frame, each good to some roundings
        4e-6,
    ),
    "cube_place": Twin(
        "cube_map_lib.glsl",
        "result_0.xyz = cube_place(in_0.xyz);",
        lambda: [unit_vectors(24, np.concatenate([np.eye(3), -np.eye(3), CORNERS, EDGES]))],
        expected_place,
        # A quotient up to 1, halved, and a sum.
        3 * ULP,
    ),
    "cube_texel_angle": Twin(
        "cube_map_lib.glsl",
        "result_0.x = cube_texel_angle(in_0.xyz, 32.0);",
        lambda: [unit_vectors(27, np.concatenate([np.eye(3), -np.eye(3), CORNERS, EDGES]))],
        lambda direction: cube_map.texel_angle(direction, 32)[:, None],
        # A root, two products and a quotient.
        8 * ULP * 2.0 / 32,
    ),
}


@pytest.mark.parametrize("name", TWINS)
def test_twin(name: str) -> None:
    check(TWINS[name])


@pytest.mark.parametrize("borders", Borders)
@pytest.mark.parametrize("mip", range(len(CHAIN.mips)))
def test_mip_radiance(borders: Borders, mip: int) -> None:
    clamped = str(borders is Borders.CLAMPED).lower()
    direction = unit_vectors(25, np.concatenate([CORNERS, EDGES]))
    code = f"result_0.rgb = mip_radiance(atlas, 0.0, {mip}, cube_place(in_0.xyz), {clamped});"
    found = evaluate("mip_chain_lib.glsl", code, [direction], samplers=atlas())[:, 0, :3]
    expected = glossy_radiance(CHAIN, direction, float(mip), borders)
    # Weights of texels may be rounded to 8 bits, both ways: 2 / 512 of differences up to 1.
    assert np.abs(found - expected).max() < 5e-3


@pytest.mark.parametrize("level", [0.0, 0.25, 2.7, 4.0])
def test_glossy_radiance(level: float) -> None:
    direction = unit_vectors(26, np.concatenate([CORNERS, EDGES]))
    code = f"result_0.rgb = glossy_radiance(atlas, 0.0, in_0.xyz, {level}, false);"
    found = evaluate("mip_chain_lib.glsl", code, [direction], samplers=atlas())[:, 0, :3]
    assert np.abs(found - glossy_radiance(CHAIN, direction, level, Borders.SEAMLESS)).max() < 5e-3


@pytest.mark.parametrize("level", [0.0, 1.3])
def test_glossy_mean(level: float) -> None:
    direction = unit_vectors(28, np.concatenate([CORNERS, EDGES]))
    rng = np.random.default_rng(29)
    size = 10.0 ** rng.uniform(-3.0, 0.3, (COUNT, 1))
    across, up = (single(size * rng.normal(size=(COUNT, 3))) for _ in range(2))
    code = f"result_0.rgb = glossy_mean(atlas, 0.0, in_0.xyz, in_1.xyz, in_2.xyz, {level}, 4.0, false);"
    found = evaluate("mip_chain_lib.glsl", code, [direction, across, up], samplers=atlas())[:, 0, :3]
    corners = parallelogram(direction, across, up)
    expected = glossy_mean(CHAIN, direction, corners, level, Borders.SEAMLESS)
    # As of single lookups; a side of whole texels may count one lookup more or less, which none of these is.
    assert np.abs(found - expected).max() < 5e-3
