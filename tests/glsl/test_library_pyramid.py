"""What Principled materials reflect, looked up in a pyramid's atlas, against the numpy twin."""

from dataclasses import replace

import numpy as np
import pytest
from rsibr.rsibr_addon.core.brdf import fresnel_powers
from rsibr.rsibr_addon.core.brdf.principled import Layers, Surface
from rsibr.rsibr_addon.core.errors import ShapeError
from rsibr.rsibr_addon.core.geometry.directions import dot, normalize, reflect
from rsibr.rsibr_addon.core.geometry.sides import seen_surface
from rsibr.rsibr_addon.core.kinds.kernel_pyramid import shading
from rsibr.rsibr_addon.core.kinds.kernel_pyramid.atlas import atlas_texels
from rsibr.rsibr_addon.core.kinds.kernel_pyramid.bake import LEAST_TEXELS, bake_pyramid, width_of
from rsibr.rsibr_addon.core.kinds.kernel_pyramid.pyramid import OCTAHEDRAL, Pyramid
from rsibr.rsibr_addon.core.kinds.kernel_pyramid.shading import principled_radiance
from rsibr.rsibr_addon.core.lobes.bank import KernelBank
from rsibr.rsibr_addon.core.lobes.family import KERNELS
from rsibr.rsibr_addon.core.progress import drain
from rsibr.rsibr_addon.core.resample import lookup
from rsibr.rsibr_addon.device.kinds.kernel_pyramid_texels import family_texels, lookup_texels
from rsibr.tests.glsl.evaluation import evaluate
from rsibr.tests.glsl.principled_inputs import (
    KERNEL_COUNT,
    SIZE,
    SURFACE,
    families,
    numbers,
    often_zero,
    pyramid,
    samplers,
    samplers_of,
    surface_arguments,
    surface_of,
)
from rsibr.tests.glsl.twins import single, unit_vectors

LIBRARY = "principled_radiance_lib.glsl"

POINTS = 10_000
"""Enough for random materials; the numpy twin takes a second."""


def test_sheen_radiance() -> None:
    roughness, mu, normal = (each[:POINTS] for each in (numbers(44), numbers(45), unit_vectors(46)))
    code = "result_0.rgb = sheen_radiance(atlas, lookups, sheens, in_0.x, in_1.x, in_2.xyz);"
    found = evaluate(LIBRARY, code, [roughness, mu, normal], 1, samplers())[:, 0, :3]
    surface = Surface(sheen_roughness=roughness[:, 0])
    expected = shading._sheen(pyramid(), families().sheen_table, surface, normal, mu[:, 0])
    # Weights of texels of 8 bits, of a table and of five maps
    assert np.abs(found - expected).max() < 5e-3 * expected.max()


def test_family_place() -> None:
    alpha, mu = numbers(40, 0.0, 1.0), numbers(41)
    code = "result_0.xy = family_place(ggx, in_0.x, in_1.x);"
    found = evaluate("family_lib.glsl", code, [alpha, mu], 1, {"ggx": samplers()["ggx"]})[:, 0]
    ggx = families().ggx
    column = np.interp(np.log(alpha[:, 0]), np.log(ggx.alpha), np.arange(len(ggx.alpha)))
    row = np.interp(mu[:, 0], ggx.mu, np.arange(len(ggx.mu)))
    # As textures are looked up that repeat their edges; logarithms of drivers are good to 1e-6
    for place, expected, count in ((found[:, 0], column, len(ggx.alpha)), (found[:, 1], row, len(ggx.mu))):
        np.testing.assert_allclose(np.clip(place * count - 0.5, 0.0, count - 1.0), expected, atol=1e-4)


def test_pyramid_radiance() -> None:
    direction = unit_vectors(42)[:POINTS]
    light = pyramid()
    maps = [lookup(light.mirror, direction, OCTAHEDRAL), *shading.lookup_diffuse(light, direction)]
    textures = {name: samplers()[name] for name in ("atlas", "lookups")}
    for name, expected in zip(("MIRROR_MAP", "COSINE_MAP", "LEANING_MAP"), maps, strict=True):
        code = f"result_0.rgb = pyramid_radiance(atlas, lookups, {name}, octahedral_uv(in_0.xyz));"
        found = evaluate("pyramid_lib.glsl", code, [direction], 1, textures)[:, 0, :3]
        assert_as_stored(found, expected)


