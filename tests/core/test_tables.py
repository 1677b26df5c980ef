"""Reflection tables against brute force and closed forms, and their weights against energy."""

from collections.abc import Callable
from typing import NoReturn

import numpy as np
import pytest
from rsibr.rsibr_addon.core.brdf.albedo import directional_albedo
from rsibr.rsibr_addon.core.brdf.fresnel import fresnel_conductor
from rsibr.rsibr_addon.core.brdf.spec import brdf_from_spec
from rsibr.rsibr_addon.core.conventions import Array, texel_centres
from rsibr.rsibr_addon.core.errors import RangeError, RsibrWarning, ShapeError
from rsibr.rsibr_addon.core.kinds.reflection_tables.bake import (
    DIFFUSE_ROWS,
    LOOKUP_ERROR,
    BakedTables,
    TableSizes,
    bake_tables,
    lobe_rows,
)
from rsibr.rsibr_addon.core.kinds.reflection_tables.material import PRESETS, material_from_texts, preset
from rsibr.rsibr_addon.core.kinds.reflection_tables.tables import ReflectionTables, Role
from rsibr.rsibr_addon.core.kinds.reflection_tables.weights import (
    COLUMNS,
    furnace,
    table_weights,
    warn_of_table_gain,
    weight_cosines,
)
from rsibr.rsibr_addon.core.maps import equirect
from rsibr.rsibr_addon.core.progress import drain

ROWS = 24
SINGLE = 2.0**-24
"""Relative rounding error of the tables' single precision."""


def no_measured(name: str, path: str) -> NoReturn:
    raise AssertionError


def bake(radiance: Array, exact: bool = False, sizes: TableSizes | None = None, **texts: str) -> BakedTables:
    material = material_from_texts(texts, no_measured)
    return drain(bake_tables(radiance, material, sizes or TableSizes(8, 10), exact))


def directions(rows: int) -> Array:
    return equirect.direction_from_uv(texel_centres(2 * rows, rows))


def uneven_sky() -> Array:
    """Uneven light with a sun of one texel that holds about half of it."""
    radiance = 0.01 + np.random.default_rng(5).random((ROWS, 2 * ROWS, 3)) ** 6
    radiance[17, 40] = [300.0, 250.0, 200.0]
    return radiance.astype(np.float32)


def lit_texel(row: int, column: int) -> tuple[Array, Array, float]:
    """A map with one texel of radiance 1, its direction and its solid angle."""
    radiance = np.zeros((ROWS, 2 * ROWS, 3), dtype=np.float32)
    radiance[row, column] = 1.0
    solid_angle = equirect.texel_solid_angle(2 * ROWS, ROWS)[row, column]
    return radiance, directions(ROWS)[row, column], float(solid_angle)


def brute_force(radiance: Array, reflectance: Callable[[Array], Array], rows: int) -> Array:
    """Sum over texels of radiance times solid angle times a function of the cosine."""
    light = radiance * equirect.texel_solid_angle(2 * ROWS, ROWS)[..., None].astype(np.float64)
    cosine = np.einsum("abi,jki->abjk", directions(rows), directions(ROWS))
    return np.einsum("abjk,jkc->abc", reflectance(cosine), light)


def phong(n: float) -> Callable[[Array], Array]:
    return lambda cosine: (n + 1.0) / (2.0 * np.pi) * np.maximum(cosine, 0.0) ** n


def test_a_diffuse_table_is_the_sum_of_miller_and_hoffman_but_for_its_scale() -> None:
    baked = bake(uneven_sky(), diffuse="lambert:kd=0.5/0.4/0.3")
    # Section 6.1 divides by 4 pi and leaves kd / 4 in even light; ours gives kd.
    theirs = brute_force(uneven_sky(), lambda cosine: np.maximum(cosine, 0.0) / (4.0 * np.pi), 8)
    expected = 4.0 * np.array([0.5, 0.4, 0.3]) * theirs
    np.testing.assert_allclose(baked.tables.maps[Role.DIFFUSE], expected, rtol=SINGLE, atol=1e-12)


def test_a_luminous_table_is_the_mean_radiance_everywhere() -> None:
    baked = bake(uneven_sky(), diffuse="luminous:kd=0.5")
    expected = 0.5 * brute_force(uneven_sky(), np.ones_like, 1)[0, 0] / (4.0 * np.pi)
    np.testing.assert_allclose(
        baked.tables.maps[Role.DIFFUSE], np.broadcast_to(expected, (8, 16, 3)), rtol=2 * SINGLE
    )


