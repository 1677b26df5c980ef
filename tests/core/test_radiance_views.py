"""A set of radiance sphere maps and what belongs together in it."""

import numpy as np
import pytest
from rsibr.rsibr_addon.core.errors import RangeError, ShapeError
from rsibr.rsibr_addon.core.geometry.directions import camera_frame
from rsibr.rsibr_addon.core.geometry.geodesic import geodesic_sphere
from rsibr.rsibr_addon.core.kinds.radiance_views.views import RadianceViews
from rsibr.tests.synthetic_views import random_views


def test_views_know_their_sphere() -> None:
    views = random_views(42, 5)
    assert views.size == 5
    assert views.sphere is geodesic_sphere(42)
    np.testing.assert_array_equal(views.frames, camera_frame(geodesic_sphere(42).vertices))
    np.testing.assert_array_equal(views.frames[:, :, 2], geodesic_sphere(42).vertices)


def test_the_whole_is_the_sum_of_its_parts() -> None:
    views = random_views(12, 4)
    np.testing.assert_array_equal(views.combined, views.diffuse + views.glossy)


def test_the_first_views_are_those_of_the_coarser_sphere() -> None:
    views = random_views(162, 3)
    for count in (12, 42, 162):
        coarser = views.coarser(count)
        np.testing.assert_array_equal(coarser.glossy, views.glossy[:count])
        np.testing.assert_array_equal(coarser.diffuse, views.diffuse[:count])
        np.testing.assert_array_equal(coarser.sphere.vertices, views.sphere.vertices[:count])
    with pytest.raises(RangeError, match="no geodesic sphere of 20 views"):
        views.coarser(20)
    with pytest.raises(RangeError, match="no geodesic sphere of 40 views"):
        RadianceViews(views.diffuse[:40], views.glossy[:40])


def test_more_views_than_there_are_cannot_be_had() -> None:
    with pytest.raises(RangeError, match="only 12 views, not 42: use fewer or capture more"):
        random_views(12, 3).coarser(42)


@pytest.mark.parametrize(
    ("diffuse", "glossy"),
    [((12, 4, 4, 3), (12, 5, 5, 3)), ((12, 4, 6, 3), (12, 4, 6, 3)), ((12, 4, 4, 4), (12, 4, 4, 4))],
    ids=["different", "not square", "not RGB"],
)
def test_maps_that_do_not_fit_are_refused(diffuse: tuple[int, ...], glossy: tuple[int, ...]) -> None:
    with pytest.raises(ShapeError, match="equal, square size"):
        RadianceViews(np.zeros(diffuse), np.zeros(glossy))