def test_atlas_radiance() -> None:
    direction = unit_vectors(42)[:POINTS]
    light = pyramid()
    _, places = atlas_texels(light)
    for number, kappa in enumerate(KERNELS.concentrations):
        place = ", ".join(map(repr, places[0, number, :3].tolist()))
        code = f"result_0.rgb = atlas_radiance(atlas, vec3({place}), octahedral_uv(in_0.xyz));"
        textures = {"atlas": samplers()["atlas"]}
        found = evaluate("pyramid_lib.glsl", code, [direction], 1, textures)[:, 0, :3]
        assert_as_stored(found, light.kernel(kappa, direction))


def assert_as_stored(found: np.ndarray, expected: np.ndarray) -> None:
    """Half floats are good to 2^-12 of a value; weights of 8 bits to 2 / 512 of what neighbours differ by."""
    assert np.abs(found - expected).max() < 3e-3 * expected.max()


def points(count: int = POINTS) -> tuple[np.ndarray, np.ndarray, list[np.ndarray]]:
    """Normals, views and the inputs of materials."""
    return (
        unit_vectors(43)[-count:],
        unit_vectors(44)[-count:],
        [each[:count] for each in surface_arguments()],
    )


def assert_near(found: np.ndarray, expected: np.ndarray, peak: float) -> None:
    """Assert what half floats leave.

    A lobe is a sum of kernels, the sum of whose magnitudes is up to 8 times the lobe. Each map is good to
    2^-12 of itself, and what several round adds up by chance, so that few points err as much.
    """
    error = np.abs(found - expected).max(axis=-1)
    assert error.max() < 2e-3 * peak
    assert np.quantile(error, 0.99) < 5e-4 * peak


def shaded(light: Pyramid, normal: np.ndarray, view_dir: np.ndarray, inputs: list[np.ndarray]) -> np.ndarray:
    code = SURFACE + (
        "result_0.rgb = principled_radiance(atlas, lookups, ggx, leaning, albedos, rises, sheens, surface, "
        "in_7.xyz, in_7.xyz, in_7.xyz, in_7.xyz, in_8.xyz);"
    )
    facing = seen_surface(normal, view_dir).normal
    return evaluate(LIBRARY, code, [*inputs, facing, view_dir], 1, samplers_of(light))[:, 0, :3]


def test_principled_radiance() -> None:
    normal, view_dir, inputs = points()
    expected = principled_radiance(pyramid(), families(), surface_of(*inputs), normal, view_dir)
    assert expected.max() > 5.0
    assert_near(shaded(pyramid(), normal, view_dir, inputs), expected, expected.max())


@pytest.mark.parametrize("metallic", [0.0, 1.0])
def test_white_surfaces_vanish_in_a_white_furnace(metallic: float) -> None:
    normal, view_dir, inputs = points()
    baked = drain(bake_pyramid(np.ones((64, 128, 3)), SIZE)).pyramid
    # Sums over texels are not quite even near the poles
    furnace = replace(baked, maps=tuple(np.ones_like(sheets) for sheets in baked.maps))
    base, specular, coat, emission, boundary, coating, tint = (each.copy() for each in inputs)
    base[:, :3], base[:, 3], coat[:, :3], emission[:] = 1.0, metallic, 1.0, (0.0, 0.0, 0.0, 1.0)
    specular[:] = 1.0, 1.0, 1.0, 0.5
    boundary[:, 1:], coating[:, 1], tint[:] = (1.5, 0.0), 1.5, 1.0
    found = shaded(furnace, normal, view_dir, [base, specular, coat, emission, boundary, coating, tint])
    # As the numpy twin: families err by half a percent of what they reflect, for each of their layers
    np.testing.assert_allclose(found[dot(normal, view_dir) > 0.05], 1.0, atol=0.01)


