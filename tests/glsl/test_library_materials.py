"""The functions that materials' normals are made with against their numpy twins."""

import numpy as np
import pytest
from rsibr.rsibr_addon.core.antialiased import spread
from rsibr.rsibr_addon.core.materials import normals
from rsibr.tests.glsl.twins import COUNT, ULP, Twin, check, single, unit_vectors


def numbers(seed: int, columns: int = 1, low: float = 0.0, high: float = 1.0) -> np.ndarray:
    return single(np.random.default_rng(seed).uniform(low, high, (COUNT, columns)))


def unit(seed: int) -> np.ndarray:
    return single(unit_vectors(seed))


def steps(seed: int) -> np.ndarray:
    return numbers(seed, 3, -1.0, 1.0)


TWINS = {
    "unit_or": Twin(
        "shading_normal_lib.glsl",
        "result_0.xyz = unit_or(in_0.xyz, in_1.xyz);",
        lambda: [np.where(numbers(1) < 0.5, 0.0, steps(2)).astype(np.float32), unit(3)],
        normals._unit_or,
        4 * ULP,
    ),
    "mapped_normal": Twin(
        "shading_normal_lib.glsl",
        "result_0.xyz = mapped_normal(in_0.rgb, in_1.x, in_2.xyz, in_3);",
        lambda: [
            numbers(4, 3, 0.1, 0.9),
            numbers(5, 1, 0.0, 2.0),
            unit(6),
            np.hstack([unit(7), np.sign(steps(8)[:, :1])]),
        ],
        normals.mapped_normal,
        # A normal that almost vanishes, between a tangent and a normal that are no right angle apart
        1e-3,
    ),
    "bumped_normal": Twin(
        "shading_normal_lib.glsl",
        "result_0.xyz = bumped_normal(in_0.xyz, in_1.xyz, in_2.xyz, in_3.xy, in_4.x);",
        lambda: [unit(9), steps(10), steps(11), numbers(12, 2, -1.0, 1.0), numbers(13)],
        lambda normal, right, above, rises, strength: normals.bumped_normal(
            normal, [right, above], [rises[:, :1], rises[:, 1:]], strength
        ),
        # Steps that almost lie in one line with the normal, whose area is a difference of larger numbers
        5e-3,
    ),
    "pixel_spread": Twin(
        "spread_lib.glsl",
        "result_0.x = pixel_spread(in_0.xyz, in_1.xyz);",
        lambda: [steps(14), steps(15)],
        spread.pixel_spread,
        8 * ULP,
    ),
    "mean_spread": Twin(
        "spread_lib.glsl",
        "result_0.x = mean_spread(in_0.xyz, 0.01);",
        lambda: [single(unit(16) * numbers(17, 1, 0.1, 1.0))],
        lambda mean: spread.mean_spread(mean, 0.01),
        # A length's roundings over a tenth
        100 * ULP,
    ),
    "widened_roughness": Twin(
        "spread_lib.glsl",
        "result_0.x = widened_roughness(in_0.x, in_1.x);",
        lambda: [numbers(18), numbers(19)],
        lambda roughness, added: spread.widened_roughness(roughness[:, 0], added[:, 0]),
        8 * ULP,
    ),
}


@pytest.mark.parametrize("name", TWINS)
def test_functions_are_as_their_twins(name: str) -> None:
    check(TWINS[name])


def test_roughness_of_facets_that_spread_is_as_their_mean() -> None:
    """Slopes that vary evenly within a pixel have the spread of their mean's length, for small ones."""
    place = (np.arange(64) + 0.5) / 64 - 0.5
    across, up = np.array([0.1, 0.02, 0.0]), np.array([-0.03, 0.06, 0.0])
    facets = [0.0, 0.0, 1.0] + place[:, None, None] * across + place[:, None] * up
    facets /= np.linalg.norm(facets, axis=-1, keepdims=True)
    by_mean = spread.mean_spread(facets.mean(axis=(0, 1)))
    np.testing.assert_allclose(spread.pixel_spread(across, up), by_mean, rtol=0.01)
    assert spread.mean_spread([0.0, 0.0, 0.997], rounding=1.0 / 255.0) == 0.0
    assert spread.widened_roughness(1.0, by_mean) == 1.0
    assert spread.widened_roughness(0.3, 0.0) == pytest.approx(0.3)
