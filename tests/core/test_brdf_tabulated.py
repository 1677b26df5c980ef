"""Tables of reflectance: their angles, their interpolation, and what is made of measurements."""

import numpy as np
import pytest
from rsibr.rsibr_addon.core.brdf import measured_cornell
from rsibr.rsibr_addon.core.brdf.albedo import directional_albedo, hemisphere_quadrature
from rsibr.rsibr_addon.core.brdf.cook_torrance import CookTorrance
from rsibr.rsibr_addon.core.brdf.fresnel import Index, Schlick
from rsibr.rsibr_addon.core.brdf.ggx import Ggx
from rsibr.rsibr_addon.core.brdf.lambert import Lambert
from rsibr.rsibr_addon.core.brdf.layered import Sum
from rsibr.rsibr_addon.core.brdf.measured_cornell import (
    DARKEST,
    MOST_SAMPLES,
    NEIGHBOURS,
    Facets,
    scattered_brdf,
)
from rsibr.rsibr_addon.core.brdf.measured_merl import SCALE, below_horizon, merl_brdf
from rsibr.rsibr_addon.core.brdf.measured_merl import SHAPE as MERL_SHAPE
from rsibr.rsibr_addon.core.brdf.model import Brdf, Geometry
from rsibr.rsibr_addon.core.brdf.tabulated import (
    Tabulated,
    cell_directions,
    directions_from_angles,
    fill_missing,
    half_difference_angles,
    tabulate,
)
from rsibr.rsibr_addon.core.brdf.ward import Ward
from rsibr.rsibr_addon.core.errors import RangeError, ShapeError

SHAPE = (20, 12, 10)


def above(count: int, seed: int, lowest: float = 0.0) -> np.ndarray:
    rng = np.random.default_rng(seed)
    z, phi = rng.uniform(lowest, 1.0, count), 2.0 * np.pi * rng.random(count)
    radius = np.sqrt(1.0 - z**2)
    return np.stack([radius * np.cos(phi), radius * np.sin(phi), z], axis=-1)


def test_angles_and_directions_are_inverse() -> None:
    rng = np.random.default_rng(0)
    theta_h, theta_d, phi_d = rng.random(2000) * 0.7, rng.random(2000) * 0.7, rng.uniform(-np.pi, np.pi, 2000)
    light_dir, view_dir = directions_from_angles(theta_h, theta_d, phi_d)
    np.testing.assert_allclose(np.linalg.norm([light_dir, view_dir], axis=-1), 1.0, rtol=1e-12)
    # Any turn about the normal has the same angles
    turn = np.array([[np.cos(1.0), -np.sin(1.0), 0.0], [np.sin(1.0), np.cos(1.0), 0.0], [0.0, 0.0, 1.0]])
    found = half_difference_angles(Geometry(light_dir @ turn.T, view_dir @ turn.T))
    for ours, expected in zip(found, (theta_h, theta_d, phi_d), strict=True):
        # The azimuth has 1e-16 / (sin theta_h sin theta_d), and angles as small as 1e-4 are drawn
        np.testing.assert_allclose(ours, expected, rtol=0, atol=1e-7)


def test_the_light_goes_downhill_at_azimuth_0() -> None:
    # By hand: half vector leant towards +x by 20 degrees, light 30 degrees further down
    light_dir, view_dir = directions_from_angles(np.radians(20.0), np.radians(30.0), 0.0)
    np.testing.assert_allclose(
        light_dir, [np.sin(np.radians(50.0)), 0.0, np.cos(np.radians(50.0))], atol=1e-15
    )
    np.testing.assert_allclose(
        view_dir, [-np.sin(np.radians(10.0)), 0.0, np.cos(np.radians(10.0))], atol=1e-15
    )