def test_what_a_surface_emits_is_added() -> None:
    dark = np.zeros((ROWS, 2 * ROWS, 3))
    alone = bake(dark, emission="2/1/0.5").tables.maps
    assert alone.keys() == {Role.DIFFUSE}
    np.testing.assert_array_equal(alone[Role.DIFFUSE], np.broadcast_to([2.0, 1.0, 0.5], (8, 16, 3)))
    both = bake(uneven_sky(), diffuse="lambert:kd=0.5", emission="1").tables.maps[Role.DIFFUSE]
    lit = bake(uneven_sky(), diffuse="lambert:kd=0.5").tables.maps[Role.DIFFUSE]
    np.testing.assert_allclose(both - lit, 1.0, rtol=3 * SINGLE * both.max())


@pytest.mark.parametrize("n", [1.0, 1.5, 2.0, 7.5, 50.0])
@pytest.mark.parametrize("role", [Role.SPECULAR, Role.RETRO])
def test_a_phong_table_is_the_sum_over_texels_within_its_bound(n: float, role: Role) -> None:
    texts = {role.value: f"phong:n={n},ks=0.3/0.6/0.9"}
    baked, exact = bake(uneven_sky(), **texts), bake(uneven_sky(), exact=True, **texts)
    expected = np.array([0.3, 0.6, 0.9]) * brute_force(uneven_sky(), phong(n), 10)
    # The angle of a lobe, and so its cosine, is known to 1e-16, the n-th power of it to n times that.
    np.testing.assert_allclose(exact.tables.maps[role], expected, rtol=2 * SINGLE, atol=1e-12)
    rounding = SINGLE * expected.max(axis=(0, 1))
    error = np.abs(baked.tables.maps[role] - expected).max(axis=(0, 1))
    assert np.all(error <= baked.bounds[role] + rounding)
    # Lobes with a kink at the horizon are allowed 1e-4 in the mean, and their bound is cautious.
    assert np.all(baked.bounds[role] < (3e-3 if n < 2.0 else 1e-4) * expected.max(axis=(0, 1)))
    np.testing.assert_array_equal(exact.bounds[role], 0.0)


def test_a_mirrors_tables_are_the_environment() -> None:
    sky = uneven_sky()
    sizes = TableSizes()
    baked = bake(sky, sizes=sizes, specular="mirror:", coat="constant:k=0.5", refraction="clear:eta=1.5")
    assert baked.tables.maps.keys() == {Role.SPECULAR, Role.COAT, Role.REFRACTION}
    for image in baked.tables.maps.values():
        np.testing.assert_array_equal(image, sky)
    half = bake(sky, sizes=sizes, retro="mirror:ks=0.5").tables.maps[Role.RETRO]
    np.testing.assert_array_equal(half, 0.5 * sky)
    assert baked.bounds == {}


def test_a_mirror_of_another_size_keeps_the_power() -> None:
    small = bake(uneven_sky(), specular="mirror:").tables.maps[Role.SPECULAR]
    assert small.shape == (10, 20, 3)
    power = np.einsum("hw,hwc->c", equirect.texel_solid_angle(20, 10), small)
    expected = np.einsum("hw,hwc->c", equirect.texel_solid_angle(2 * ROWS, ROWS), uneven_sky())
    np.testing.assert_allclose(power, expected, rtol=1e-6)


@pytest.mark.parametrize("name", PRESETS)
def test_in_even_light_tables_are_constant_and_give_the_furnace(name: str) -> None:
    even = np.full((ROWS, 2 * ROWS, 3), 2.0, dtype=np.float32)
    # A Phong lobe of n = 200 is as wide as three rows of 7 degrees: what is summed are texels, and
    # their sum over a lobe that narrow is no longer its integral. So the map is of 96 rows here.
    fine = np.repeat(np.repeat(even, 4, axis=0), 4, axis=1)
    texts = {part: text for part, text in PRESETS[name].items() if part != "emission"}
    if texts.keys() == {"coat"}:
        texts["diffuse"] = "lambert:kd=0"
    material = material_from_texts(texts, no_measured)
    tables = bake(fine, **texts).tables
    total = np.zeros((COLUMNS, 3))
    for role, image in tables.maps.items():
        # Sums over texels miss integrals of kinked lobes by the square of a texel's 1.9 degrees.
        np.testing.assert_allclose(image, np.broadcast_to(image[4, 4], image.shape), rtol=5e-3)
        total += tables.weights[list(Role).index(role)] * image.mean(axis=(0, 1))
    np.testing.assert_allclose(total, 2.0 * furnace(material), rtol=3e-3)
    assert furnace(material).max() <= 1.0 + 1e-12


