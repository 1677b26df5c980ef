"""Shading from reflection tables against closed forms."""

import numpy as np
import pytest
from rsibr.rsibr_addon.core.antialiased.averaging import Averaging
from rsibr.rsibr_addon.core.conventions import texel_centres
from rsibr.rsibr_addon.core.errors import RangeError
from rsibr.rsibr_addon.core.filtering.radial_lobes import phong_lobe
from rsibr.rsibr_addon.core.geometry.directions import dot, normalize
from rsibr.rsibr_addon.core.geometry.sides import seen_surface
from rsibr.rsibr_addon.core.kinds.reflection_tables.bake import LOOKUP_ERROR, lobe_rows
from rsibr.rsibr_addon.core.kinds.reflection_tables.shading import (
    TablesLook,
    lookup_direction,
    reflect_tables,
)
from rsibr.rsibr_addon.core.kinds.reflection_tables.tables import ReflectionTables, Role
from rsibr.rsibr_addon.core.maps import equirect
from rsibr.tests.synthetic_views import environment_radiance

RNG = np.random.default_rng(31)
NORMAL = normalize(RNG.normal(size=(400, 3)))
VIEW = normalize(NORMAL + 0.9 * normalize(RNG.normal(size=(400, 3))))
ONES = np.ones((len(Role), 1, 3), np.float32)


def table(rows: int) -> np.ndarray:
    return environment_radiance(equirect.direction_from_uv(texel_centres(2 * rows, rows))).astype(np.float32)


@pytest.mark.parametrize("role", Role)
def test_every_table_goes_by_its_own_direction(role: Role) -> None:
    tables = ReflectionTables({role: table(256)}, ONES, 1.5)
    cosine = dot(NORMAL, VIEW)[:, None]
    across = VIEW - cosine * NORMAL
    expected = {
        Role.DIFFUSE: NORMAL,
        Role.SPECULAR: cosine * NORMAL - across,
        Role.COAT: cosine * NORMAL - across,
        Role.RETRO: VIEW,
        Role.REFRACTION: -across / 1.5 - np.sqrt(1.0 - (1.0 - cosine**2) / 1.5**2) * NORMAL,
    }[role]
    np.testing.assert_allclose(
        lookup_direction(role, seen_surface(NORMAL, VIEW), VIEW, 1.5), expected, atol=1e-14
    )
    shown = reflect_tables(tables, NORMAL, VIEW, TablesLook())
    # The radiance's second derivatives are below 4, along a parallel too but for what meridians' meeting
    # adds near the poles; h^2 / 8 of it along each axis.
    step = np.pi / 256
    np.testing.assert_allclose(shown, environment_radiance(expected), atol=3.0 * 4.0 * step**2 / 4.0)


def test_tables_add_up_by_their_weights() -> None:
    weights = RNG.random((len(Role), 8, 3), dtype=np.float32)
    maps = {role: np.full((4, 8, 3), 1.0 + number, np.float32) for number, role in enumerate(Role)}
    tables = ReflectionTables(maps, weights)
    columns = (np.arange(8) + 0.5) / 8
    cosine = dot(NORMAL, VIEW)
    total = np.zeros((400, 3))
    for number, role in enumerate(Role):
        weight = np.stack([np.interp(cosine, columns, channel) for channel in weights[number].T], axis=-1)
        alone = reflect_tables(tables, NORMAL, VIEW, TablesLook((role,)))
        np.testing.assert_allclose(alone, (1.0 + number) * weight, rtol=1e-12)
        total += alone
    np.testing.assert_allclose(reflect_tables(tables, NORMAL, VIEW, TablesLook()), total, rtol=1e-12)


def test_weights_of_the_look_multiply_those_of_the_tables() -> None:
    maps = {role: RNG.random((4, 8, 3), dtype=np.float32) for role in Role}
    tables = ReflectionTables(maps, RNG.random((len(Role), 8, 3), dtype=np.float32))
    factors = {role: 0.5 + number for number, role in enumerate(Role)}
    expected = sum(
        factor * reflect_tables(tables, NORMAL, VIEW, TablesLook((role,))) for role, factor in factors.items()
    )
    look = TablesLook(**{f"w_{role}": factor for role, factor in factors.items()})
    np.testing.assert_allclose(reflect_tables(tables, NORMAL, VIEW, look), expected, rtol=1e-12)
    with pytest.raises(RangeError, match="Coat Weight cannot be -1"):
        TablesLook(w_coat=-1.0)


