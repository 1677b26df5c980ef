"""Suns that GGX itself reflects, against the numpy twin."""

from dataclasses import replace
from functools import cache

import numpy as np
from rsibr.rsibr_addon.core.brdf import fresnel_powers
from rsibr.rsibr_addon.core.brdf.ggx import ggx_ndf, smith_visibility
from rsibr.rsibr_addon.core.conventions import texel_centres
from rsibr.rsibr_addon.core.geometry.directions import normalize, reflect
from rsibr.rsibr_addon.core.geometry.sides import seen_surface
from rsibr.rsibr_addon.core.kinds.kernel_pyramid.bake import bake_pyramid
from rsibr.rsibr_addon.core.kinds.kernel_pyramid.look import PrincipledLook
from rsibr.rsibr_addon.core.kinds.kernel_pyramid.pyramid import Pyramid
from rsibr.rsibr_addon.core.kinds.kernel_pyramid.shading import principled_radiance
from rsibr.rsibr_addon.core.maps import equirect
from rsibr.rsibr_addon.core.progress import drain
from rsibr.rsibr_addon.core.suns import NO_SUNS
from rsibr.rsibr_addon.device.kinds.kernel_pyramid import SUNS, GpuPyramid, principled_shader, sunlit_shader
from rsibr.tests.glsl.evaluation import evaluate
from rsibr.tests.glsl.principled_inputs import (
    SURFACE,
    families,
    numbers,
    samplers_of,
    surface_arguments,
    surface_of,
)
from rsibr.tests.glsl.twins import single, unit_vectors

POINTS = 4000


@cache
def pyramid() -> Pyramid:
    """A dim sky over a red floor, with two suns of 400 times their light."""
    texels = equirect.direction_from_uv(texel_centres(128, 64))
    light = np.where(texels[..., 2:] > 0.0, [0.3, 0.4, 0.6], [0.3, 0.1, 0.05])
    light[45, 30:32] = [[120.0, 100.0, 70.0], [240.0, 200.0, 140.0]]
    light[40, 90] = 160.0, 200.0, 240.0
    return drain(bake_pyramid(light, 128)).pyramid


def views() -> tuple[np.ndarray, np.ndarray]:
    """Normals, and views of which every other one mirrors a sun nearly."""
    normal, view_dir = unit_vectors(71)[:POINTS], unit_vectors(72)[:POINTS].copy()
    suns = pyramid().suns.direction[np.arange(POINTS) % len(pyramid().suns)]
    seen = normalize(reflect(suns, normal) + 0.1 * unit_vectors(73)[:POINTS])
    view_dir[::2] = seen[::2]
    normal = seen_surface(normal, view_dir).normal
    return single(normal), single(view_dir)


def found_of(code: str, arguments: list[np.ndarray], results: int = 1) -> np.ndarray:
    """What a statement finds of these suns, shape (n, results, 4)."""
    textures = {"lookups": samplers_of(pyramid())["lookups"]}
    said = f"Suns suns = suns_of(lookups); {code}"
    return evaluate("suns_lib.glsl", said, arguments, results, textures, (SUNS,))


def test_suns_of() -> None:
    suns = pyramid().suns
    code = "result_0 = vec4(suns.ceiling, suns.narrowest); result_1.xy = vec2(suns.count, suns.resolved);"
    below, counts = found_of(code, [np.zeros((1, 1))], 2)[0]
    np.testing.assert_array_equal(below, single([*suns.ceiling, suns.narrowest]))
    np.testing.assert_array_equal(counts[:2], [len(suns), len(pyramid().bank)])


def test_sun_texel() -> None:
    (found,) = found_of("result_0 = sun_texel(lookups, 1);", [np.zeros((1, 1))])[0]
    np.testing.assert_array_equal(found, [len(pyramid().suns), len(pyramid().bank), 0.0, 0.0])


def test_sun_direction() -> None:
    numbers_of_suns = np.arange(len(pyramid().suns))[:, None]
    found = found_of("result_0.xyz = sun_direction(lookups, int(in_0.x));", [numbers_of_suns])
    np.testing.assert_array_equal(found[:, 0, :3], single(pyramid().suns.direction))


def test_sun_irradiance() -> None:
    numbers_of_suns = np.arange(len(pyramid().suns))[:, None]
    found = found_of("result_0.xyz = sun_irradiance(lookups, int(in_0.x));", [numbers_of_suns])
    np.testing.assert_array_equal(found[:, 0, :3], single(pyramid().suns.irradiance))


