"""The functions that lobe stacks are shaded with against their numpy twins."""

from dataclasses import replace

import numpy as np
import pytest
from rsibr.rsibr_addon.core.geometry.directions import dot, normalize, reflect
from rsibr.rsibr_addon.core.geometry.sides import seen_surface
from rsibr.rsibr_addon.core.kinds.lobe_stack.shading import StackLook, stack_radiance
from rsibr.rsibr_addon.core.kinds.lobe_stack.stack import LAYOUTS, LobeStack, stack_representation
from rsibr.rsibr_addon.core.kinds.lobe_stack.sunlight import Sunlight
from rsibr.rsibr_addon.core.lobes.bank import KernelBank
from rsibr.rsibr_addon.core.lobes.fit import lobe_axes
from rsibr.rsibr_addon.core.maps import octahedral
from rsibr.rsibr_addon.core.resample import lookup
from rsibr.rsibr_addon.core.suns import Suns
from rsibr.rsibr_addon.device import buffers
from rsibr.rsibr_addon.device.kinds.lobe_stack import elevation_texels, map_texels, sun_numbers
from rsibr.rsibr_addon.device.textures import GpuTexture
from rsibr.tests.glsl.evaluation import Samplers, evaluate
from rsibr.tests.glsl.twins import AXES, COUNT, ULP, Twin, check, single, unit_vectors
from rsibr.tests.lobe_stacks import random_stack

RNG = np.random.default_rng(31)
SIZE = 16
STACK = random_stack("octahedral", SIZE)
DIAGONALS = normalize([(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 0, 1)])
EDGES = np.concatenate([AXES, DIAGONALS])
NO_SUNS = "LobeSuns(0, 0, 0, 0.0, vec4(0.0))"


def elevations(stack: LobeStack = STACK) -> Samplers:
    return {"elevations": ("FLOAT_2D", buffers.texture(elevation_texels(stack, StackLook().shown(stack))))}


def maps(stack: LobeStack) -> Samplers:
    return {"maps": ("FLOAT_3D", GpuTexture("maps", map_texels(stack), deep=True).whole())}


def cosines() -> np.ndarray:
    """In and beyond what is sampled, the sampled ones among them."""
    return single(np.concatenate([STACK.mu, np.linspace(-0.1, 1.0, COUNT - len(STACK.mu))])[:, None])


def expected_elevation(mu: np.ndarray) -> np.ndarray:
    below, share = STACK.elevation(mu[:, 0])
    return below + share