@pytest.mark.parametrize("place", [(3, 7), (20, 0), (12, 47)])
def test_one_lit_texel_shows_the_lobe(place: tuple[int, int]) -> None:
    radiance, light_dir, solid_angle = lit_texel(*place)
    sizes = TableSizes(40, 60)
    maps = bake(radiance, sizes=sizes, diffuse="lambert:kd=1", specular="phong:n=9,ks=1").tables.maps
    lambert = np.maximum(directions(40) @ light_dir, 0.0) * solid_angle / np.pi
    np.testing.assert_allclose(maps[Role.DIFFUSE][..., 1], lambert, rtol=SINGLE, atol=1e-14)
    lobe = phong(9.0)(directions(60) @ light_dir) * solid_angle
    np.testing.assert_allclose(maps[Role.SPECULAR][..., 1], lobe, rtol=0, atol=2e-6 * lobe.max())
    brightest = np.unravel_index(np.argmax(maps[Role.SPECULAR][..., 0]), (60, 120))
    assert directions(60)[brightest] @ light_dir > np.cos(np.pi / 60)


def test_tables_get_as_many_rows_as_lookups_need() -> None:
    assert DIFFUSE_ROWS == 36
    for n in (30.0, 200.0, 3000.0):
        rows = lobe_rows(n, 100_000)
        # The middle between two texels on either side of the peak, where bilinear errs most
        step = np.pi / rows
        corner = np.cos(0.5 * step) ** (2.0 * n)
        assert 0.9 * LOOKUP_ERROR < 1.0 - corner <= LOOKUP_ERROR
    assert lobe_rows(1.0, 512) == DIFFUSE_ROWS
    assert lobe_rows(1e6, 512) == 512
    assert lobe_rows(50.0, 16) == DIFFUSE_ROWS


@pytest.mark.parametrize(
    "texts",
    [
        {"diffuse": "lambert:kd=1", "specular": "phong:n=10,ks=1", "weights": "fresnel:eta=1.5"},
        {"diffuse": "lambert:kd=1", "specular": "mirror:", "weights": "fresnel:metal=gold"},
        {"diffuse": "lambert:kd=0.6", "retro": "phong:n=9,ks=0.4", "coat": "fresnel:eta=1.8"},
        {"specular": "mirror:", "refraction": "clear:eta=0.7", "weights": "fresnel:eta=0.7"},
        {"specular": "mirror:", "refraction": "clear:eta=2.4", "weights": "fresnel:eta=2.4"},
        {"specular": "phong:n=9,ks=1", "coat": "constant:k=0.5"},
    ],
)
def test_weights_share_out_all_light_and_no_more(texts: dict[str, str]) -> None:
    total = furnace(material_from_texts(texts, no_measured))
    # Nothing here absorbs but gold's base, of which Lambert catches what the boundary lets through.
    np.testing.assert_allclose(total, 1.0, atol=1e-12)


def test_fresnel_weights_are_fresnels() -> None:
    material = material_from_texts(
        {"diffuse": "lambert:kd=0.5", "specular": "mirror:", "weights": "fresnel:eta=1.5"}, no_measured
    )
    diffuse, specular = table_weights(material)[:2]
    mu = weight_cosines()
    np.testing.assert_allclose(specular[:, 0], fresnel_conductor(mu, 1.5, 0.0), rtol=1e-14)
    np.testing.assert_allclose(diffuse + specular, 1.0, rtol=1e-14)
    assert specular[-1, 0] == pytest.approx(0.04, rel=1e-2)  # (.5 / 2.5)^2 at normal incidence
    assert np.all(np.diff(specular[:, 0]) < 0.0)


def test_nothing_passes_beyond_the_critical_angle() -> None:
    texts = {"specular": "mirror:", "refraction": "clear:eta=0.75,tint=0.5", "weights": "fresnel:eta=0.75"}
    weights = table_weights(material_from_texts(texts, no_measured))
    specular, refraction = weights[1], weights[4]
    total = weight_cosines() < np.sqrt(1.0 - 0.75**2)
    assert 0 < np.count_nonzero(total) < COLUMNS
    np.testing.assert_allclose(refraction[total], 0.0, atol=1e-12)
    np.testing.assert_allclose(specular[total], 1.0, rtol=1e-12)
    np.testing.assert_allclose(refraction, 0.5 * (1.0 - specular), atol=1e-12)


