"""Lobes fitted to captures that are known exactly: what they predict, and what they say of themselves."""

import numpy as np
import pytest
from rsibr.rsibr_addon.core.brdf.lambert import Lambert
from rsibr.rsibr_addon.core.brdf.spec import brdf_from_spec
from rsibr.rsibr_addon.core.conventions import Array, texel_centres
from rsibr.rsibr_addon.core.errors import RangeError
from rsibr.rsibr_addon.core.geometry.geodesic import geodesic_sphere
from rsibr.rsibr_addon.core.geometry.lit_sphere import lit_spheres
from rsibr.rsibr_addon.core.kinds.radiance_views.views import RadianceViews
from rsibr.rsibr_addon.core.lobes.captured_texels import captured_texels
from rsibr.rsibr_addon.core.lobes.captures import CapturedFit, fit_captures, lambert_family
from rsibr.rsibr_addon.core.lobes.family import KERNELS
from rsibr.rsibr_addon.core.lobes.family_fit import CLOSER_LOBES
from rsibr.rsibr_addon.core.lobes.fit import Fit
from rsibr.rsibr_addon.core.lobes.fit_in_views import fit_radiance
from rsibr.rsibr_addon.core.lobes.tridiagonal import Tridiagonal
from rsibr.rsibr_addon.core.maps import sphere_map
from rsibr.rsibr_addon.core.progress import drain
from rsibr.rsibr_addon.tasks.methods.fit_captures import filtered_light, shipped_families

HEIGHT, SIZE, FINER = 64, 32, 6
COPPER = brdf_from_spec("ggx:alpha=0.3,metal=copper", lambda name, path: Lambert(kd=0.0))
PAINT = Lambert(kd=(0.5, 0.1, 0.05))


def light(seed: int) -> Array:
    """Mostly dim light with a few bright texels in each row."""
    return np.random.default_rng(seed).random((HEIGHT, 2 * HEIGHT, 3)) ** 16


def captured(model, radiance: Array) -> Array:
    """All 42 views of a model, each texel the mean over its area."""
    spheres = drain(lit_spheres(model, radiance, list(geodesic_sphere(42).vertices), 32))
    points = texel_centres(SIZE * FINER, SIZE * FINER)
    on_sphere = np.linalg.norm(2.0 * points - 1.0, axis=-1) < 1.0
    normal = sphere_map.normal_from_uv(points)

    def means(values: Array) -> Array:
        return values.reshape(SIZE, FINER, SIZE, FINER, *values.shape[2:]).mean(axis=(1, 3))

    return np.stack(
        [
            sphere_map.fill_rim(
                means(sphere.at(normal @ sphere.frame.T) * on_sphere[..., None]), means(on_sphere)
            )
            for sphere in spheres
        ]
    )


def error_of(fit: Fit, radiance: Array, views: RadianceViews) -> float:
    """Relative error of a fit in the 30 views beyond the first 12."""
    lit = filtered_light(radiance)
    texels = captured_texels(views, 42, 10000, lit.suns.direction)
    new, true = texels.view >= 12, texels.diffuse + texels.glossy
    ours = fit_radiance(fit, lit, texels)
    counts = texels.stands_for[new, None]
    return float(np.sqrt(np.sum(counts * (ours - true)[new] ** 2) / np.sum(counts * true[new] ** 2)))


def fitted(views: RadianceViews, radiance: Array, count: int) -> CapturedFit:
    return drain(fit_captures(views, filtered_light(radiance), shipped_families(), "captured", count))


@pytest.fixture(scope="module")
def views() -> RadianceViews:
    return RadianceViews(captured(PAINT, light(1)), captured(COPPER, light(1)))


@pytest.fixture(scope="module")
def twelve(views: RadianceViews) -> CapturedFit:
    return fitted(views, light(1), 12)


@pytest.mark.slow
def test_twelve_views_tell_the_material(views: RadianceViews, twelve: CapturedFit) -> None:
    # Texels are averages, and 32 of them across a sphere are few
    assert twelve.widths == pytest.approx((0.3,), rel=0.03)
    # A sphere averages over many lights, so that the family's own error, E .05 to .1, counts little
    assert error_of(twelve.fit, light(1), views) < 0.02
    # Glossy lobes and a diffuse one
    assert twelve.fit.weights.shape[:2] == (CLOSER_LOBES + 1, 16)
    assert twelve.fit.method == "captured"


