"""The next view: what it is expected to tell is what it tells, and it is the best of all."""

from dataclasses import replace

import numpy as np
import pytest
from rsibr.rsibr_addon.core.conventions import Array
from rsibr.rsibr_addon.core.geometry.geodesic import geodesic_sphere
from rsibr.rsibr_addon.core.lobes import next_views as next_views_module
from rsibr.rsibr_addon.core.lobes.bake import filter_environment
from rsibr.rsibr_addon.core.lobes.bank import KernelBank
from rsibr.rsibr_addon.core.lobes.captured_light import CapturedLight, captured_light
from rsibr.rsibr_addon.core.lobes.next_views import (
    NEAREST,
    Candidates,
    Known,
    Weighed,
    candidate_dirs,
    compare_with_new,
    equations_of_views,
    next_views,
)
from rsibr.rsibr_addon.core.lobes.tridiagonal import Tridiagonal

SIZE = 8
MU = np.array([0.2, 0.6, 1.0])
PRECISION = Tridiagonal(np.tile(np.eye(2), (3, 1, 1)), np.tile(-0.2 * np.eye(2), (2, 1, 1)))
PART = Weighed(MU, np.zeros((3, 1)), PRECISION, 3.0)
TEXELS = 0.25 * np.pi * SIZE**2


@pytest.fixture(scope="module")
def light() -> CapturedLight:
    """Dim light with a few bright texels, filtered with two kernels."""
    radiance = np.random.default_rng(1).random((32, 64, 3)) ** 16
    return captured_light(
        radiance,
        KernelBank((4.0, 32.0)),
        lambda light, bank: filter_environment(light, bank, "octahedral", 16),
    )


def equations(light: CapturedLight, view_dirs: Array) -> list[Array]:
    return equations_of_views(view_dirs, SIZE, light, PART)


def rows_of(columns: list[Array]) -> list[Array]:
    """The same equations as rows of all six weights."""
    return [each.reshape(6, -1).T for each in columns]


def whole(system: Tridiagonal) -> Array:
    """A system of six unknowns as one matrix."""
    return (system @ np.eye(6).reshape(3, 2, 6)).reshape(6, 6)


def refitted(precision: Array, told: list[Array], candidates: list[Array], draws: int) -> Array:
    """Squared errors in candidates of weights fitted to the texels of some views, for random true weights."""
    rng = np.random.default_rng(2)
    weights = rng.multivariate_normal(np.zeros(6), np.linalg.inv(precision), draws, method="cholesky").T
    seen = np.concatenate(told)
    captured = seen @ weights + rng.normal(size=(len(seen), draws))
    found = np.linalg.solve(seen.T @ seen + precision, seen.T @ captured)
    errors: Array = np.sum((np.concatenate(candidates) @ (found - weights)) ** 2, axis=0)
    return errors


def test_a_view_tells_what_fits_with_it_gain(light: CapturedLight) -> None:
    captured, views = equations(light, geodesic_sphere(12).vertices[:2]), equations(light, np.eye(3))
    known = Known(PART, captured, TEXELS)
    before, falls, draws = known.errors(views).sum(), Candidates(known, views).falls(), 4000
    precision, captured, views = whole(known.precision), rows_of(captured), rows_of(views)
    for candidate, fall in enumerate(falls):
        told = [*captured, views[candidate]]
        errors = PART.variance / (2.0 * TEXELS) * refitted(precision, told, views, draws)
        # Means of so many draws
        assert abs(errors.mean() - (before - fall)) < 5.0 * errors.std() / np.sqrt(draws)
    assert falls.min() > 0.2 * before


def test_what_a_view_tells_counts_once_it_is_seen(light: CapturedLight) -> None:
    known = Known(PART, equations(light, geodesic_sphere(12).vertices[:2]), TEXELS)
    views = equations(light, np.eye(3))
    candidates, rows = Candidates(known, views), rows_of(views)
    candidates.see(1)
    told, wanted = whole(known.system) + rows[1].T @ rows[1], sum(each.T @ each for each in rows)
    left = [np.trace(np.linalg.solve(told + each.T @ each, wanted)) for each in rows]
    falls = known.variance * (np.trace(np.linalg.solve(told, wanted)) - np.array(left))
    np.testing.assert_allclose(candidates.falls(), falls, rtol=1e-9)


def test_weights_vary_by_as_much_as_views_left_out_say(light: CapturedLight) -> None:
    captured = equations(light, geodesic_sphere(12).vertices[:1])
    precision, (seen,) = whole(Known(PART, captured, TEXELS).precision), rows_of(captured)
    # Without its one view nothing is known
    left_out = np.trace(seen @ np.linalg.inv(precision) @ seen.T)
    # In units of the error of a texel; factors are ten times apart
    assert TEXELS <= left_out < 10.0 * TEXELS