def test_weights_of_a_brdf_are_its_albedo_part_by_part() -> None:
    spec = "sum:parts=(phong:kd=0.2/0.3/0.4,n=20,ks=0.3)+(retroreflective:n=9,ks=0.1)"
    texts = {
        "diffuse": "lambert:kd=1",
        "specular": "phong:n=20,ks=1",
        "retro": "phong:n=9,ks=1",
        "weights": f"albedo:brdf=({spec})",
    }
    material = material_from_texts(texts, no_measured)
    expected = directional_albedo(brdf_from_spec(spec, no_measured), weight_cosines())
    np.testing.assert_allclose(furnace(material), expected, rtol=1e-10)
    np.testing.assert_allclose(
        table_weights(material)[0], np.broadcast_to([0.2, 0.3, 0.4], (COLUMNS, 3)), rtol=1e-5
    )
    assert np.all(table_weights(material) <= 1.0)


def test_what_lies_under_a_coat_of_a_brdf_is_diffuse_still() -> None:
    layered = "layered:coat=(ggx:alpha=0.2,eta=1.5),base=(lambert:kd=0.5)"
    texts = {"diffuse": "lambert:kd=1", "weights": f"albedo:brdf=({layered})"}
    with pytest.raises(RangeError, match="BRDF has a specular part, so the material needs a specular table"):
        table_weights(material_from_texts(texts, no_measured))
    weights = table_weights(material_from_texts(texts | {"specular": "phong:n=50,ks=1"}, no_measured))
    assert 0.3 < weights[0, -1, 0] < 0.5
    assert 0.03 < weights[1, -1, 0] < 0.06


def test_more_light_than_there_is_gets_a_warning() -> None:
    bright = material_from_texts({"diffuse": "lambert:kd=0.8", "specular": "phong:n=9,ks=0.9"}, no_measured)
    with pytest.warns(RsibrWarning, match=r"reflects 1\.7 times the light it receives at \d+ degrees"):
        warn_of_table_gain(bright)


@pytest.mark.parametrize(
    ("texts", "sentence"),
    [
        ({}, "needs a table at least: give it a diffuse or a specular part"),
        ({"weights": "fresnel:eta=1.5"}, "needs a table at least"),
        ({"difuse": "lambert:kd=1"}, "difuse: a material has no such part: choose from diffuse, emission"),
        ({"diffuse": "mirror:"}, 'diffuse: there is no model "mirror" for it: choose one of lambert, lumi'),
        ({"diffuse": "lambert"}, "diffuse: lambert: kd is missing; it must be one number, or three"),
        ({"diffuse": "lambert:kd=2"}, "diffuse: lambert: kd is 2, but it must be from 0 to 1"),
        ({"specular": "phong:n=0.5,ks=1"}, r"specular: phong: n is 0\.5, but it must be from 1 to"),
        ({"specular": "phong:n=nan,ks=1"}, "specular: phong: n is nan"),
        ({"emission": "-1"}, "emission: radiance is -1, but it must be from 0 to"),
        ({"coat": "fresnel:"}, "coat: fresnel: its reflectance must be one of metal=NAME"),
        ({"refraction": "clear:eta=0"}, "refraction: clear: eta is 0"),
        ({"weights": "albedo:brdf=ggx", "diffuse": "lambert:kd=1"}, "weights: albedo: brdf is"),
    ],
)
def test_what_is_no_material_is_refused(texts: dict[str, str], sentence: str) -> None:
    with pytest.raises(RangeError, match=sentence):
        material_from_texts(texts, no_measured)


def test_presets_have_their_old_names_as_well() -> None:
    assert preset("matte") is PRESETS["clay"]
    assert preset("varnished") is PRESETS["varnished-wood"]


def test_a_lobe_narrower_than_the_environment_is_refused_by_name() -> None:
    with pytest.raises(RangeError, match=r"retro: Lobe 1 is .* wide, and a map of 24 rows resolves"):
        bake(uneven_sky(), retro="phong:n=1000,ks=1")


def test_impossible_sizes_and_shapes_are_refused() -> None:
    for sizes in ((0, None), (36, 10_000)):
        with pytest.raises(RangeError, match=r"A table cannot have .* rows: choose 1 to 8192"):
            TableSizes(*sizes)
    square, weights = np.ones((4, 4, 3), np.float32), np.ones((5, 2, 3), np.float32)
    with pytest.raises(ShapeError, match="diffuse table must have the shape"):
        ReflectionTables({Role.DIFFUSE: square}, weights)
    with pytest.raises(ShapeError, match="at least one map"):
        ReflectionTables({}, weights)
    with pytest.raises(ShapeError, match="Weights have the shape"):
        ReflectionTables({Role.DIFFUSE: square[:2]}, weights[:2])
    with pytest.raises(RangeError, match="index of refraction"):
        ReflectionTables({Role.DIFFUSE: square[:2]}, weights, np.nan)