def test_sun_mirror_share() -> None:
    alpha = 2.0 ** numbers(75, -9.0, 0.0)[:POINTS]
    found = found_of("result_0.x = sun_mirror_share(suns, in_0.x);", [alpha])
    np.testing.assert_allclose(found[:, 0, 0], pyramid().suns.mirror_share(alpha[:, 0]), atol=1e-6)


def test_facets_reflect() -> None:
    normal, view_dir = views()
    light_dir = np.where(np.sum(normal * normal[::-1], axis=1, keepdims=True) < 0.0, -1.0, 1.0) * normal[::-1]
    alpha, both = 2.0 ** numbers(76, -4.0, 0.0)[:POINTS, 0], view_dir + light_dir
    n_dot_v, n_dot_l = (np.sum(normal * each, axis=1) for each in (view_dir, light_dir))
    code = "result_0.x = facets_reflect(in_0.x, in_1.xyz, in_0.y, in_0.z, in_2.xyz);"
    found = found_of(code, [np.column_stack([alpha, n_dot_v, n_dot_l]), normal, both])[:, 0, 0]
    sine2 = np.sum(np.cross(normal, both) ** 2, axis=1) / np.sum(both**2, axis=1)
    expected = ggx_ndf(sine2, alpha) * smith_visibility(n_dot_l, n_dot_v, alpha) * n_dot_l
    # Roundings of a sine beside alpha, of 1/16 at least
    np.testing.assert_allclose(found, expected, rtol=1e-4, atol=1e-6)


def test_sunlit_gloss() -> None:
    normal, view_dir = views()
    color, alpha = numbers(74, columns=3)[:POINTS], 2.0 ** numbers(75, -9.0, 0.0)[:POINTS]
    mu = np.maximum(np.sum(normal * view_dir, axis=1, keepdims=True), 1e-4)
    code = (
        "Powers metal = schlick(in_0.rgb, vec3(0.0));"
        "result_0.rgb = sunlit_gloss(lookups, suns, in_1.x, in_2.x, metal, in_3.xyz, in_4.xyz);"
    )
    found = found_of(code, [color, alpha, mu, normal, view_dir])
    metal = np.moveaxis(fresnel_powers.schlick(color), -1, -2)
    glossy = pyramid().suns.glossy(alpha[:, 0], metal, normal, view_dir)
    # Squares of alpha of 1/256 beside those of sines, in single precision
    np.testing.assert_allclose(found[:, 0, :3], glossy, rtol=1e-3, atol=1e-5 * glossy.max())


def test_sunlit_leaning() -> None:
    normal, view_dir = views()
    mu = np.maximum(np.sum(normal * view_dir, axis=1, keepdims=True), 1e-4)
    code = "result_0.rgb = sunlit_leaning(lookups, suns, in_0.x, in_1.xyz, in_2.xyz);"
    found = found_of(code, [mu, normal, view_dir])
    leaning = pyramid().suns.leaning(mu[:, 0], normal, view_dir)
    np.testing.assert_allclose(found[:, 0, :3], leaning, rtol=1e-4, atol=1e-5 * np.abs(leaning).max())


def test_principled_radiance() -> None:
    """In programs for light with suns; narrow lobes and mirrors are among the materials."""
    normal, view_dir = views()
    inputs = [each[:POINTS].copy() for each in surface_arguments()]
    inputs[4][:400, 0] = 0.1 * inputs[4][:400, 0]
    code = SURFACE + (
        "result_0.rgb = principled_radiance(atlas, lookups, ggx, leaning, albedos, rises, sheens, surface, "
        "in_7.xyz, in_7.xyz, in_7.xyz, in_7.xyz, in_8.xyz);"
    )
    arguments = [*inputs, normal, view_dir]
    textures = samplers_of(pyramid())
    found = evaluate("principled_radiance_lib.glsl", code, arguments, 1, textures, (SUNS,))[:, 0, :3]
    expected = principled_radiance(pyramid(), families(), surface_of(*inputs), normal, view_dir)
    error = np.abs(found - expected).max(axis=-1)
    # Half floats of lobes, and of suns in the mirror
    assert np.quantile(error, 0.99) < 5e-4 * np.quantile(expected, 0.99)
    assert np.all(error < 2e-3 * (expected.max(axis=-1) + np.quantile(expected, 0.99)))


def test_light_without_suns_has_its_own_program() -> None:
    look = PrincipledLook()
    light = GpuPyramid(pyramid(), families())
    assert light.inputs(look).program is sunlit_shader
    without = GpuPyramid(replace(pyramid(), suns=NO_SUNS), families())
    assert without.inputs(look).program is principled_shader
    # The split sum is lit by lobes alone
    np.testing.assert_array_equal(light.split_sum()["atlas"].values, without.textures[0].values)
    assert "atlas" not in without.split_sum()
