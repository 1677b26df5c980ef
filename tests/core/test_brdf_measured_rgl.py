"""Measurements of the RGL kind, made here of known microfacets."""

import numpy as np
import pytest
from rsibr.rsibr_addon.core.brdf.albedo import directional_albedo
from rsibr.rsibr_addon.core.brdf.ggx import ggx_ndf, smith_visibility
from rsibr.rsibr_addon.core.brdf.measured_rgl import MeasuredRgl
from rsibr.rsibr_addon.core.errors import ShapeError

ALPHA = 0.1
THETA_V = np.radians([0.0, 15.0, 30.0, 40.0, 50.0, 60.0, 70.0])
STEPS = 129
"""Of the density of visible normals and of the tables along u."""


def masking(mu: np.ndarray) -> np.ndarray:
    return 4.0 * mu * smith_visibility(np.ones_like(mu), mu, ALPHA)


def visible_normals() -> np.ndarray:
    """Density of visible GGX normals in the unit square, shape (T, Y, X), not normalised."""
    u, y = np.linspace(0.0, 1.0, STEPS), np.linspace(0.0, 1.0, STEPS)[:, None]
    theta_h, phi = u**2 * np.pi / 2.0, (2.0 * y - 1.0) * np.pi
    slices = []
    for theta_v in THETA_V:
        h_dot_v = np.sin(theta_h) * np.cos(phi) * np.sin(theta_v) + np.cos(theta_h) * np.cos(theta_v)
        # d omega = sin(theta) d theta d phi, and d theta = pi u du
        slices.append(ggx_ndf(np.sin(theta_h) ** 2, ALPHA) * np.maximum(h_dot_v, 0.0) * np.sin(theta_h) * u)
    return np.stack(slices)


def measurement(weight: np.ndarray, spec: str = "rgl:path=made") -> MeasuredRgl:
    """The microfacets above, whose reflectance is `weight`, shape (H, W, 3), over the warped square."""
    u = np.linspace(0.0, 1.0, STEPS)
    cosine = np.cos(u**2 * np.pi / 2.0)
    # Projected area of all facets as seen: mu / G1, [Heitz2014] Eq. 13
    area = np.ones_like(cosine)
    area[:-1] = cosine[:-1] / masking(cosine[:-1])
    area[-1] = area[-2]
    weights = np.repeat(np.moveaxis(weight, 2, 0)[None], THETA_V.size, axis=0)
    return MeasuredRgl(
        theta_v=THETA_V,
        sigma=area,
        ndf=ggx_ndf(np.sin(u**2 * np.pi / 2.0) ** 2, ALPHA),
        vndf=visible_normals(),
        weight=weights,
        spec=spec,
    )


SQUARE_Y, SQUARE_X = np.meshgrid(*[np.linspace(0.0, 1.0, 33)] * 2, indexing="ij")


def above(count: int, seed: int, lowest: float) -> np.ndarray:
    rng = np.random.default_rng(seed)
    z, phi = rng.uniform(lowest, 1.0, count), 2.0 * np.pi * rng.random(count)
    radius = np.sqrt(1.0 - z**2)
    return np.stack([radius * np.cos(phi), radius * np.sin(phi), z], axis=-1)


def test_weight_one_is_a_mirror_made_of_visible_normals() -> None:
    brdf = measurement(np.ones((33, 33, 3)))
    light, view = above(2000, 0, 0.05), above(2000, 1, 0.35)
    half = light + view
    half /= np.linalg.norm(half, axis=1, keepdims=True)
    mu = view[:, 2]
    # brdf n.l = D / (4 sigma): what is left of a mirror's reflectance without shadowing
    expected = ggx_ndf(1.0 - half[:, 2] ** 2, ALPHA) * masking(mu) / (4.0 * mu * light[:, 2])
    # Both tables are linear between 129 angles: (pi / 2 / 128)^2 times curvatures of some 1 / alpha^2
    np.testing.assert_allclose(brdf(light, view), expected[:, None] * np.ones(3), rtol=5e-3)


@pytest.mark.parametrize("theta_v", [0.0, 30.0, 50.0])
def test_directions_fill_the_warped_square_evenly(theta_v: float) -> None:
    # Weights x, y and their squares average 1/2 and 1/3 over an even square; light directions come with the
    # density of the warp, so that their albedo is that average. Missing are half vectors whose light is
    # below the horizon; how many they are the plain mirror tells
    ones = np.ones_like(SQUARE_X)
    linear = measurement(np.stack([SQUARE_X, SQUARE_Y, ones], axis=-1))
    square = measurement(np.stack([SQUARE_X**2, SQUARE_Y**2, ones], axis=-1))
    mu = np.cos(np.radians(theta_v))
    (x, y, one), (xx, yy, _) = directional_albedo(linear, mu), directional_albedo(square, mu)
    missed = 1.0 - one
    assert -2e-3 < missed < 0.02
    tolerance = abs(missed) + 3e-3  # and that of the tables, as above
    np.testing.assert_allclose([x, y], 0.5, atol=tolerance)
    np.testing.assert_allclose([xx, yy], 1.0 / 3.0, atol=tolerance)


def test_the_warp_follows_the_views_between_the_measured_ones() -> None:
    brdf = measurement(np.stack([SQUARE_X, SQUARE_Y, np.ones_like(SQUARE_X)], axis=-1))
    light = np.array([-0.5, 0.1, np.sqrt(1.0 - 0.26)])
    theta = np.radians(np.linspace(0.5, 69.5, 400))
    views = np.stack([np.sin(theta), np.zeros_like(theta), np.cos(theta)], axis=-1)
    x, y, one = brdf(light, views).T
    # Shares of the visible normals move on without jumps; 400 steps of at most 1 in all
    assert np.abs(np.diff(x / one)).max() < 0.02
    assert np.abs(np.diff(y / one)).max() < 0.02
    assert np.ptp(x / one) > 0.1


def test_azimuth_counts_from_the_view() -> None:
    brdf = measurement(np.stack([SQUARE_X, SQUARE_Y, np.ones_like(SQUARE_X)], axis=-1))
    view = np.array([np.sin(0.6), 0.0, np.cos(0.6)])
    left = np.array([-0.3, 0.4, np.sqrt(1.0 - 0.25)])
    right = left * (1.0, -1.0, 1.0)
    (_, y_left, one), (_, y_right, _) = brdf(left, view), brdf(right, view)
    # The two sides of the plane of incidence are mirror images about the middle of the square
    assert y_left / one + y_right / one == pytest.approx(1.0, abs=1e-9)
    assert y_left / one > 0.5
    turn = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
    np.testing.assert_allclose(brdf(turn @ left, turn @ view), brdf(left, view), rtol=1e-9)


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        ({"theta_v": THETA_V[:3]}, "3 views, but grids"),
        ({"theta_v": THETA_V[::-1]}, "do not increase"),
        ({"sigma": np.ones(4)}, "microfacets of shapes"),
        ({"weight": np.ones((7, 2, 9, 9))}, "7 views, but grids"),
        ({"weight": np.ones((7, 3, 1, 9))}, "less than two steps"),
        ({"vndf": np.ones((7, 9))}, "7 views, but grids"),
    ],
)
def test_arrays_that_do_not_fit_together_are_refused(change: dict, sentence: str) -> None:
    good = measurement(np.ones((3, 3, 3)))
    fields = {name: getattr(good, name) for name in ("theta_v", "sigma", "ndf", "vndf", "weight")}
    with pytest.raises(ShapeError, match=sentence):
        MeasuredRgl(**{**fields, **change}, spec="")