def test_a_mirror_shows_texels_where_they_are() -> None:
    image = RNG.random((6, 12, 3), dtype=np.float32)
    texels = equirect.direction_from_uv(texel_centres(12, 6))
    tables = ReflectionTables({Role.SPECULAR: image}, ONES)
    view_dir = np.broadcast_to((0.0, 0.6, 0.8), texels.shape)
    shown = reflect_tables(tables, normalize(texels + view_dir), view_dir, TablesLook())
    np.testing.assert_allclose(shown, image, atol=1e-12)


def test_lookups_go_on_across_the_seam_and_along_meridians_over_poles() -> None:
    tables = ReflectionTables({Role.DIFFUSE: RNG.random((6, 12, 3), dtype=np.float32)}, ONES)
    pairs = normalize([((-1, 1e-9, 0.2), (-1, -1e-9, 0.2)), ((1e-9, 2e-9, 1), (-1e-9, -2e-9, 1))])
    shown = reflect_tables(tables, pairs, pairs, TablesLook())
    np.testing.assert_allclose(shown[:, 0], shown[:, 1], atol=1e-7)


@pytest.mark.parametrize("n", [30.0, 300.0])
def test_a_bilinear_lookup_errs_as_little_as_tables_are_sized_for(n: float) -> None:
    rows = lobe_rows(n, 10_000)
    light_dir = normalize((0.7, -0.5, 0.3))
    profile = phong_lobe(n).profile

    def lobe(directions: np.ndarray) -> np.ndarray:
        return profile(np.arccos(np.clip(directions @ light_dir, -1.0, 1.0)))[..., None] * np.ones(3)

    sampled = lobe(equirect.direction_from_uv(texel_centres(2 * rows, rows))).astype(np.float32)
    tables = ReflectionTables({Role.DIFFUSE: sampled}, ONES)
    around = normalize(light_dir + RNG.normal(size=(20_000, 3)) * RNG.uniform(0.0, 0.3, (20_000, 1)))
    error = np.abs(reflect_tables(tables, around, around, TablesLook()) - lobe(around)).max()
    peak = lobe(light_dir).max()
    assert 0.5 * LOOKUP_ERROR * peak < error < 1.02 * LOOKUP_ERROR * peak


def test_antialiased_tables_are_means_over_the_pixel() -> None:
    rng = np.random.default_rng(32)
    maps = {role: rng.random((16, 32, 3)) for role in (Role.SPECULAR, Role.COAT)}
    weights = rng.random((len(Role), 1, 3))
    tables = ReflectionTables(maps, weights)
    # The corners of a box of 2 x 1 texels, which is not parted, and whose mean is by hand.
    corners = equirect.direction_from_uv(np.array([(8, 6), (10, 6), (10, 7), (8, 7)]) / (32, 16))
    normal = view_dir = np.array([0.0, 0.0, 1.0])
    solid_angle = equirect.texel_solid_angle(32, 16)[6:7, 8:10, None]
    expected = sum(
        weights[row, 0] * np.sum(maps[role][6:7, 8:10] * solid_angle, axis=(0, 1)) / solid_angle.sum()
        for row, role in ((1, Role.SPECULAR), (2, Role.COAT))
    )
    look = TablesLook(averaging=Averaging.SUMMED)
    shown = reflect_tables(tables, normal, view_dir, look, corners)
    np.testing.assert_allclose(shown, expected, rtol=1e-12)


def test_a_look_names_tables_that_there_are() -> None:
    assert TablesLook(("diffuse", Role.COAT)).shown == (Role.DIFFUSE, Role.COAT)
    with pytest.raises(RangeError, match="Tables cannot be 'chrome': choose one of diff"):
        TablesLook(("chrome",))
    with pytest.raises(RangeError, match="needs a table: choose from diffuse, specular"):
        TablesLook(())
