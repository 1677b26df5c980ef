"""Whether UV maps will do for a bake, and the unwrapping that always does."""

import tracemalloc

import numpy as np
import pytest
from rsibr.rsibr_addon.core.conventions import Array
from rsibr.rsibr_addon.core.materials.unwrapping import covering, fault_of, fitting_size, unwrapped

SQUARE = np.array([[[0, 0], [1, 0], [1, 1]], [[0, 0], [1, 1], [0, 1]]], float)


def triangles(corners: Array, uv: Array) -> Array:
    """Faces as fans, shape (T, 3, 2)."""
    begins = np.cumsum(corners) - corners
    fans = [
        (begin, begin + middle, begin + middle + 1)
        for begin, count in zip(begins, corners, strict=True)
        for middle in range(1, count - 1)
    ]
    return uv[np.array(fans)]


def test_a_centre_is_covered_as_often_as_a_search_says() -> None:
    rng = np.random.default_rng(1)
    uv, size = rng.uniform(-0.2, 1.2, (40, 3, 2)), 16
    centre = (np.stack(np.meshgrid(np.arange(size), np.arange(size)), axis=-1) + 0.5) / size
    found = np.zeros((size, size), int)
    for a, b, c in uv:
        shares = np.linalg.solve(np.stack([b - a, c - a], axis=-1), (centre - a)[..., None])[..., 0]
        found += np.all(shares > 0, axis=-1) & (shares.sum(axis=-1) < 1)
    assert np.array_equal(covering(uv, size), found)


def test_counting_takes_no_memory_for_every_triangle() -> None:
    many = np.tile(SQUARE, (24, 1, 1))
    tracemalloc.start()
    counts = covering(many, 512)
    _, most = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert np.array_equal(counts, 24 * (1 - np.eye(512, dtype=int)))
    # All boxes have 48 * 2^18 texels
    assert most < 2**28


@pytest.mark.parametrize("mirrored", [False, True])
def test_a_square_in_two_halves_covers_all_but_the_seam_once(mirrored: bool) -> None:
    counts = covering(SQUARE[..., ::-1] if mirrored else SQUARE, 8)
    assert np.array_equal(counts, 1 - np.eye(8, dtype=int))


@pytest.mark.parametrize(
    ("uv", "fault"),
    [
        (SQUARE, ""),
        (0.5 * SQUARE + 0.25, ""),
        (SQUARE + [1.0, 0.0], "reaches beyond its first tile"),
        (np.concatenate([SQUARE, 0.2 * SQUARE]), "overlaps"),
        (np.concatenate([SQUARE, SQUARE[..., ::-1]]), "overlaps"),
        (np.concatenate([SQUARE, np.full((1, 3, 2), 0.5)]), "has faces without area"),
        (np.zeros((2, 3, 2)), "has faces without area"),
    ],
)
def test_what_a_uv_map_does_wrong_is_told(uv: Array, fault: str) -> None:
    assert fault_of(uv, np.ones(len(uv))) == fault


def test_thousands_of_faces_that_each_fill_the_picture_are_told_at_once() -> None:
    many = np.tile(SQUARE, (10000, 1, 1))
    assert fault_of(many, np.ones(len(many))) == "overlaps"


def test_a_face_without_extent_needs_no_place() -> None:
    flat = np.concatenate([SQUARE, np.full((1, 3, 2), 0.5)])
    assert fault_of(flat, np.array([1.0, 1.0, 0.0])) == ""


@pytest.mark.parametrize("faces", [1, 2, 7, 500])
def test_faces_lie_apart_with_a_texel_around_each(faces: int) -> None:
    rng = np.random.default_rng(faces)
    corners = rng.integers(3, 8, faces)
    size = fitting_size(faces, 64)
    uv = unwrapped(corners, rng.uniform(0.01, 4.0, faces) ** 3, size)
    assert uv.shape == (corners.sum(), 2)
    assert fault_of(triangles(corners, uv), np.ones(corners.sum() - 2 * faces)) == ""
    # The boxes around faces, wider by a texel on each side, overlap nowhere
    ends = np.cumsum(corners)
    pieces = [uv[end - count : end] * size for end, count in zip(ends, corners, strict=True)]
    boxes = np.array([(piece.min(axis=0) - 0.99, piece.max(axis=0) + 0.99) for piece in pieces])
    assert boxes.min() >= 0
    assert boxes.max() <= size
    for number, (low, high) in enumerate(boxes):
        others = np.delete(boxes, number, axis=0)
        assert not np.any(np.all((others[:, 0] < high) & (low < others[:, 1]), axis=1))


def test_large_faces_have_large_cells() -> None:
    corners, areas = np.full(5, 4), np.array([1.0, 16.0, 1.0, 1.0, 1.0])
    uv = unwrapped(corners, areas, 64).reshape(5, 4, 2)
    widths = 64 * np.ptp(uv[..., 0], axis=1) + 2
    assert list(widths) == [8.0, 32.0, 8.0, 8.0, 8.0]


def test_a_picture_has_room_for_all_faces() -> None:
    assert fitting_size(10, 1000) == 512
    assert fitting_size(4096, 16) == 256
    assert fitting_size(4097, 16) == 512
