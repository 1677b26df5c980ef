"""What a pixel reflects, on the GPU and in numpy."""

import numpy as np
import pytest
from rsibr.rsibr_addon.core.antialiased.footprint import parallelogram
from rsibr.tests.glsl.twins import COUNT, ULP, Twin, check, single, unit_vectors


def sides() -> list[np.ndarray]:
    """Directions, and sides of 1e-4 to 1."""
    rng = np.random.default_rng(51)
    size = 10.0 ** rng.uniform(-4.0, 0.0, (COUNT, 1))
    return [unit_vectors(50), *(single(size * rng.uniform(-1.0, 1.0, (COUNT, 3))) for _ in range(2))]


TWINS = {
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
