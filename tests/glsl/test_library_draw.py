"""What all meshes are drawn with: GLSL against its numpy twin."""

import numpy as np
import pytest
from rsibr.rsibr_addon.core.geometry.directions import normalize
from rsibr.rsibr_addon.device.drawing import LEAST_STRENGTH
from rsibr.tests.glsl.twins import COUNT, ULP, Twin, check, single, unit_vectors


def eyes() -> np.ndarray:
    """Homogeneous eyes: directions, and positions at least half a radius above the unit sphere."""
    rng = np.random.default_rng(5)
    at_infinity = rng.random(COUNT) < 0.5
    distance = np.where(at_infinity, 1.0, 10.0 ** rng.uniform(np.log10(1.5), 2.0, COUNT))
    return single(np.c_[unit_vectors(1) * distance[:, None], np.where(at_infinity, 0.0, 1.0)])


def inner_points() -> np.ndarray:
    """Points of the unit ball."""
    return single(unit_vectors(2) * np.random.default_rng(6).random((COUNT, 1)))


def emitted(emission: np.ndarray, strength: np.ndarray) -> np.ndarray:
    return emission / np.maximum(strength[:, :1], LEAST_STRENGTH)


TWINS = {
    "view_direction": Twin(
        "draw_lib.glsl",
        "result_0.xyz = view_direction(in_0, in_1.xyz);",
        lambda: [eyes(), inner_points()],
        lambda eye, position: normalize(eye[:, :3] - eye[:, 3:] * position),
        1e-6,
    ),
    "object_view_direction": Twin(
        "draw_lib.glsl",
        "mat4 model = mat4(1.0); model[3] = vec4(in_1.xyz, 1.0);"
        "mat4 turn = mat4(vec4(0, 1, 0, 0), vec4(-1, 0, 0, 0), vec4(0, 0, 1, 0), vec4(0, 0, 0, 1));"
        "result_0.xyz = object_view_direction(in_0, model, turn);",
        lambda: [eyes(), inner_points()],
        lambda eye, place: normalize(eye[:, :3] - eye[:, 3:] * (place[:, [1, 0, 2]] * (-1.0, 1.0, 1.0))),
        1e-6,
    ),
    "emitted": Twin(
        "draw_lib.glsl",
        "result_0.xyz = emitted(in_0.xyz, in_1);",
        lambda: [inner_points(), eyes()],
        # What no light would scale back is kept finite
        emitted,
        lambda emission, strength: 4.0 * ULP * np.abs(emitted(emission, strength))[:, None],
    ),
}


@pytest.mark.parametrize("name", TWINS)
def test_a_function_says_what_its_twin_says(name: str) -> None:
    check(TWINS[name])
