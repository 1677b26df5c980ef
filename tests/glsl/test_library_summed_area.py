"""The constant-cost antialiased lookup of the shader library against its numpy twin."""

import numpy as np
import pytest
from rsibr.rsibr_addon.core.antialiased.footprint import footprint_box
from rsibr.rsibr_addon.core.antialiased.summed_area import box_mean, summed_area_table
from rsibr.rsibr_addon.core.errors import ShapeError
from rsibr.rsibr_addon.core.geometry.directions import normalize
from rsibr.rsibr_addon.device.summed_area import summed_area_texture
from rsibr.tests.glsl.evaluation import Samplers
from rsibr.tests.glsl.twins import AXES, COUNT, ULP, Twin, check, single, unit_vectors

WIDTH, HEIGHT = 64, 32


def random_table() -> np.ndarray:
    """Dark texels of 1e-3 to 1 in every row, with nine of 1e5, a sun, in the midst of them."""
    radiance = 10.0 ** np.random.default_rng(20).uniform(-3.0, 0.0, (HEIGHT, WIDTH, 3))
    radiance[20:23, 40:43] = 1e5
    return radiance.astype(np.float32)


TABLE = summed_area_table(random_table())


def summed_samplers() -> Samplers:
    return {"table": ("FLOAT_2D_ARRAY", summed_area_texture(TABLE).whole())}


UNIT = "vec3({!r}, {!r}, {!r})".format(*TABLE.unit.tolist())


def footprints() -> list[np.ndarray]:
    """Corners of parallelograms of 1e-3 to 1 about directions; the first are about poles and seam."""
    middle = unit_vectors(1, np.concatenate([AXES, normalize([(-1.0, 1e-4, 0.3), (1e-3, -1e-3, -1.0)])]))
    rng = np.random.default_rng(21)
    size = 10.0 ** rng.uniform(-3.0, 0.0, (COUNT, 1))
    across, up = (size * rng.normal(size=(COUNT, 3)) for _ in range(2))
    return [single(middle + p * across + q * up) for p, q in ((-1, -1), (1, -1), (1, 1), (-1, 1))]


def boxes() -> list[np.ndarray]:
    """Boxes with corners on a lattice of 1/16 texel: single precision holds them in texels, too."""
    rng = np.random.default_rng(22)
    lattice = np.array([16 * WIDTH, 16 * HEIGHT])
    extent = np.ceil(lattice * 10.0 ** rng.uniform(-2.5, 0.0, (COUNT, 2)))
    extent[:100] = lattice
    low = np.floor(rng.random((COUNT, 2)) * (lattice - (0, 1) - extent * (0, 1) + (0, 1)))
    return [np.concatenate([low, low + extent], axis=1) / np.tile(lattice, 2)]


def intervals() -> list[np.ndarray]:
    """Intervals within 0 to 64, some that end on whole numbers, some within one texel."""
    rng = np.random.default_rng(23)
    ends = np.sort(single(rng.random((COUNT, 2)) * WIDTH), axis=1)
    ends[: COUNT // 4] = np.round(ends[: COUNT // 4])
    ends[-COUNT // 4 :, 1] = single(ends[-COUNT // 4 :, 0] + rng.random(COUNT // 4) * 0.5)
    return [np.minimum(ends, WIDTH)]


def cut_by_hand(ends: np.ndarray) -> np.ndarray:
    """Edges of texels, and the parts of the first, of those between and of the last that lie within."""
    low, high = ends.T
    first, last = np.floor(low), np.floor(high)
    edges = np.minimum(np.stack([first, first + 1, last, last + 1], axis=-1), WIDTH)
    parts = np.where(
        (last > first)[:, None],
        np.stack([first + 1 - low, np.ones(COUNT), high - last], axis=-1),
        np.stack([high - low, np.zeros(COUNT), np.zeros(COUNT)], axis=-1),
    )
    return np.stack([edges, np.pad(parts, ((0, 0), (0, 1)))], axis=1)


def places() -> list[np.ndarray]:
    """Columns of two turns, rows and digits."""
    rng = np.random.default_rng(24)
    return [rng.integers(0, (2 * WIDTH + 1, HEIGHT + 1, 3), (COUNT, 3)).astype(np.float64)]


def digit_by_hand(places: np.ndarray) -> np.ndarray:
    column, row, digit = places.astype(np.int64).T
    second = column > WIDTH

    def digits(sums: np.ndarray) -> np.ndarray:
        return (sums >> (21 * digit[:, None])) % 2**21

    return digits(TABLE.sums[row, column - WIDTH * second]) + second[:, None] * digits(TABLE.sums[row, WIDTH])


CORNERS = "vec3 corners[4] = vec3[4](in_0.xyz, in_1.xyz, in_2.xyz, in_3.xyz);"


def within_by_hand(*arguments: np.ndarray) -> np.ndarray:
    """The mean of four corners, by their shares of a square."""
    *corners, place = arguments
    x, y = place[:, :1], place[:, 1:]
    shares = ((1.0 - x) * (1.0 - y), x * (1.0 - y), x * y, (1.0 - x) * y)
    return sum(share * corner for share, corner in zip(shares, corners, strict=True))


TWINS = {
    "footprint_box": Twin(
        "summed_area_lib.glsl",
        f"{CORNERS} result_0 = footprint_box(corners, vec2({WIDTH}, {HEIGHT}));",
        footprints,
        lambda *corners: footprint_box(np.stack(corners, axis=1), WIDTH, HEIGHT),
        3e-6,  # two arc tangents, each 1e-6 at most
    ),
    "within": Twin(
        "summed_area_lib.glsl",
        f"{CORNERS} result_0.xyz = within(corners, in_4.xy);",
        lambda: [*footprints(), single(np.random.default_rng(24).random((COUNT, 2)))],
        within_by_hand,
        4.0 * ULP * 3.0,  # four roundings of directions that are 3 long at most
    ),
    "cut": Twin(
        "summed_area_lib.glsl",
        "ivec4 edges; vec3 weights; cut(in_0.x, in_0.y, 64, edges, weights);"
        "result_0 = vec4(edges); result_1 = vec4(weights, 0.0);",
        intervals,
        cut_by_hand,
        WIDTH * ULP,
        results=2,
    ),
    "digit_at": Twin(
        "summed_area_lib.glsl",
        "ivec3 place = ivec3(in_0.xyz + 0.5);result_0.xyz = digit_at(table, place.x, place.y, place.z);",
        places,
        digit_by_hand,
        0.0,
        samplers=summed_samplers,
    ),
    "box_mean": Twin(
        "summed_area_lib.glsl",
        f"result_0.xyz = box_mean(table, {UNIT}, in_0);",
        boxes,
        lambda box: box_mean(TABLE, box),
        # Relative, beside the sun too: some 20 roundings, and sines good to 3e-6 of themselves.
        lambda box: 1e-5 * box_mean(TABLE, box)[:, None],
        samplers=summed_samplers,
    ),
}


@pytest.mark.parametrize("name", TWINS)
def test_a_function_says_what_its_twin_says(name: str) -> None:
    check(TWINS[name])


def test_the_gpu_wants_three_channels() -> None:
    with pytest.raises(ShapeError, match="red, green and blue, not 1 channels"):
        summed_area_texture(summed_area_table(np.ones((2, 4, 1))))
