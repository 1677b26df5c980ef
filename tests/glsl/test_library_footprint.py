"""What a pixel reflects, on the GPU and in numpy."""

import numpy as np
import pytest
from rsibr.rsibr_addon.core.antialiased.footprint import parallelogram
from rsibr.rsibr_addon.core.antialiased.sampling import MOST, sample_counts, sample_direction
from rsibr.tests.glsl.evaluation import WIDTH, evaluate
from rsibr.tests.glsl.twins import COUNT, ULP, Twin, check, single, unit_vectors


def sides() -> list[np.ndarray]:
    """Directions, and sides of 1e-4 to 1."""
    rng = np.random.default_rng(51)
    size = 10.0 ** rng.uniform(-4.0, 0.0, (COUNT, 1))
    return [unit_vectors(50), *(single(size * rng.uniform(-1.0, 1.0, (COUNT, 3))) for _ in range(2))]


def sides_and_counts() -> list[np.ndarray]:
    """The same, with counts, and the number of a lookup that there is."""
    counts = np.random.default_rng(52).integers(1, MOST + 1, (COUNT, 2))
    number = np.random.default_rng(53).integers(0, np.prod(counts, axis=-1))
    return [*sides(), np.c_[counts, number].astype(np.float64)]


def counts_error(across: np.ndarray, up: np.ndarray, texel: np.ndarray) -> np.ndarray:
    """One where a side is whole texels long, but for roundings."""
    ratio = np.linalg.norm(np.stack([across, up], axis=1), axis=-1) / texel
    return (np.abs(ratio - np.round(ratio)) < 1e-5 * ratio)[:, None]


def expected_direction(
    middle: np.ndarray, across: np.ndarray, up: np.ndarray, more: np.ndarray
) -> np.ndarray:
    expected = np.empty_like(middle)
    for number in range(MOST**2):
        own = more[:, 2] == number
        expected[own] = sample_direction(middle[own], across[own], up[own], more[own, :2].astype(int), number)
    return expected


TWINS = {
    "sample_counts": Twin(
        "footprint_lib.glsl",
        "result_0.xy = vec2(sample_counts(in_0.xyz, in_1.xyz, in_2.x));",
        lambda: [*sides()[1:], single(10.0 ** np.random.default_rng(54).uniform(-2.0, 0.0, (COUNT, 1)))],
        lambda across, up, texel: sample_counts(across, up, texel[:, 0]),
        counts_error,
    ),
    "sample_direction": Twin(
        "footprint_lib.glsl",
        "result_0.xyz = sample_direction(in_0.xyz, in_1.xyz, in_2.xyz, ivec2(in_3.xy), int(in_3.z));",
        sides_and_counts,
        expected_direction,
        # As the docstring has it; sums of up to 3 are divided by their length, .1 and more.
        lambda middle, across, up, more: np.full((len(middle), 1, 1), 5e-6),
    ),
    "parallelogram": Twin(
        "footprint_lib.glsl",
        "vec3 corners[4]; parallelogram(in_0.xyz, in_1.xyz, in_2.xyz, corners);"
        + " ".join(f"result_{i}.xyz = corners[{i}];" for i in range(4)),
        sides,
        parallelogram,
        # Two sums of up to 2.
        4 * ULP,
        results=4,
    ),
}


@pytest.mark.parametrize("name", TWINS)
def test_a_function_says_what_its_twin_says(name: str) -> None:
    check(TWINS[name])


def test_pixel_sides() -> None:
    code = """
        vec3 direction = vec3(gl_FragCoord.x, 4.0 * gl_FragCoord.y, 1.0);
        pixel_sides(direction, in_0.x, result_0.xyz, result_1.xyz);
    """
    found = evaluate("footprint_lib.glsl", code, [np.repeat([[0.0], [1.0]], 1024, axis=0)], results=2)
    np.testing.assert_array_equal(found[:1024], np.zeros((1024, 2, 4)))
    np.testing.assert_array_equal(found[1024:, :, :2], np.broadcast_to(np.diag([1.0, 4.0]), (1024, 2, 2)))


def test_pixel_sides_of_a_place() -> None:
    code = """
        vec2 place = vec2(gl_FragCoord.x, 4.0 * gl_FragCoord.y);
        pixel_sides(place, result_0.xy, result_1.xy);
    """
    found = evaluate("footprint_lib.glsl", code, [np.zeros((1024, 1))], results=2)
    np.testing.assert_array_equal(found[..., :2], np.broadcast_to(np.diag([1.0, 4.0]), (1024, 2, 2)))


def test_to_neighbours() -> None:
    found = evaluate("footprint_lib.glsl", "result_0.xy = to_neighbours();", [np.zeros((1024, 1))])
    row, column = np.divmod(np.arange(1024), WIDTH)
    np.testing.assert_array_equal(found[:, 0, 0], np.where(column % 2 == 0, 1.0, -1.0))
    np.testing.assert_array_equal(found[:, 0, 1], np.where(row % 2 == 0, 1.0, -1.0))


def test_sample_sides() -> None:
    code = """
        vec2 to = to_neighbours();
        vec3 here = vec3(gl_FragCoord.x, 4.0 * gl_FragCoord.y, 1.0);
        vec3 beside = here + vec3(to.x, 0.0, 0.0);
        vec3 above = here + vec3(0.0, 4.0 * to.y, 0.0);
        sample_sides(here, beside, above, in_0.x, result_0.xyz, result_1.xyz);
    """
    found = evaluate("footprint_lib.glsl", code, [np.repeat([[0.0], [1.0]], 1024, axis=0)], results=2)
    np.testing.assert_array_equal(found[:1024], np.zeros((1024, 2, 4)))
    np.testing.assert_array_equal(found[1024:, :, :2], np.broadcast_to(np.diag([1.0, 4.0]), (1024, 2, 2)))
