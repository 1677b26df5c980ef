"""Errors that radiance views state of themselves, against views whose best warp is known."""

import numpy as np
import pytest
from rsibr.rsibr_addon.core.conventions import texel_centres
from rsibr.rsibr_addon.core.kinds.radiance_views.left_out import LeftOut
from rsibr.rsibr_addon.core.kinds.radiance_views.views import RadianceViews
from rsibr.rsibr_addon.core.kinds.radiance_views.warping import WarpChoice, Warping, chosen_warping
from rsibr.rsibr_addon.core.maps import sphere_map
from rsibr.tests.synthetic_views import lambert_maps, mirror_maps, random_views, smooth_views

SIZE = 48
INTERPOLATED = 0.005
"""What bilinear lookups in maps of this size may cost; most at the rim, where directions crowd."""


def errors_of(views: RadianceViews) -> dict[Warping, float]:
    left_out = LeftOut(views.sphere, views.size, views.albedo)
    for view, (diffuse, glossy) in enumerate(zip(views.diffuse, views.glossy, strict=True)):
        left_out.add(view, diffuse, glossy)
    return left_out.errors()


@pytest.mark.parametrize(("count", "size"), [(12, SIZE), (42, SIZE // 2)])
def test_a_coat_over_paint_is_known_from_its_neighbours_by_parts(count: int, size: int) -> None:
    errors = errors_of(smooth_views(count, size))
    assert errors[Warping.SPLIT] < INTERPOLATED
    assert errors[Warping.ALBEDO] == pytest.approx(
        errors[Warping.SPLIT]
    )  # albedo is the same from every side
    # A single warp carries the paint to where its reflection is, not its normal
    assert errors[Warping.SINGLE] > 3.0 * INTERPOLATED


def test_reflections_that_grow_towards_the_rim_are_known_with_their_albedo() -> None:
    cosine = sphere_map.normal_from_uv(texel_centres(SIZE, SIZE))[..., 2:]
    columns = (np.arange(64)[:, None] + 0.5) / 64
    albedo = np.stack([np.ones((64, 3)), np.broadcast_to(1.5 - columns, (64, 3))])
    glossy = mirror_maps(12, SIZE) * (1.5 - cosine)
    errors = errors_of(RadianceViews(np.zeros_like(glossy), glossy, albedo))
    assert errors[Warping.ALBEDO] < INTERPOLATED
    assert min(errors[Warping.SINGLE], errors[Warping.SPLIT]) > 3.0 * INTERPOLATED
    assert chosen_warping(WarpChoice.AUTO, errors) is Warping.ALBEDO


def test_a_view_that_is_wrong_shows() -> None:
    views = RadianceViews(lambert_maps(12, 16), np.zeros((12, 16, 16, 3), np.float32))
    right = errors_of(views)[Warping.SPLIT]
    views.diffuse[3] *= 2.0
    # An error as large as the view itself; and a fifth of it where each of its five neighbours is predicted
    power = np.sum(views.diffuse[3] ** 2) / np.sum(views.diffuse**2)
    expected = np.sqrt(power * (0.5**2 + 5 * 0.1**2))
    assert errors_of(views)[Warping.SPLIT] == pytest.approx(expected, rel=0.1)
    assert right < 4.0 * INTERPOLATED  # in maps of 16 texels


def test_what_has_no_pattern_cannot_be_predicted() -> None:
    views = random_views(12, 16)
    shuffled = RadianceViews(views.diffuse, np.zeros_like(views.glossy))
    # Values in [0, 1] have a standard deviation of .29 about .5, and a mean square of 1/3
    assert min(errors_of(shuffled).values()) > 0.5


def test_black_views_have_no_error() -> None:
    black = np.zeros((12, 8, 8, 3), np.float32)
    assert set(errors_of(RadianceViews(black, black)).values()) == {0.0}


def test_the_best_warp_is_taken_unless_one_is_asked_for() -> None:
    errors = {Warping.SINGLE: 0.2, Warping.SPLIT: 0.2 * (1.0 - 1e-12), Warping.ALBEDO: 0.3}
    assert chosen_warping(WarpChoice.AUTO, errors) is Warping.SINGLE  # rounding alone tells it from the next
    assert chosen_warping(WarpChoice.ALBEDO, errors) is Warping.ALBEDO
    assert chosen_warping(WarpChoice.AUTO, {}) is Warping.ALBEDO
    assert {Warping(choice) for choice in WarpChoice if choice is not WarpChoice.AUTO} == set(Warping)