def test_cells_give_back_what_was_put_in() -> None:
    brdf = Ggx(alpha=0.3, fresnel=Index(eta=(0.2, 0.9, 1.1), k=(3.9, 2.5, 2.1)))
    table = tabulate(brdf, "copper", SHAPE)
    light_dir, view_dir = cell_directions(SHAPE)
    visible = (light_dir[..., 2] > 0.0) & (view_dir[..., 2] > 0.0)
    assert 0.6 < visible.mean() < 0.9
    np.testing.assert_allclose(
        table(light_dir, view_dir)[visible], brdf(light_dir, view_dir)[visible], rtol=1e-9
    )
    assert table.spec == "copper"


def test_functions_linear_in_the_tables_angles_are_kept_between_cells() -> None:
    def ramp(light_dir: np.ndarray, view_dir: np.ndarray) -> np.ndarray:
        theta_h, theta_d, _ = half_difference_angles(Geometry(light_dir, view_dir))
        return np.stack([np.sqrt(theta_h), theta_d, 1.0 + np.sqrt(theta_h) * theta_d], axis=-1)

    table = tabulate(ramp, "ramp", SHAPE)
    light_dir, view_dir = above(3000, 1), above(3000, 2)
    theta_h, theta_d, _ = half_difference_angles(Geometry(light_dir, view_dir))
    # Away from the table's ends, where values are held, and from cells that a horizon leaves to neighbours
    inside = (theta_h > 0.01) & (theta_d > 0.1) & (theta_h + theta_d < 1.2)
    assert inside.sum() > 500
    np.testing.assert_allclose(
        table(light_dir, view_dir)[inside], ramp(light_dir, view_dir)[inside], rtol=1e-9
    )


def test_tables_are_reciprocal_whatever_they_hold() -> None:
    values = np.random.default_rng(3).random((*SHAPE, 3))
    table, light_dir, view_dir = Tabulated(values, "noise"), above(2000, 4), above(2000, 5)
    # Noise turns the rounding of angles, 1e-15 / sin, into differences: its slope is about one in a cell
    np.testing.assert_allclose(table(light_dir, view_dir), table(view_dir, light_dir), rtol=0, atol=1e-9)


@pytest.mark.parametrize("shape", [(1, 1, 1), (2, 1, 3), (1, 5, 1)])
def test_tables_of_single_cells_work(shape: tuple[int, int, int]) -> None:
    table = Tabulated(np.full((*shape, 3), 0.25), "flat")
    np.testing.assert_allclose(table(above(50, 6), above(50, 7)), 0.25, rtol=1e-12)


def test_a_finer_table_is_closer() -> None:
    brdf, light_dir, view_dir = Ward(alpha=0.1, ks=0.5, kd=0.1), above(4000, 8, 0.2), above(4000, 9, 0.2)
    expected = brdf(light_dir, view_dir)
    errors = [
        np.sqrt(np.mean((tabulate(brdf, "", shape)(light_dir, view_dir) - expected) ** 2))
        for shape in ((12, 8, 6), (24, 16, 12), (48, 32, 24))
    ]
    # Linear interpolation errs with the square of the step
    assert errors[1] < errors[0] / 2.5
    assert errors[2] < errors[1] / 2.5


def test_missing_cells_take_the_nearest_azimuth() -> None:
    nan = np.nan
    row = np.array([nan, 1.0, nan, nan, nan, 5.0, nan])
    table = np.stack([row, 10.0 * row, 100.0 * row], axis=-1)[None, None]
    table[0, 0, 1, 2] = 7.0
    filled = fill_missing(table)
    np.testing.assert_array_equal(filled[0, 0, :, 0], [1, 1, 1, 1, 5, 5, 5])
    np.testing.assert_array_equal(filled[0, 0, :, 2], [7, 7, 7, 7, 500, 500, 500])
    assert not fill_missing(np.full((2, 1, 3, 3), nan)).any()


@pytest.mark.parametrize("shape", [(4, 4, 3), (4, 4, 4, 4), (0, 4, 4, 3)])
def test_tables_of_other_shapes_are_refused(shape: tuple[int, ...]) -> None:
    with pytest.raises(ShapeError, match=r"shape \(H, D, P, 3\)"):
        Tabulated(np.zeros(shape), "")


