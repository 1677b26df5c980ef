"""The errors that a pyramid states of its maps are those that sums over all texels show."""

import numpy as np
import pytest
from rsibr.rsibr_addon.core.conventions import Array
from rsibr.rsibr_addon.core.errors import RangeError
from rsibr.rsibr_addon.core.filtering.harmonics.analysis import analyse_environment
from rsibr.rsibr_addon.core.filtering.prefilter import analysis_degree, prefilter, prefilter_exact
from rsibr.rsibr_addon.core.filtering.radial_lobes import cosine_lobe, von_mises_fisher_lobe
from rsibr.rsibr_addon.core.filtering.zonal import ZonalLobe, expand
from rsibr.rsibr_addon.core.kinds.kernel_pyramid.bake import (
    BakedPyramid,
    bake_pyramid,
    leaning_lobe,
    ring_lobe,
)
from rsibr.rsibr_addon.core.kinds.kernel_pyramid.look import PrincipledLook
from rsibr.rsibr_addon.core.kinds.kernel_pyramid.pyramid import OCTAHEDRAL
from rsibr.rsibr_addon.core.lobes.rings import WIDTHS
from rsibr.rsibr_addon.core.progress import drain
from rsibr.rsibr_addon.core.resample import lookup

HEIGHT = 128


@pytest.fixture(scope="module")
def radiance() -> Array:
    """Noise, and a sun of one texel."""
    light = np.random.default_rng(8).random((HEIGHT, 2 * HEIGHT, 3)) ** 2
    light[90, 40] = (900.0, 800.0, 600.0)
    return light


@pytest.fixture(scope="module")
def baked(radiance: Array) -> BakedPyramid:
    return drain(bake_pyramid(radiance, 1024))


def lobes(baked: BakedPyramid) -> list[tuple[ZonalLobe, Array, int]]:
    """Each filtered map, with its lobe and a factor that the map has over it."""
    kernels = [von_mises_fisher_lobe(kappa) for kappa in baked.pyramid.bank.concentrations]
    maps = [*(sheets[0] for sheets in baked.pyramid.maps), *baked.pyramid.diffuse, *baked.pyramid.rings]
    rings = [ring_lobe(width) for width in WIDTHS]
    factors = [1.0] * len(kernels) + [1.0 / np.pi, 1.0] + [1.0] * len(rings)
    return list(zip([*kernels, cosine_lobe(), leaning_lobe(), *rings], maps, factors, strict=True))


def test_no_texel_is_further_from_the_sum_than_stated(radiance: Array, baked: BakedPyramid) -> None:
    rng = np.random.default_rng(2)
    for (lobe, sheet, factor), errors in zip(
        lobes(baked), (*baked.kernels, *baked.diffuse, *baked.rings), strict=True
    ):
        row, column = rng.integers(0, len(sheet), (2, 10))
        direction = OCTAHEDRAL.texel_directions(len(sheet))[0, row, column]
        exact = factor * prefilter_exact(radiance, [lobe], direction)[0]
        # Maps are in single precision
        allowed = errors.bound + 2.0**-24 * exact
        assert np.all(np.abs(sheet[row, column] - exact) <= allowed)


def test_lookups_cost_what_is_stated(radiance: Array, baked: BakedPyramid) -> None:
    direction = np.random.default_rng(3).normal(size=(20000, 3))
    direction /= np.linalg.norm(direction, axis=1, keepdims=True)
    series = [expand(lobe, 1e-5) for lobe, _, _ in lobes(baked)[: len(baked.kernels)]]
    harmonics = analyse_environment(radiance, analysis_degree(series))
    exact = prefilter(harmonics, series, direction).radiance
    for values, sheets, errors in zip(exact, baked.pyramid.maps, baked.kernels, strict=True):
        found = lookup(sheets, direction, OCTAHEDRAL)
        cost = np.linalg.norm(found - values) / np.linalg.norm(values)
        # It is the mean over all places of the sun, and this one is at a single place
        assert 0.7 * errors.interpolation < cost < 1.4 * errors.interpolation


def test_maps_are_no_wider_than_asked_for_nor_than_the_environment(radiance: Array) -> None:
    for size, widest in ((64, 64), (1024, 2 * HEIGHT)):
        pyramid = drain(bake_pyramid(radiance, size)).pyramid
        assert pyramid.mirror.shape == (1, widest, widest, 3)
        assert max(len(sheets[0]) for sheets in pyramid.maps) <= widest


def test_an_environment_that_resolves_nothing_is_told() -> None:
    with pytest.raises(RangeError, match="An environment of 2 rows resolves no diffuse light: use"):
        drain(bake_pyramid(np.ones((2, 4, 3)), 1024))


def test_a_look_is_told_by_what_differs_from_blenders_defaults() -> None:
    assert PrincipledLook().text == "principled"
    look = PrincipledLook(base_color=(0.1, 0.2, 0.3), metallic=1.0, own=False)
    assert look.text == "principled:base_color=0.1/0.2/0.3,metallic=1.0"
    assert look.surface.metallic == 1.0
    np.testing.assert_array_equal(look.surface.base_color, [0.1, 0.2, 0.3])
