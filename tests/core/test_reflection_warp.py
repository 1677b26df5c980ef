"""The warp keeps the central direction, can be walked back, and is trusted where it is not pinched."""

import numpy as np
import pytest
from rsibr.rsibr_addon.core.conventions import texel_centres
from rsibr.rsibr_addon.core.geometry.directions import camera_frame, dot, normalize, reflect
from rsibr.rsibr_addon.core.geometry.reflection_warp import (
    LEAST_CONFIDENCE,
    TRUSTED_COSINE,
    Fading,
    Warp,
    confidence,
    singularity_distance,
    source_trust,
    source_uv,
)
from rsibr.rsibr_addon.core.maps import sphere_map

RNG = np.random.default_rng(11)
EPS = np.finfo(np.float64).eps
COUNT = 5000
DESTINATIONS = normalize(RNG.normal(size=(COUNT, 3)))
SOURCES = normalize(RNG.normal(size=(COUNT, 3)))
UV = texel_centres(100, 50).reshape(-1, 2)
UV = 0.5 + 0.5 * normalize(np.c_[2.0 * UV - 1.0, 0.7 * np.ones(COUNT)])[:, :2]  # points of the disk


def normals(view_dir: np.ndarray, uv: np.ndarray) -> np.ndarray:
    """World normals at points of the maps of given views."""
    return np.einsum("...ij,...j->...i", camera_frame(view_dir), sphere_map.normal_from_uv(uv))


def central(warp: Warp, view_dir: np.ndarray, uv: np.ndarray) -> np.ndarray:
    """The paper's T . g: the central direction of points of the maps of given views, in world coordinates."""
    g = {Warp.NORMAL: sphere_map.normal_from_uv, Warp.MIRROR: sphere_map.direction_from_uv}[warp]
    return np.einsum("...ij,...j->...i", camera_frame(view_dir), g(uv))


def by_cosine(warp: Warp, normal: np.ndarray, view_dir: np.ndarray, source: np.ndarray) -> np.ndarray:
    """Confidence by the cosine."""
    return confidence(source_trust(Fading.COSINE, warp, normal, view_dir, source))


def warped(warp: Warp) -> tuple[np.ndarray, np.ndarray]:
    """Every point of the destination maps in the source maps, and the cosine at which it is seen there."""
    normal = normals(DESTINATIONS, UV)
    p_s = source_uv(warp, normal, DESTINATIONS, camera_frame(SOURCES))
    if warp is Warp.NORMAL:
        return p_s, dot(normal, SOURCES)
    return p_s, dot(normalize(reflect(DESTINATIONS, normal) + SOURCES), SOURCES)


@pytest.mark.parametrize("warp", Warp)
def test_a_warp_keeps_the_central_direction(warp: Warp) -> None:
    p_s, cosine = warped(warp)
    seen = cosine > 1e-3
    error = np.abs(central(warp, SOURCES, p_s) - central(warp, DESTINATIONS, UV)).max(axis=-1)
    assert np.all(error[seen] < 16.0 * EPS / cosine[seen])
    # The mirror direction is always somewhere on the map, half of all normals are not.
    assert np.mean(seen) > (0.99 if warp is Warp.MIRROR else 0.4)


@pytest.mark.parametrize("warp", Warp)
def test_swapping_the_roles_leads_back(warp: Warp) -> None:
    p_s, cosine = warped(warp)
    back = source_uv(warp, normals(SOURCES, p_s), SOURCES, camera_frame(DESTINATIONS))
    trusted = by_cosine(warp, normals(DESTINATIONS, UV), DESTINATIONS, SOURCES) > 0.1
    assert np.mean(trusted) > 0.4
    # An error of the direction, eps / cosine there, is divided by the destination's cosine as well.
    own_cosine = sphere_map.normal_from_uv(UV)[:, 2]
    assert own_cosine.min() > 0.1
    assert np.all(np.abs(back - UV).max(axis=-1)[trusted] < (32.0 * EPS / (cosine * own_cosine))[trusted])