def offsets() -> np.ndarray:
    """Tilts and turns, tiny ones and none at all among them."""
    large = RNG.uniform(-1.5, 1.5, (COUNT, 2))
    large[: COUNT // 4] *= 10.0 ** RNG.uniform(-7.0, 0.0, (COUNT // 4, 1))
    large[:10] = 0.0
    return single(large)


def expected_place(direction: np.ndarray) -> np.ndarray:
    uv, sheet = stack_representation("dual_paraboloid", SIZE).uv_from_direction(direction)
    return np.c_[uv, sheet]


TWINS = {
    "octahedral_uv": Twin(
        "octahedral_lib.glsl",
        "result_0.xy = octahedral_uv(in_0.xyz);",
        lambda: [unit_vectors(32, np.concatenate([np.eye(3), -np.eye(3)[:2], DIAGONALS]))],
        octahedral.uv_from_direction,
        # A sum, a quotient, a difference from 1 and a half of values up to 2.
        8 * ULP,
    ),
    "dual_paraboloid_place": Twin(
        "dual_paraboloid_lib.glsl",
        f"result_0.xyz = dual_paraboloid_place(in_0.xyz, {(SIZE - 1) / SIZE});",
        lambda: [unit_vectors(33, EDGES)],
        expected_place,
        6 * ULP,
    ),
    "elevation_at": Twin(
        "lobe_stack_lib.glsl",
        "vec2 e = elevation_at(elevations, in_0.x); result_0.x = e.x + e.y;",
        lambda: [cosines()],
        expected_elevation,
        # The table's cosines are rounded, by 2^-24; elevations lie 0.1 apart at least. And a sum up to 4.
        (2 / 0.1 + 8) * ULP,
        samplers=elevations,
    ),
    "elevation_value": Twin(
        "lobe_stack_lib.glsl",
        "result_0.xyz = elevation_value(elevations, 2, elevation_at(elevations, in_0.x));",
        lambda: [cosines()],
        lambda mu: np.stack(
            [
                np.interp(mu[:, 0], STACK.mu, column)
                for column in (*STACK.offsets[0, :, 0].T, STACK.taps[0, :, 0])
            ],
            axis=-1,
        ),
        # As above, times what neighbours differ by, at most 0.8; and the rounding of the values.
        (0.8 * (2 / 0.1 + 8) + 4) * ULP,
        samplers=elevations,
    ),
    "lobe_axis": Twin(
        "lobe_stack_lib.glsl",
        "result_0.xyz = lobe_axis(in_0.xyz, in_1.xyz, in_2.xy);",
        lambda: [unit_vectors(34), unit_vectors(35), offsets()],
        lobe_axes,
        # Products and sums of values up to 2.1 in four stages; sine and cosine of the hardware are good to
        # 2^-21 of their argument's range here.
        1e-6,
    ),
    "tilted_axes": Twin(
        "lobe_stack_lib.glsl",
        "vec3 axes[4]; tilted_axes(in_0.xyz, in_1.xyz, in_2, axes);"
        + "".join(f"result_{n}.xyz = axes[{n}];" for n in range(4)),
        lambda: [unit_vectors(34), unit_vectors(35), np.hstack([offsets(), offsets()])],
        lambda normal, mirror_dir, tilts: lobe_axes(
            normal[:, None], mirror_dir[:, None], np.stack([tilts, 0.0 * tilts], axis=-1)
        ),
        # As `lobe_axis`; the tangent's direction is lost as far as the normal is near the mirror direction
        1e-6,
        results=4,
    ),
    "stack_place": Twin(
        "lobe_stack_lib.glsl",
        f"result_0.xyz = stack_place(LAYOUT_DUAL_PARABOLOID, {SIZE}.0, in_0.xyz);"
        f"result_1.xyz = stack_place(LAYOUT_OCTAHEDRAL, {SIZE}.0, in_0.xyz);",
        lambda: [unit_vectors(36, np.concatenate([np.eye(3), -np.eye(3)[:2], DIAGONALS]))],
        lambda direction: np.stack(
            [
                expected_place(direction),
                np.c_[octahedral.uv_from_direction(direction), np.zeros(len(direction))],
            ],
            axis=1,
        ),
        8 * ULP,
        results=2,
    ),
}


@pytest.mark.parametrize("name", TWINS)
def test_twin(name: str) -> None:
    check(TWINS[name])


@pytest.mark.parametrize("layout", LAYOUTS)
@pytest.mark.parametrize("lobe", [0, 2])
@pytest.mark.parametrize("number", [0, 1, 4])
def test_map_radiance(layout: str, lobe: int, number: int) -> None:
    stack = random_stack(layout, SIZE)
    axis = unit_vectors(37, EDGES)
    code = (
        f"result_0.rgb = map_radiance(maps, {LAYOUTS.index(layout)}, 5, {lobe}, in_0.xyz, {number}.0);"
        f"result_1.rgb = map_radiance(maps, {LAYOUTS.index(layout)}, 5, {lobe}, in_0.xyz, {number}.25);"
    )
    found = evaluate("lobe_stack_lib.glsl", code, [axis], 2, maps(stack))
    here, above = (
        lookup(stack.maps[lobe, min(number + step, 4)], axis, stack.representation) for step in (0, 1)
    )
    # Weights may be rounded to 8 bits along three axes: 3 / 512 of differences up to 1.2.
    assert np.abs(found[:, 0, :3] - here).max() < 8e-3
    assert np.abs(found[:, 1, :3] - (0.75 * here + 0.25 * above)).max() < 8e-3


@pytest.mark.parametrize("layout", LAYOUTS)
@pytest.mark.parametrize("shared", [False, True])
def test_stack_radiance(layout: str, shared: bool) -> None:
    stack = random_stack(layout, SIZE, shared)
    normal, view_dir = unit_vectors(38), unit_vectors(39)
    # Where the hemispheres meet, rounding decides which sheet shows an axis; both show the same there, up to
    # interpolation, but not of texels without a pattern.
    facing = seen_surface(normal, view_dir).mirror_normal
    mirror_dir = reflect(view_dir, facing)
    below, share = stack.elevation(dot(facing, view_dir))
    above = np.minimum(below + 1, 4)
    mixed = (1.0 - share)[:, None, None, None] * stack.offsets[:, below].swapaxes(0, 1)
    mixed += share[:, None, None, None] * stack.offsets[:, above].swapaxes(0, 1)
    axes = lobe_axes(facing[:, None, None], mirror_dir[:, None, None], mixed)
    clear = np.all(np.abs(axes @ stack.representation.frame[:, 2]) > 1e-5, axis=(1, 2))
    code = (
        f"result_0.rgb = stack_radiance(maps, elevations, {LAYOUTS.index(layout)}, 3, 2, "
        f"{1 if shared else 5}, {NO_SUNS}, in_0.xyz, in_1.xyz, vec3(0.0), vec3(0.0));"
    )
    found = evaluate("lobe_stack_lib.glsl", code, [facing, view_dir], 1, maps(stack) | elevations(stack))
    expected = stack_radiance(stack, normal, view_dir, StackLook())
    # As above, times scales and taps, which sum to 3.
    assert np.abs(found[:, 0, :3] - expected)[clear].max() < 3 * 8e-3
    assert np.count_nonzero(clear) > 0.99 * COUNT


def sunlit(shared: bool) -> LobeStack:
    """Two suns and kernels about as wide as lobes' axes are far from them."""
    rng = np.random.default_rng(44)
    weights = rng.uniform(-0.2, 1.0, (3, 1 if shared else 5, 3, 3))
    suns = Suns(
        normalize([(1.0, 2.0, 3.0), (-3.0, 1.0, -1.0)]), rng.uniform(1.0, 2.0, (2, 3)), np.ones(3), 0.1
    )
    sunlight = Sunlight(suns, KernelBank((200.0, 800.0, 65536.0)), weights)
    return replace(random_stack("octahedral", SIZE, shared), sunlight=sunlight)


def near_suns(stack: LobeStack) -> np.ndarray:
    """Directions at all distances from suns, and some on them."""
    suns = stack.sunlight.suns.direction[np.arange(COUNT) % 2]
    rng = np.random.default_rng(45)
    away = 10.0 ** rng.uniform(-4.0, -0.5, (COUNT, 1))
    away[:10] = 0.0
    return single(normalize(suns + away * unit_vectors(43)))


def suns_of(stack: LobeStack) -> str:
    (*counts, reach), cone = sun_numbers(stack).tolist()
    return "LobeSuns({:.0f}, {:.0f}, {:.0f}, {}, vec4({}, {}, {}, {}))".format(*counts, reach, *cone)


@pytest.mark.parametrize("shared", [False, True])
def test_lobe_sunlight(shared: bool) -> None:
    stack = sunlit(shared)
    axis, mu = near_suns(stack), cosines()
    code = (
        f"result_0.rgb = lobe_sunlight(elevations, {suns_of(stack)}, 2, in_0.xyz, "
        "elevation_at(elevations, in_1.x));"
    )
    found = evaluate("lobe_stack_lib.glsl", code, [axis, mu], 1, elevations(stack))[:, 0, :3]
    expected = stack.sunlight.along(2, axis, *stack.elevation(mu[:, 0]))
    # An axis is rounded by 2^-24, which a kernel of width 1 / sqrt(65536) shows 256 times as large
    scale = np.abs(stack.sunlight.along(2, stack.sunlight.suns.direction[:1], *stack.elevation([0.5]))).max()
    assert np.abs(found - expected).max() < 256 * 8 * ULP * scale
    assert np.count_nonzero(np.any(expected, axis=1)) > COUNT / 4


def test_stack_radiance_with_suns() -> None:
    stack = sunlit(False)
    stack.maps[:] = 0.0
    normal = unit_vectors(38)
    mirror_dir = near_suns(stack)
    normal = single(normal * np.sign(dot(normal, mirror_dir))[:, None])
    view_dir = single(reflect(mirror_dir, normal))
    facing = seen_surface(normal, view_dir).mirror_normal
    code = (
        f"result_0.rgb = stack_radiance(maps, elevations, {LAYOUTS.index('octahedral')}, 3, 2, 5, "
        f"{suns_of(stack)}, in_0.xyz, in_1.xyz, vec3(0.0), vec3(0.0));"
    )
    found = evaluate("lobe_stack_lib.glsl", code, [facing, view_dir], 1, maps(stack) | elevations(stack))
    expected = stack_radiance(stack, normal, view_dir, StackLook())
    assert np.count_nonzero(np.any(expected, axis=1)) > COUNT / 20
    # As above, and axes are good to 1e-6
    np.testing.assert_allclose(found[:, 0, :3], expected, rtol=1e-3, atol=256 * 4e-6 * expected.max())


@pytest.mark.parametrize("layout", LAYOUTS)
def test_stack_texel_angle(layout: str) -> None:
    direction = unit_vectors(42, EDGES)
    code = f"result_0.x = stack_texel_angle({LAYOUTS.index(layout)}, {SIZE}.0, in_0.xyz);"
    found = evaluate("lobe_stack_lib.glsl", code, [direction])[:, 0, 0]
    expected = random_stack(layout, SIZE).texel_angle(direction)
    # Sums of up to 2, a root, two products and a quotient.
    np.testing.assert_allclose(found, expected, rtol=16 * ULP)


@pytest.mark.parametrize("layout", LAYOUTS)
def test_maps_are_uploaded_with_what_continues_them(layout: str) -> None:
    stack = random_stack(layout, SIZE)
    texels = map_texels(stack)
    sheets = stack.maps.shape[2]
    assert texels.shape == (3 * sheets * 5, SIZE + 2, SIZE + 2, 4)
    last = texels[(2 * sheets + sheets - 1) * 5 + 3]
    np.testing.assert_array_equal(last[1:-1, 1:-1, :3], stack.maps[2, 3, -1])
    beyond = stack.maps[2, 3, -1, 4, 0] if layout == "dual_paraboloid" else stack.maps[2, 3, 0, -5, 0]
    np.testing.assert_array_equal(last[5, 0, :3], beyond)
