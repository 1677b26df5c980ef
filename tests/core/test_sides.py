"""Both sides of a surface: what the eye sees of either, and no mirror image of the inside."""

import numpy as np
from rsibr.rsibr_addon.core.geometry.directions import dot, normalize, reflect
from rsibr.rsibr_addon.core.geometry.sides import seen_surface, tilted_normal

RNG = np.random.default_rng(71)
VIEW = normalize(RNG.normal(size=(2000, 3)))
NORMAL = normalize(RNG.normal(size=(2000, 3)))
OTHER = normalize(RNG.normal(size=(2000, 3)))
FACET = np.where(dot(OTHER, VIEW)[:, None] < 0.0, -OTHER, OTHER)
"""On the eye's side."""


def test_both_sides_are_seen_alike() -> None:
    front, back = seen_surface(NORMAL, VIEW, FACET), seen_surface(-NORMAL, VIEW, -FACET)
    assert np.all(front.outside)
    assert not np.any(back.outside)
    np.testing.assert_array_equal(front.normal, NORMAL)
    np.testing.assert_array_equal(back.normal, NORMAL)
    np.testing.assert_array_equal(back.mirror_normal, front.mirror_normal)


def test_without_facets_normals_face_the_eye_and_stay() -> None:
    found = seen_surface(NORMAL, VIEW)
    np.testing.assert_array_equal(found.outside, dot(NORMAL, VIEW) >= 0.0)
    np.testing.assert_array_equal(found.normal, np.where(found.outside[:, None], NORMAL, -NORMAL))
    np.testing.assert_array_equal(found.mirror_normal, found.normal)


def test_a_normal_is_tilted_no_farther_than_its_mirror_image_demands() -> None:
    found = tilted_normal(NORMAL, VIEW, FACET)
    up = dot(VIEW, FACET)
    least = np.minimum(0.9 * up, 0.01)
    rise = dot(reflect(VIEW, NORMAL), FACET)
    kept = rise >= least
    assert 0.1 < np.mean(kept) < 0.9
    np.testing.assert_array_equal(found[kept], NORMAL[kept])
    np.testing.assert_allclose(dot(reflect(VIEW, found), FACET)[~kept], least[~kept], atol=1e-12)
    np.testing.assert_allclose(np.linalg.norm(found, axis=1), 1.0)
    assert np.all(dot(found, VIEW)[~kept] > 0.0)
    # By brute force: the first of all tilts towards the facet whose mirror direction rises enough
    whole = np.arccos(dot(NORMAL, FACET))[~kept]
    along = normalize(NORMAL - dot(NORMAL, FACET)[:, None] * FACET)[~kept]
    shares = np.linspace(1.0, 0.0, 4001)
    for number in range(0, len(whole), 50):
        angle = shares[:, None] * whole[number]
        tilts = np.sin(angle) * along[number] + np.cos(angle) * FACET[~kept][number]
        view = VIEW[~kept][number]
        rises = dot(reflect(np.broadcast_to(view, tilts.shape), tilts), FACET[~kept][number])
        first = tilts[np.argmax(rises >= least[~kept][number])]
        assert np.linalg.norm(first - found[~kept][number]) < 1.01 * whole[number] / 4000


def test_an_eye_in_the_facet_s_plane_sees_unit_normals() -> None:
    facet, view = np.array([0.0, 0.0, 1.0]), np.array([1.0, 0.0, 0.0])
    leaning = normalize(
        [(-0.5, 0.0, 1.0), (0.5, 0.0, 1.0), (0.0, 0.7, 1.0), (0.0, 0.0, 1.0), (-1.0, 0.0, 0.0)]
    )
    found = tilted_normal(leaning, view, facet)
    np.testing.assert_allclose(np.linalg.norm(found, axis=1), 1.0)
    assert np.all(dot(reflect(np.broadcast_to(view, found.shape), found), facet) > -1e-12)