@pytest.mark.slow
def test_it_states_its_own_error(views: RadianceViews, twelve: CapturedFit) -> None:
    true = error_of(twelve.fit, light(1), views)
    assert twelve.fit.left_out is not None
    assert true / 1.5 < twelve.fit.left_out < 1.5 * true


@pytest.mark.slow
def test_it_can_be_lit_anew(twelve: CapturedFit) -> None:
    other = light(2)
    relit = RadianceViews(captured(PAINT, other), captured(COPPER, other))
    assert error_of(twelve.fit, other, relit) < 0.025


@pytest.mark.slow
def test_one_view_tells_most(views: RadianceViews) -> None:
    one = fitted(views, light(1), 1)
    assert one.fit.left_out is None
    assert error_of(one.fit, light(1), views) < 0.06


def test_black_and_missing_views_are_refused() -> None:
    black = RadianceViews(*np.zeros((2, 12, 8, 8, 3), dtype=np.float32))
    with pytest.raises(RangeError, match="black or not finite: capture the material in light"):
        fitted(black, light(1), 12)
    with pytest.raises(RangeError, match="only 12 views, not 13: use fewer or capture more"):
        fitted(black, light(1), 13)


def test_a_white_lambert_surface_reflects_all_uniform_light() -> None:
    mu = np.array([0.1, 0.5, 0.9])
    albedo = lambert_family(mu, KERNELS).albedo[0]
    np.testing.assert_allclose(albedo[:, 0], 1.0, rtol=1e-9)
    np.testing.assert_allclose(albedo[:, 1], mu, rtol=1e-9)


def test_texels_know_what_they_are_the_mean_of() -> None:
    views = RadianceViews(*np.random.default_rng(3).random((2, 12, 16, 16, 3), dtype=np.float32))
    texels = captured_texels(views, 12, 1000, np.eye(3)[:1])
    np.testing.assert_allclose(texels.means(np.ones(len(texels.mu))), 1.0, rtol=1e-12)
    # The mean normal of a texel lies in it
    mean = texels.means(texels.normal)
    for number in range(0, len(mean), 97):
        view = texels.view[number]
        x, y, _ = mean[number] @ views.frames[view]
        column, row = (int((along + 1.0) * 8.0) for along in (x, y))
        np.testing.assert_array_equal(texels.glossy[number], views.glossy[view, row, column])


def test_tridiagonal_systems_are_solved_as_whole_ones_are() -> None:
    rng = np.random.default_rng(4)
    blocks, size = 5, 3
    dense = np.zeros((2, blocks * size, blocks * size))
    for number in range(2):
        for block in range(blocks - 1):
            rows = rng.normal(size=(20, 2 * size))
            place = slice(block * size, (block + 2) * size)
            dense[number, place, place] += rows.T @ rows
    by_block = dense.reshape(2, blocks, size, blocks, size).swapaxes(2, 3)
    system = Tridiagonal(
        np.stack([by_block[:, i, i] for i in range(blocks)], axis=1),
        np.stack([by_block[:, i, i + 1] for i in range(blocks - 1)], axis=1),
    )
    right = rng.normal(size=(2, blocks, size, 4))
    solved = system.solve(right)
    expected = np.linalg.solve(dense, right.reshape(2, -1, 4)).reshape(right.shape)
    # Normal equations of 20 rows each are conditioned well
    np.testing.assert_allclose(solved, expected, rtol=1e-9, atol=1e-12)
    np.testing.assert_allclose(system @ solved, right, rtol=1e-9, atol=1e-12)
    powers = system.powers(right[:, block] for block in range(blocks))
    np.testing.assert_allclose(powers, np.sum(right * expected, axis=(1, 2)), rtol=1e-9)
    np.testing.assert_allclose(system.trace(), np.trace(dense, axis1=1, axis2=2), rtol=1e-12)
