"""What an eye sees of either side of a surface: GLSL against its numpy twin."""

import numpy as np
import pytest
from rsibr.rsibr_addon.core.geometry.directions import dot, normalize, reflect
from rsibr.rsibr_addon.core.geometry.sides import seen_surface, tilted_normal
from rsibr.tests.glsl.evaluation import evaluate
from rsibr.tests.glsl.twins import AXES, Twin, check, unit_vectors

PLACE = "vec3 place = in_0.xyz * gl_FragCoord.x + in_1.xyz * gl_FragCoord.y;"
"""Points of a plane, a pixel apart; the arguments are the same for all."""

MIRRORED = "mat4(vec4(-1, 0, 0, 0), vec4(0, 1, 0, 0), vec4(0, 0, 1, 0), vec4(0, 0, 0, 1))"
"""A model that mirrors."""


def facing() -> list[np.ndarray]:
    """Normals, views, and facets on the eye's side, but where it is almost in the facet's plane."""
    normal, view_dir, facet = unit_vectors(51), unit_vectors(52), unit_vectors(53, -AXES)
    flat = np.abs(dot(view_dir, facet)) < 1e-3
    facet[flat] = view_dir[flat]
    return [normal, view_dir, np.where(dot(view_dir, facet)[:, None] < 0.0, -facet, facet)]


def tilting_error(normal: np.ndarray, view_dir: np.ndarray, facet: np.ndarray) -> np.ndarray:
    """Roundings, over what the tilted normal is made of; where the normal's fate hangs on them, all."""
    rise = dot(2.0 * dot(normal, view_dir)[:, None] * normal - view_dir, facet)
    least = np.minimum(0.9 * dot(view_dir, facet), 0.01)
    length = np.linalg.norm(np.cross(normal, facet), axis=-1) * (dot(view_dir, facet) + least)
    error = np.where(np.abs(rise - least) < 1e-6, 2.0, 2e-6 / np.maximum(length, 1e-5))
    return error[:, None, None]


TWINS = {
    "tilted_normal": Twin(
        "sides_lib.glsl",
        "result_0.xyz = tilted_normal(in_0.xyz, in_1.xyz, in_2.xyz);",
        facing,
        tilted_normal,
        tilting_error,
    ),
}


@pytest.mark.parametrize("name", TWINS)
def test_twins(name: str) -> None:
    check(TWINS[name])


def constant(*vectors: tuple[float, ...]) -> list[np.ndarray]:
    return [np.tile(np.array(vector, np.float32), (1024, 1)) for vector in vectors]


@pytest.mark.parametrize("turn", [1.0, -1.0], ids=["right-handed", "left-handed"])
def test_facet_normal(turn: float) -> None:
    across, up, view_dir = (0.3, turn * 0.1, 0.0), (0.0, turn * 0.2, 0.1), (0.6, 0.0, 0.8)
    code = "result_0.xyz = facet_normal(in_0.xyz, in_1.xyz, in_2.xyz);"
    found = evaluate("sides_lib.glsl", code, constant(across, up, view_dir))[:, 0, :3]
    normal = normalize(np.cross(across, up))
    # Places of up to 200 are good to 1e-5, and differ by 0.1
    np.testing.assert_allclose(found, np.tile(np.sign(normal @ view_dir) * normal, (1024, 1)), atol=1e-3)
    point = evaluate("sides_lib.glsl", code, constant((0, 0, 0), (0, 0, 0), view_dir))[:, 0, :3]
    np.testing.assert_allclose(point, np.tile(view_dir, (1024, 1)), atol=1e-6)


@pytest.mark.parametrize("mirrored", [False, True])
@pytest.mark.parametrize("front", [False, True])
def test_seen_surface(front: bool, mirrored: bool) -> None:
    across, up, view_dir, normal = (0.3, 0.1, 0.0), (0.0, 0.2, 0.1), (0.6, -0.8, 0.0), (0.8, -0.2, 0.2)
    code = f"""{PLACE}
        Seen seen = seen_surface(vec4(in_2.xyz, 0.0), {MIRRORED if mirrored else "mat4(1.0)"}, place,
                                 in_3.xyz, {str(front).lower()});
        result_0.xyz = seen.view_dir;
        result_1.xyz = seen.normal;
        result_2.xyz = seen.mirror_normal;
        result_3.x = float(seen.outside);
    """
    found = evaluate("sides_lib.glsl", code, constant(across, up, view_dir, normal), results=4)
    outside = front != mirrored
    facet = normalize(np.cross(across, up))
    to_eye = np.sign(facet @ view_dir) * facet
    expected = seen_surface(normalize(normal), view_dir, to_eye if outside else -to_eye)
    assert expected.outside == outside
    np.testing.assert_allclose(found[:, 0, :3], np.tile(view_dir, (1024, 1)), atol=1e-6)
    np.testing.assert_allclose(found[:, 1, :3], np.tile(expected.normal, (1024, 1)), atol=1e-6)
    # As in the test above
    np.testing.assert_allclose(found[:, 2, :3], np.tile(expected.mirror_normal, (1024, 1)), atol=3e-3)
    np.testing.assert_array_equal(found[:, 3, 0], float(outside))


@pytest.mark.parametrize("mirrored", [False, True])
@pytest.mark.parametrize("front", [False, True])
def test_sees_outside(front: bool, mirrored: bool) -> None:
    code = f"result_0.x = float(sees_outside({MIRRORED if mirrored else 'mat4(1.0)'}, {str(front).lower()}));"
    found = evaluate("sides_lib.glsl", code, constant((0.0,)))[:, 0, 0]
    np.testing.assert_array_equal(found, float(front != mirrored))


@pytest.mark.parametrize("outside", [False, True])
def test_seen_point(outside: bool) -> None:
    across, up, eye, normal = (0.3, 0.1, 0.0), (0.0, 0.2, 0.1), (0.6, -0.8, 0.0), (0.8, -0.2, 0.2)
    code = f"""
        Seen seen = seen_point(vec4(in_2.xyz, 0.0), in_0.xyz, in_3.xyz, in_0.xyz, in_1.xyz,
                               {str(outside).lower()});
        result_0.xyz = seen.position;
        result_1.xyz = seen.normal;
        result_2.xyz = seen.mirror_normal;
    """
    found = evaluate("sides_lib.glsl", code, constant(across, up, eye, normal), results=3)
    facet = normalize(np.cross(across, up))
    to_eye = np.sign(facet @ eye) * facet
    expected = seen_surface(normalize(normal), eye, to_eye if outside else -to_eye)
    for result, vector in enumerate([across, expected.normal, expected.mirror_normal]):
        np.testing.assert_allclose(found[:, result, :3], np.tile(vector, (1024, 1)), atol=1e-5)


def test_mirrored() -> None:
    view_dir, normal = (0.6, -0.8, 0.0), (0.0, -0.6, 0.8)
    code = "result_0.xyz = mirrored(Seen(vec3(0.0), in_0.xyz, vec3(0.0), in_1.xyz, true));"
    found = evaluate("sides_lib.glsl", code, constant(view_dir, normal))[:, 0, :3]
    np.testing.assert_allclose(found, np.tile(reflect(view_dir, normal), (1024, 1)), atol=1e-6)