@pytest.mark.parametrize("warp", Warp)
def test_a_map_warps_to_itself_by_nothing(warp: Warp) -> None:
    normal = normals(DESTINATIONS, UV)
    np.testing.assert_allclose(
        source_uv(warp, normal, DESTINATIONS, camera_frame(DESTINATIONS)), UV, atol=1e-14
    )
    expected = np.minimum(dot(normal, DESTINATIONS) / TRUSTED_COSINE, 1.0)
    np.testing.assert_allclose(by_cosine(warp, normal, DESTINATIONS, DESTINATIONS), expected, atol=1e-14)


def test_the_normal_warp_does_not_know_the_view() -> None:
    normal = normals(DESTINATIONS, UV)
    frames = camera_frame(SOURCES)
    expected = source_uv(Warp.NORMAL, normal, DESTINATIONS, frames)
    np.testing.assert_array_equal(source_uv(Warp.NORMAL, normal, SOURCES, frames), expected)


@pytest.mark.parametrize("warp", Warp)
def test_confidence_is_the_cosine_in_the_source_map(warp: Warp) -> None:
    p_s, cosine = warped(warp)
    trust = by_cosine(warp, normals(DESTINATIONS, UV), DESTINATIONS, SOURCES)
    np.testing.assert_allclose(trust, np.clip(cosine / TRUSTED_COSINE, LEAST_CONFIDENCE, 1.0), atol=1e-12)
    # On the map itself: z where p_s lands, which is 0, hence no trust, all along the rim.
    z = sphere_map.normal_from_uv(p_s)[:, 2]
    np.testing.assert_allclose(trust, np.clip(z / TRUSTED_COSINE, LEAST_CONFIDENCE, 1.0), atol=1e-6)
    # Of all directions, a fifth lies within the trusted cosine.
    assert np.count_nonzero(trust == 1.0) > 0.9 * COUNT / 5


def test_no_trust_at_the_singularities() -> None:
    # A mirror that shows what lies straight behind the source; a normal that the source sees edge-on.
    normal = normalize(DESTINATIONS - SOURCES)
    trust = by_cosine(Warp.MIRROR, normal, DESTINATIONS, SOURCES)
    np.testing.assert_allclose(reflect(DESTINATIONS, normal), -SOURCES, atol=1e-12)
    np.testing.assert_array_equal(trust, LEAST_CONFIDENCE)
    edge_on = normalize(np.cross(DESTINATIONS, SOURCES))
    for unseen in (edge_on, -SOURCES):
        trust = by_cosine(Warp.NORMAL, unseen, DESTINATIONS, SOURCES)
        np.testing.assert_array_equal(trust, LEAST_CONFIDENCE)


def test_the_papers_distance_is_that_from_where_the_negated_source_view_is_shown() -> None:
    # Section 3.3 step by step: the problem reflection direction, warped into the destination map
    frames = camera_frame(DESTINATIONS)
    p_d = sphere_map.uv_from_direction(np.einsum("nji,nj->ni", frames, -SOURCES))
    ours = singularity_distance(normals(DESTINATIONS, UV), DESTINATIONS, SOURCES)
    # Places are known to eps over n.v there, a thousandth at the least here
    np.testing.assert_allclose(ours, 2.0 * np.linalg.norm(UV - p_d, axis=-1), atol=1e-12)
    singular = normalize(DESTINATIONS - SOURCES)
    trust = source_trust(Fading.DISTANCE, Warp.MIRROR, singular, DESTINATIONS, SOURCES)
    np.testing.assert_allclose(trust, 0.0, atol=1e-12)


def test_the_normal_warp_has_no_singularity_to_be_distant_from() -> None:
    points = normals(DESTINATIONS, UV), DESTINATIONS, SOURCES
    trusts = [source_trust(fading, Warp.NORMAL, *points) for fading in Fading]
    np.testing.assert_array_equal(*trusts)


def test_what_the_source_cannot_see_lands_on_its_rim() -> None:
    hidden = normals(SOURCES, UV) * -1.0
    p_s = source_uv(Warp.NORMAL, hidden, DESTINATIONS, camera_frame(SOURCES))
    np.testing.assert_allclose(np.linalg.norm(2.0 * p_s - 1.0, axis=-1), 1.0, rtol=1e-14)
