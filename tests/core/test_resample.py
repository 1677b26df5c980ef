"""Bilinear interpolation against a search by hand, seams and poles included."""

from math import floor

import numpy as np
import pytest
from rsibr.rsibr_addon.core.conventions import texel_centres
from rsibr.rsibr_addon.core.maps import equirect, sphere_map
from rsibr.rsibr_addon.core.maps.representation import representation
from rsibr.rsibr_addon.core.resample import Wrap, bilinear, lookup, lookup_variance

RNG = np.random.default_rng(8)
IMAGE = RNG.random((6, 12, 3)).astype(np.float32)
EDGES = [(0.0, 0.0), (1.0, 1.0), (0.0, 0.4), (1.0, 0.4), (0.3, 0.0), (0.3, 1.0), (0.5, 0.999), (0.001, 0.001)]
UV = np.concatenate([RNG.random((300, 2)), EDGES, RNG.uniform(-0.05, 1.05, (100, 2))])


def around_the_globe(column: int, row: int) -> tuple[int, int]:
    if row < 0:
        return (column + 6) % 12, -1 - row
    if row > 5:
        return (column + 6) % 12, 11 - row
    return column % 12, row


def within_the_edges(column: int, row: int) -> tuple[int, int]:
    return min(max(column, 0), 11), min(max(row, 0), 5)


@pytest.mark.parametrize(
    ("wrap", "by_hand"), [(equirect.wrap, around_the_globe), (sphere_map.wrap, within_the_edges)]
)
def test_each_lookup_is_a_tent_over_its_texels(wrap: Wrap, by_hand) -> None:
    expected = []
    for u, v in UV.tolist():
        x, y = 12 * u - 0.5, 6 * v - 0.5
        found = np.zeros(3)
        for row in range(floor(y), floor(y) + 2):
            for column in range(floor(x), floor(x) + 2):
                at, up = by_hand(column, row)
                found += (1 - abs(x - column)) * (1 - abs(y - row)) * IMAGE[up, at].astype(float)
        expected.append(found)
    np.testing.assert_allclose(bilinear(IMAGE, UV, wrap), expected, atol=1e-14)


@pytest.mark.parametrize("wrap", [equirect.wrap, sphere_map.wrap])
def test_centres_show_their_texels(wrap: Wrap) -> None:
    found = bilinear(IMAGE, texel_centres(12, 6), wrap)
    assert found.dtype == np.float64
    np.testing.assert_allclose(found, IMAGE, atol=1e-14)


def test_planes_are_kept() -> None:
    plane = texel_centres(12, 6) @ np.array([[3.0, -1.0], [2.0, 5.0]]) + (1.0, 0.5)
    inside = 0.5 / 12 + RNG.random((200, 2)) * (1.0 - 1.0 / 6.0) * (1.0, 0.9) + (0.0, 0.05)
    expected = inside @ np.array([[3.0, -1.0], [2.0, 5.0]]) + (1.0, 0.5)
    np.testing.assert_allclose(bilinear(plane, inside, sphere_map.wrap), expected, atol=1e-13)


def test_the_globe_has_no_seam() -> None:
    v = np.linspace(0.0, 1.0, 50)
    left, right = (bilinear(IMAGE, np.stack([np.full(50, u), v], axis=-1), equirect.wrap) for u in (0.0, 1.0))
    np.testing.assert_allclose(left, right, atol=1e-14)
    u = np.linspace(0.0, 1.0, 50)
    for pole in (0.0, 1.0):
        here = bilinear(IMAGE, np.stack([u, np.full(50, pole)], axis=-1), equirect.wrap)
        far_side = bilinear(IMAGE, np.stack([(u + 0.5) % 1.0, np.full(50, pole)], axis=-1), equirect.wrap)
        np.testing.assert_allclose(here, far_side, atol=1e-14)


def test_layers_are_maps_of_their_own() -> None:
    images = RNG.random((4, 6, 12, 3))
    layer = RNG.integers(0, 4, len(UV))
    found = bilinear(images, UV, sphere_map.wrap, layer=layer)
    expected = [bilinear(images[i], uv, sphere_map.wrap) for i, uv in zip(layer, UV, strict=True)]
    np.testing.assert_array_equal(found, expected)
    everywhere = bilinear(images, UV[:, None], sphere_map.wrap, layer=np.arange(4))
    np.testing.assert_array_equal(everywhere[:, 2], bilinear(images[2], UV, sphere_map.wrap))


def test_lookups_add_a_sixth_of_a_texel_s_square_to_a_variance() -> None:
    width = 64
    layout = representation("equirect")
    columns = (np.arange(width) + 0.5) / width - 0.5
    # Squares of longitudes, from which lookups near the middle of the equator differ by what they add
    squares = np.tile((2.0 * np.pi * columns) ** 2, (width // 2, 1))[None, ..., None]
    # Everywhere between the centres of twelve texels
    u = (26.5 + 12.0 * (np.arange(1200) + 0.5) / 1200) / width
    uv = np.stack([u, np.full_like(u, 0.5)], axis=-1)
    found = lookup(squares, equirect.direction_from_uv(uv), layout)[:, 0]
    added = np.mean(found - (2.0 * np.pi * (u - 0.5)) ** 2)
    # The midpoint rule of 100 points errs by 1 / 20000 in the mean of p (1 - p)
    assert added == pytest.approx(lookup_variance((2.0 * np.pi / width) ** 2), rel=1e-4)