def test_a_merl_measurement_is_scaled_and_indexed_as_its_database_says() -> None:
    light_dir, view_dir = cell_directions(MERL_SHAPE)
    visible = ~below_horizon()
    samples = np.full((*MERL_SHAPE, 3), np.nan)
    brdf = Lambert(kd=(0.3, 0.6, 0.9))
    samples[visible] = brdf(light_dir[visible], view_dir[visible]) / SCALE
    # Cell (h, d, p) of the file: theta_h = (h / 90)^2 pi / 2 and so on, as the database's reader computes
    samples[40, 20, 100] = 1500.0
    table = merl_brdf(samples, "merl:path=x")
    theta_h, theta_d, phi_d = (40.5 / 90) ** 2 * np.pi / 2, 20.5 / 90 * np.pi / 2, 100.5 / 180 * np.pi
    found = table(*directions_from_angles(theta_h, theta_d, phi_d))
    np.testing.assert_allclose(found, [1.0, 1.15, 1.66], rtol=1e-9)
    found = table(above(500, 10), above(500, 11))
    expected = np.broadcast_to(np.array([0.3, 0.6, 0.9]) / np.pi, (500, 3))
    np.testing.assert_allclose(found, expected, rtol=1e-9)  # none of these is beside that cell
    with pytest.raises(ShapeError, match="MERL"):
        merl_brdf(samples[:80], "")


def goniometer() -> tuple[np.ndarray, np.ndarray]:
    """Pairs of directions as Cornell's instrument takes them: eight lights, rings of views."""
    light, view = [], []
    for theta_i in np.radians(np.arange(10.0, 81.0, 10.0)):
        for ring, theta_s in enumerate(np.radians([0.1, 8, 16, 25, 33, 41, 50, 59, 69, 79])):
            for phi in np.linspace(0.0, np.pi, 4 * ring + 1):
                light.append((theta_i, 0.0))
                view.append((theta_s, phi))
    return tuple(
        np.stack([np.sin(t) * np.cos(p), np.sin(t) * np.sin(p), np.cos(t)], axis=-1)
        for t, p in (np.transpose(light), np.transpose(view))
    )


def test_scattered_samples_of_a_known_paint_give_the_paint_back() -> None:
    light_dir, view_dir = goniometer()
    assert 1200 < len(light_dir) < 1700
    paint = Sum(parts=(CookTorrance(alpha=0.15, fresnel=Index(eta=1.5)), Lambert(kd=(0.2, 0.1, 0.05))))
    table = scattered_brdf(light_dir, view_dir, paint(light_dir, view_dir), "paint")
    # Where nothing was measured: between the lights and the rings, up to 75 degrees
    light, view = above(3000, 12, 0.26), above(3000, 13, 0.26)
    ratio = table(light, view) / paint(light, view)
    # Fits through samples ten degrees apart: two per cent in the median, more only where the lobe bends
    assert np.median(np.abs(ratio - 1.0)) < 0.02
    assert np.percentile(np.abs(ratio - 1.0), 95) < 0.12
    # The coat makes most of the albedo at 0.3, where its peak falls between samples
    np.testing.assert_allclose(
        directional_albedo(table, [0.9, 0.6, 0.3]), directional_albedo(paint, [0.9, 0.6, 0.3]), rtol=0.05
    )


@pytest.mark.parametrize(
    ("material", "facets"),
    [
        (Sum(parts=(Ggx(alpha=0.06, fresnel=Schlick(f0=0.04)), Lambert(kd=0.01))), Facets(0.1, coated=True)),
        (Sum(parts=(Ggx(alpha=0.3, fresnel=Schlick(f0=0.04)), Lambert(kd=0.2))), Facets(1.0, coated=True)),
        (Ggx(alpha=0.3, fresnel=Schlick(f0=0.9)), Facets(1.0, coated=False)),
        (Ward(alpha=0.2, ks=0.3, kd=0.1), Facets(1.0, coated=False)),
        (Lambert(kd=0.3), Facets(1.0, coated=False)),
    ],
    ids=["coat", "latex", "metal", "ward", "lambert"],
)
def test_elevations_beyond_the_measured_ones_follow_from_these(material: Brdf, facets: Facets) -> None:
    light_dir, view_dir = goniometer()
    model = scattered_brdf(light_dir, view_dir, material(light_dir, view_dir), "")
    assert model.facets == facets
    # 85 degrees; samples end at 80. Facets of a thin coat would reflect twice what a Lambert surface does
    beyond = [0.09]
    np.testing.assert_allclose(
        directional_albedo(model, beyond), directional_albedo(material, beyond), rtol=0.2
    )