def directions() -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Normals and mirror directions of views above the horizon, and their cosines."""
    normal, view_dir, _ = points()
    view_dir = np.where(dot(normal, view_dir)[:, None] < 0.0, -view_dir, view_dir)
    return normal, single(reflect(view_dir, normal)), single(dot(normal, view_dir)[:, None])


def test_family_column() -> None:
    """Away from columns themselves, on which rounding decides."""
    alpha = 2.0 ** (0.25 * (np.arange(-40, 4)[:, None] + 0.5))
    code = "result_0.x = float(family_column(ggx, family_place(ggx, in_0.x, 0.5)));"
    found = evaluate(LIBRARY, code, [alpha], 1, {"ggx": samplers()["ggx"]})[:, 0, 0]
    below = np.searchsorted(families().ggx.alpha, alpha[:, 0], side="right") - 1
    np.testing.assert_array_equal(found, np.maximum(below, 0))


@pytest.mark.parametrize("name", ["ggx", "leaning"])
def test_a_width_and_the_next_one_have_all_their_kernels_looked_up(name: str) -> None:
    family, first = getattr(families(), name), 0 if name == "ggx" else len(families().ggx.alpha)
    _, places = atlas_texels(pyramid())
    texels = lookup_texels(families(), places, pyramid().suns, len(pyramid().bank))
    needed = np.any(family.weights, axis=(1, 2, 4))
    for width, column in enumerate(texels[:, first : first + len(needed)].swapaxes(0, 1)):
        listed = column[1 : 1 + int(column[0, 0])]
        kernels = listed[:, 3].astype(int)
        np.testing.assert_array_equal(kernels, np.flatnonzero(needed[width : width + 2].any(axis=0)))
        np.testing.assert_array_equal(listed[:, :3], places[0, kernels, :3])


def test_lobes_radiance() -> None:
    normal, mirror_dir, mu = directions()
    color, edge, alpha = (each[:POINTS] for each in (numbers(45, columns=3), numbers(46), numbers(47)))
    code = (
        "Powers of_metal = schlick(in_0.rgb, in_1.xxx);"
        "result_0.rgb = lobes_radiance(atlas, lookups, ggx, 0, FUNCTIONS, LOBES, in_2.x, in_3.x, of_metal,"
        "                              in_4.xyz, in_5.xyz);"
        "result_1.rgb = lobes_radiance(atlas, lookups, leaning, textureSize(ggx, 0).x, 1, LEANING_LOBES, 1.0,"
        "                              in_3.x, Powers(vec3(1.0), mat4x3(0.0)), in_4.xyz, in_5.xyz);"
    )
    textures = {name: samplers()[name] for name in ("atlas", "lookups", "ggx", "leaning")}
    found = evaluate(LIBRARY, code, [color, edge, alpha, mu, normal, mirror_dir], 2, textures)[..., :3]
    metal = np.moveaxis(fresnel_powers.schlick(color, edge), -1, -2)
    for shown, family, width, powers, scale in (
        (found[:, 0], families().ggx, alpha[:, 0], metal, 1.0),
        # Its lobes take more from each other: magnitudes sum to 66
        (found[:, 1], families().leaning, np.ones(POINTS), np.ones((POINTS, 1, 3)), 8.0),
    ):
        expected = shading._lobes(pyramid(), family, width, mu[:, 0], powers, normal, mirror_dir)
        assert_near(shown, expected, scale * np.abs(expected).max())


def test_ggx_radiance() -> None:
    """Among them lobes that are narrower than the family's first."""
    normal, mirror_dir, mu = directions()
    view_dir = reflect(mirror_dir, normal)
    color, alpha = numbers(48, columns=3)[:POINTS], 2.0 ** numbers(49, -8.0, 0.0)[:POINTS]
    alpha[:10] = 0.0
    code = (
        "result_0.rgb = ggx_radiance(atlas, lookups, ggx, in_1.x, in_2.x, schlick(in_0.rgb, vec3(0.0)),"
        "                            in_3.xyz, in_4.xyz);"
    )
    textures = {name: samplers()[name] for name in ("atlas", "lookups", "ggx")}
    found = evaluate(LIBRARY, code, [color, alpha, mu, normal, mirror_dir], 1, textures)[:, 0, :3]
    metal = np.moveaxis(fresnel_powers.schlick(color), -1, -2)
    expected = shading._glossy(pyramid(), families(), alpha[:, 0], metal, normal, view_dir)
    assert_near(found, expected, expected.max())