def test_the_highest_price_that_explains_views_left_out_is_taken(light: CapturedLight) -> None:
    # So few texels that two views explain them
    captured, texels = equations(light, geodesic_sphere(12).vertices[:2]), 2.0
    known = Known(PART, captured, texels)
    rows = rows_of(captured)
    every = sum(each.T @ each for each in rows)

    def left_out(precision: Array) -> Array:
        return np.array([np.trace(x @ np.linalg.inv(every - x.T @ x + precision) @ x.T) for x in rows])

    precision = whole(known.precision)
    told = left_out(precision)
    np.testing.assert_allclose(known.left_out, PART.variance / (2.0 * texels) * told, rtol=1e-6)
    # Prices are ten times apart
    assert left_out(10.0 * precision).sum() < 2.0 * texels <= told.sum()


def test_rounding_does_not_pass_for_an_error(light: CapturedLight) -> None:
    # Two kernels that are nearly one: systems of far too low a price cannot be solved
    alike = np.array([[1.0, 1.0 - 1e-9], [1.0 - 1e-9, 1.0]])
    part = replace(PART, precision=Tridiagonal(np.tile(alike, (3, 1, 1)), np.tile(-0.2 * alike, (2, 1, 1))))
    captured = equations(light, geodesic_sphere(12).vertices[:1])
    # So many texels that no price explains their error
    known = Known(part, captured, 1e16)
    assert known.left_out.min() > 0.0
    assert known.errors(captured).min() > 0.0


@pytest.mark.parametrize("numbers", [[0, 1, 2, 3], [0, 6]])
def test_views_left_out_are_compared_with_new_ones(light: CapturedLight, numbers: list[int]) -> None:
    view_dirs = geodesic_sphere(12).vertices[numbers]
    found = compare_with_new(view_dirs, SIZE, light, [PART, PART])
    candidates = candidate_dirs(len(numbers))
    candidates = candidates[np.max(candidates @ view_dirs.T, axis=1) < np.cos(NEAREST)]
    every, captured = equations(light, candidates), equations(light, view_dirs)
    precision = whole(Known(PART, captured, TEXELS).precision)
    rows = rows_of(captured)
    told = sum(each.T @ each for each in rows) + precision
    new = np.array([np.trace(x @ np.linalg.inv(told) @ x.T) for x in rows_of(every)])
    left_out = np.array([np.trace(x @ np.linalg.inv(told - x.T @ x) @ x.T) for x in rows])
    np.testing.assert_array_equal(found.untested, candidates[new > left_out.max()])
    np.testing.assert_array_equal(found.like_new, (left_out <= new.max()) | (left_out == left_out.min()))
    assert found.share == len(found.untested) / len(candidates)


def test_where_all_views_are_captured_none_is_untested(light: CapturedLight) -> None:
    found = compare_with_new(geodesic_sphere(162).vertices, SIZE, light, [PART])
    assert (found.like_new.sum(), len(found.untested), found.share) == (162, 0, 0.0)


def test_the_next_view_is_the_best_of_all(light: CapturedLight) -> None:
    view_dirs = geodesic_sphere(12).vertices[[0, 4]]
    chosen = next_views(view_dirs, SIZE, light, [PART, PART], 3)
    candidates = candidate_dirs(5)
    every, captured = equations(light, candidates), equations(light, view_dirs)
    told = whole(Known(PART, captured, TEXELS).precision)
    every, captured = rows_of(every), rows_of(captured)
    wanted = sum(each.T @ each for each in every)
    told += sum(each.T @ each for each in captured)
    for view_dir in chosen:
        left = [np.trace(np.linalg.solve(told + each.T @ each, wanted)) for each in every]
        free = np.max(candidates @ view_dirs.T, axis=1) < np.cos(NEAREST)
        best = int(np.argmin(np.where(free, left, np.inf)))
        np.testing.assert_array_equal(view_dir, candidates[best])
        told, view_dirs = told + every[best].T @ every[best], np.vstack([view_dirs, view_dir])


def test_no_view_is_chosen_where_there_is_no_room(
    light: CapturedLight, monkeypatch: pytest.MonkeyPatch
) -> None:
    twelve = geodesic_sphere(12).vertices
    monkeypatch.setattr(next_views_module, "candidate_dirs", lambda views: twelve)
    assert next_views(twelve, SIZE, light, [PART], 2).shape == (0, 3)
    np.testing.assert_array_equal(next_views(twelve[:11], SIZE, light, [PART], 2), twelve[11:])


def test_texels_stand_for_all_of_a_view(light: CapturedLight) -> None:
    # One kernel is nearly uniform light: each view sees as much
    powers = [np.sum(each**2) for each in equations(light, geodesic_sphere(12).vertices)]
    assert max(powers) < 10.0 * min(powers)