def test_a_sharp_coat_has_one_peak_at_all_elevations(monkeypatch: pytest.MonkeyPatch) -> None:
    light_dir, view_dir = goniometer()
    paint = Sum(parts=(Ggx(alpha=0.06, fresnel=Schlick(f0=0.04)), Lambert(kd=0.01)))
    noise = np.random.default_rng(3).normal(scale=0.05, size=(len(light_dir), 1))
    values = paint(light_dir, view_dir) * np.exp(noise)

    def error(mu: float) -> float:
        table = scattered_brdf(light_dir, view_dir, values, "")
        around, weight = hemisphere_quadrature(mu, 6, 16, 1e-3)
        view = np.array([-np.sqrt(1.0 - mu**2), 0.0, mu])
        truth = paint(around, view) * around[:, 2:]
        missed = table(around, view) * around[:, 2:] - truth
        return float(np.sqrt(np.max(weight @ missed**2 / (weight @ truth**2))))

    with_profile = error(0.35)
    monkeypatch.setattr(measured_cornell, "REACHES", ())
    # Planes alone follow each elevation's few samples: ten degrees apart, a few of which hit the peak
    assert with_profile < 0.5 * error(0.35)


def test_dark_samples_are_missing_not_black() -> None:
    light_dir, view_dir = goniometer()
    values = np.full((len(light_dir), 3), 0.1)
    values[::3] = DARKEST / 2.0
    table = scattered_brdf(light_dir, view_dir, values, "")
    found = table(above(500, 14, 0.2), above(500, 15, 0.2))
    # A constant is curved as a density of facets, so it comes back roughly; black samples would pull the
    # mean of logarithms to a hundredth
    assert found.min() > 0.07
    assert abs(np.median(found) - 0.1) < 0.003
    few = np.zeros_like(values)
    few[:NEIGHBOURS] = 0.1
    with pytest.raises(RangeError, match="more than 8 samples"):
        scattered_brdf(light_dir, view_dir, few, "")


def test_more_samples_than_anyone_measures_are_refused() -> None:
    directions = np.tile([0.0, 0.6, 0.8], (MOST_SAMPLES + 1, 1))
    with pytest.raises(RangeError, match=f"keep {MOST_SAMPLES} at most"):
        scattered_brdf(directions, directions, np.full((MOST_SAMPLES + 1, 3), 0.1), "")


def test_scattered_models_are_the_same_on_both_sides() -> None:
    light_dir, view_dir = goniometer()
    rng = np.random.default_rng(16)
    table = scattered_brdf(light_dir, view_dir, rng.uniform(0.05, 0.1, (len(light_dir), 3)), "")
    mirror = np.array([1.0, -1.0, 1.0])
    light, view = above(500, 17), above(500, 18)
    np.testing.assert_allclose(table(light, view), table(light * mirror, view * mirror), rtol=1e-7)
    np.testing.assert_allclose(table(light, view), table(view, light), rtol=1e-7)


def test_a_mirror_like_schlick_keeps_its_colour() -> None:
    light_dir, view_dir = goniometer()
    brdf = CookTorrance(alpha=0.3, fresnel=Schlick(f0=(0.9, 0.5, 0.1), f90=(0.9, 0.5, 0.1)))
    values = brdf(light_dir, view_dir)
    table = scattered_brdf(light_dir, view_dir, values, "")
    found = table(above(500, 19, 0.3), above(500, 20, 0.3))
    np.testing.assert_allclose(
        found / found.sum(axis=1, keepdims=True), [[0.6, 1 / 3, 0.1 / 1.5]] * 500, rtol=1e-9
    )