def test_diffuse_radiance() -> None:
    normal, mirror_dir, mu = directions()
    color, roughness = numbers(50, columns=3)[:POINTS], often_zero(51)[:POINTS]
    smooth = normalize(normal + 0.7 * unit_vectors(52)[:POINTS])
    code = (
        "result_0.rgb = diffuse_radiance(atlas, lookups, leaning, in_0.rgb, in_1.x, in_2.x, in_3.xyz,"
        "                                in_4.xyz, in_5.xyz);"
    )
    textures = {name: samplers()[name] for name in ("atlas", "lookups", "leaning")}
    arguments = [color, roughness, mu, normal, smooth, mirror_dir]
    found = evaluate(LIBRARY, code, arguments, 1, textures)[:, 0, :3]
    surface = Surface(base_color=color, diffuse_roughness=roughness[:, 0])
    none = np.zeros((POINTS, 3))
    all_of_it = Layers(*[np.zeros((POINTS, 5, 3))] * 2, np.ones((POINTS, 3)), none, none)
    view_dir = reflect(mirror_dir, normal)
    expected = shading._diffuse(
        pyramid(), families().leaning, surface, all_of_it, normal, smooth, view_dir, mu[:, 0]
    )
    assert_near(found, expected, expected.max())


def test_maps_lie_in_the_atlas_with_what_continues_them() -> None:
    light = pyramid()
    atlas, places = atlas_texels(light)
    corners = np.round(places[0] * (2 * atlas.shape[1::-1])).astype(int)[:, :3]
    resolved = len(light.bank)
    assert resolved < KERNEL_COUNT
    np.testing.assert_array_equal(
        corners[resolved:KERNEL_COUNT], corners[[KERNEL_COUNT] * (KERNEL_COUNT - resolved)]
    )
    shown = [*corners[:resolved], *corners[KERNEL_COUNT:]]
    taken = np.zeros(atlas.shape[:2], dtype=int)
    for (left, bottom, size), sheet in zip(
        shown,
        [sheets[0] for sheets in (*light.maps, light.mirror)] + [*light.diffuse, *light.rings],
        strict=True,
    ):
        np.testing.assert_array_equal(atlas[bottom : bottom + size, left : left + size, :3], sheet)
        # Each edge is folded about its middle
        np.testing.assert_array_equal(atlas[bottom - 1, left : left + size, :3], sheet[0, ::-1])
        np.testing.assert_array_equal(atlas[bottom : bottom + size, left + size, :3], sheet[::-1, -1])
        taken[bottom - 1 : bottom + size + 1, left - 1 : left + size + 1] += 1
    assert taken.max() == 1


def test_an_atlas_fits_into_graphics_memory() -> None:
    bank = KernelBank(KERNELS.concentrations[:-1])  # The sharpest needs larger maps
    widths = [width_of(kappa, SIZE) for kappa in bank.concentrations]
    maps = tuple(np.zeros((1, width, width, 3), np.float32) for width in widths)
    others = (
        np.zeros((count, width, width, 3))
        for count, width in ((1, SIZE), (2, LEAST_TEXELS), (3, LEAST_TEXELS))
    )
    mirror, diffuse, rings = others
    atlas, _ = atlas_texels(Pyramid(bank, mirror, maps, diffuse, rings))
    # Of half floats; what is asked of a bank in graphics memory
    assert 2 * atlas.size < 40e6


def test_a_family_of_another_kind_is_refused() -> None:
    ggx = families().ggx
    for other in (
        replace(ggx, bank=KernelBank((*KERNELS.concentrations[:-1], 2e4))),
        replace(ggx, mu=ggx.mu**2),
        replace(ggx, alpha=ggx.alpha**2),
        replace(ggx, tilts=np.repeat(ggx.tilts, 2, 2), weights=np.repeat(ggx.weights, 2, 2)),
    ):
        with pytest.raises(ShapeError, match=r"12 kernels and 4 lobes, .* fit it anew"):
            family_texels(other)
