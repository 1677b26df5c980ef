"""Pictures drawn on the GPU, in every mode, against core/kinds at every sample."""

from collections.abc import Callable

import gpu
import numpy as np
import pytest
from rsibr.rsibr_addon.core.antialiased.footprint import parallelogram
from rsibr.rsibr_addon.core.conventions import texel_centres
from rsibr.rsibr_addon.core.geometry.camera import Camera
from rsibr.rsibr_addon.core.geometry.directions import dot, normalize, reflect
from rsibr.rsibr_addon.core.geometry.reflection_warp import Fading
from rsibr.rsibr_addon.core.kinds.radiance_views import shading as shading
from rsibr.rsibr_addon.core.kinds.radiance_views.shading import Mode, ViewsLook
from rsibr.rsibr_addon.core.kinds.radiance_views.views import RadianceViews
from rsibr.rsibr_addon.core.kinds.radiance_views.warping import Warping
from rsibr.rsibr_addon.core.maps import sphere_map
from rsibr.rsibr_addon.device.kinds.radiance_views import GpuRadianceViews
from rsibr.rsibr_addon.device.preview import SAMPLES_PER_AXIS, PreviewRenderer
from rsibr.tests.synthetic_views import random_views, smooth_views, with_random_albedo

SIZE = 32
FINE = SIZE * SAMPLES_PER_AXIS
VIEW = (1.0, -0.7, 0.4)
CAMERAS = [Camera(VIEW), Camera(VIEW, 0.9)]
BY_CAMERA = pytest.mark.parametrize("camera", CAMERAS, ids=["orthographic", "perspective"])
MODE = pytest.mark.parametrize("mode", Mode)
WARPING = pytest.mark.parametrize("warping", Warping)

Mesh = tuple[np.ndarray, np.ndarray, np.ndarray]


def fine_sphere(segments: int = 512) -> Mesh:
    """A unit sphere with its positions as normals; facets lie at most 4e-5 inside it."""
    rings = segments // 2
    azimuth, polar = np.meshgrid(
        2.0 * np.pi * np.arange(segments) / segments, np.pi * np.arange(rings + 1) / rings
    )
    positions = np.stack(
        [np.sin(polar) * np.cos(azimuth), np.sin(polar) * np.sin(azimuth), np.cos(polar)], axis=-1
    )
    ring, segment = np.divmod(np.arange(rings * segments), segments)
    here, beside = ring * segments + segment, ring * segments + (segment + 1) % segments
    below, opposite = here + segments, beside + segments
    triangles = np.concatenate(
        [np.stack(corners, axis=-1) for corners in ((here, below, beside), (beside, below, opposite))]
    )
    return positions.reshape(-1, 3), positions.reshape(-1, 3), triangles


SPHERE = fine_sphere()


def samples(camera: Camera) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Normals and view directions at every sample of a picture of the unit sphere, and n.v or 0 beside it."""
    points = 2.0 * texel_centres(FINE, FINE) - 1.0
    if camera.field_of_view is None:
        normal = sphere_map.normal_from_uv(0.5 * points + 0.5) @ camera.frame.T
        return normal, np.broadcast_to(camera.frame[:, 2], normal.shape), normal @ camera.frame[:, 2]
    slope = np.tan(camera.field_of_view / 2.0)
    ray = normalize(np.concatenate([slope * points, -np.ones((FINE, FINE, 1))], axis=-1)) @ camera.frame.T
    along = ray @ camera.eye[:3]
    under_root = np.maximum(along**2 - camera.distance**2 + 1.0, 0.0)
    normal = normalize(camera.eye[:3] + (-along - np.sqrt(under_root))[..., None] * ray)
    return normal, -ray, np.where(under_root > 0.0, dot(normal, -ray), 0.0)


def sample_footprints(normal: np.ndarray, view_dir: np.ndarray) -> np.ndarray:
    """What each sample of a picture reflects, by differences to its neighbours; shape (FINE, FINE, 4, 3)."""
    mirror_dir = reflect(view_dir, normal)
    return parallelogram(mirror_dir, np.gradient(mirror_dir, axis=1), np.gradient(mirror_dir, axis=0))


def pixels(radiance: np.ndarray, counts: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Means of the samples of every pixel, and the pixels all of whose samples count."""
    blocks = (SIZE, SAMPLES_PER_AXIS, SIZE, SAMPLES_PER_AXIS)
    return radiance.reshape(*blocks, 3).mean(axis=(1, 3)), counts.reshape(blocks).all(axis=(1, 3))


def reference_pixels(
    camera: Camera, shade: Callable[..., np.ndarray], least: float = 0.2
) -> tuple[np.ndarray, np.ndarray]:
    """Radiance of every pixel, and those all of whose samples see the sphere at n.v above the least.

    `shade` takes normals, view directions and footprints.
    """
    normal, view_dir, cosine = samples(camera)
    return pixels(shade(normal, view_dir, sample_footprints(normal, view_dir)), cosine > least)


def reference(
    views: RadianceViews, camera: Camera, mode: Mode, warping: Warping, fading: Fading = Fading.COSINE
) -> tuple[np.ndarray, np.ndarray]:
    """Radiance by core/kinds, and the pixels all of whose samples see the sphere at n.v > 0.2."""
    normal, view_dir, cosine = samples(camera)
    footprint = sample_footprints(normal, view_dir)
    if mode is Mode.FRAGMENT:
        radiance = shading.views_fragment(views, normal, view_dir, warping, footprint, fading=fading)
    else:
        make = shading.destination_by_texel if mode is Mode.TEXEL else shading.destination_by_mesh
        made = make(views, camera.view_dir, views.size, warping, fading)
        radiance = shading.destination_lookup(made, normal, view_dir, footprint)
    return pixels(radiance, cosine > 0.2)


@pytest.fixture(scope="module")
def smooth() -> tuple[RadianceViews, PreviewRenderer]:
    views = smooth_views(12, 32)
    return views, PreviewRenderer(GpuRadianceViews(views))


@pytest.fixture(scope="module")
def patternless() -> tuple[RadianceViews, PreviewRenderer]:
    views = with_random_albedo(random_views(42, 16))
    return views, PreviewRenderer(GpuRadianceViews(views))


@MODE
@WARPING
@BY_CAMERA
def test_a_picture_is_what_the_reference_says(smooth, mode: Mode, warping: Warping, camera: Camera) -> None:
    views, renderer = smooth
    expected, inside = reference(views, camera, mode, warping)
    picture = renderer.draw(*SPHERE, camera, SIZE, ViewsLook(mode, warping))
    assert picture.dtype == np.float32
    assert np.all(picture[inside, 3] == 1.0)
    assert np.count_nonzero(inside) > 0.6 * SIZE**2
    # Facets lie 4e-5 inside the sphere, which turns a normal by 4e-5 / 0.2 and its mirror direction by
    # twice that; radiance changes by up to 2.6 a radian: 1e-3. Hardware that rounds the weights of
    # texels to 8 bits may add 2 / 512 of their difference, 0.3 at most: 1e-3.
    assert np.abs(picture[..., :3] - expected)[inside].max() < 2e-3


@MODE
@WARPING
@BY_CAMERA
def test_every_lookup_finds_its_texel(patternless, mode: Mode, warping: Warping, camera: Camera) -> None:
    views, renderer = patternless
    expected, inside = reference(views, camera, mode, warping)
    picture = renderer.draw(*SPHERE, camera, SIZE, ViewsLook(mode, warping))
    # As above, with differences of 1 between texels: 4e-4 of 16 texels a unit, and 2 times 2 / 512.
    assert np.abs(picture[..., :3] - expected)[inside].max() < 1.5e-2
    assert expected[inside].std() > 0.05


@MODE
def test_views_fade_by_the_papers_distance(patternless, mode: Mode) -> None:
    views, renderer = patternless
    expected, inside = reference(views, CAMERAS[1], mode, Warping.SINGLE, Fading.DISTANCE)
    picture = renderer.draw(
        *SPHERE, CAMERAS[1], SIZE, ViewsLook(mode, Warping.SINGLE, fading=Fading.DISTANCE)
    )
    # As above
    assert np.abs(picture[..., :3] - expected)[inside].max() < 1.5e-2
    by_cosine, _ = reference(views, CAMERAS[1], mode, Warping.SINGLE)
    assert np.abs(by_cosine - expected)[inside].max() > 3e-2


@MODE
@BY_CAMERA
def test_coverage(mode: Mode, camera: Camera) -> None:
    maps = np.ones((12, 16, 16, 3), np.float32)
    picture = PreviewRenderer(GpuRadianceViews(RadianceViews(0.25 * maps, 0.5 * maps))).draw(
        *SPHERE, camera, SIZE, ViewsLook(mode, Warping.ALBEDO)
    )
    alpha = picture[..., 3]
    # No sample lies within 4e-4 of the rim, facets are off by 4e-5: every sample is told right. In all
    # they make pi / 4 of the frame, but for some 64^(2/3) by which a circle's grid points are miscounted.
    inside = np.linalg.norm(2.0 * texel_centres(FINE, FINE) - 1.0, axis=-1) < 1.0
    expected = inside.reshape(SIZE, SAMPLES_PER_AXIS, SIZE, SAMPLES_PER_AXIS).mean(axis=(1, 3))
    np.testing.assert_array_equal(alpha, expected)
    assert alpha.mean() == pytest.approx(np.pi / 4.0, abs=64.0 ** (2.0 / 3.0) / FINE**2 * 2.0)
    # In even light a pixel holds 0.75 times what is covered, at the rim too.
    np.testing.assert_allclose(picture[..., :3], np.repeat(0.75 * alpha[..., None], 3, axis=-1), atol=1e-5)
    np.testing.assert_array_equal(picture[0, 0], 0.0)


def test_nearer_surfaces_hide_farther_ones(smooth) -> None:
    _, renderer = smooth
    positions, normals, triangles = SPHERE
    alone = renderer.draw(*SPHERE, CAMERAS[1], SIZE, ViewsLook(Mode.FRAGMENT, Warping.SPLIT))
    # The same sphere and a smaller one behind its surface, drawn before and after.
    for scale_first, scale_second in ((1.0, 0.7), (0.7, 1.0)):
        both = (
            np.concatenate([scale_first * positions, scale_second * positions]),
            np.concatenate(
                [-normals if scale_first < 1.0 else normals, -normals if scale_second < 1.0 else normals]
            ),
            np.concatenate([triangles, triangles + len(positions)]),
        )
        np.testing.assert_array_equal(
            renderer.draw(*both, CAMERAS[1], SIZE, ViewsLook(Mode.FRAGMENT, Warping.SPLIT)), alone
        )


@pytest.mark.parametrize("test", ["NONE", "LESS"])
@MODE
def test_drawing_leaves_the_state_as_it_was(smooth, mode: Mode, test: str) -> None:
    _, renderer = smooth
    gpu.state.depth_test_set(test)
    gpu.state.depth_mask_set(test == "LESS")
    try:
        renderer.draw(*SPHERE, CAMERAS[0], 8, ViewsLook(mode, Warping.SPLIT))
        assert gpu.state.depth_test_get() == test
        assert gpu.state.depth_mask_get() == (test == "LESS")
        assert gpu.state.blend_get() == "NONE"
    finally:
        gpu.state.depth_test_set("NONE")
        gpu.state.depth_mask_set(False)


def test_pictures_do_not_depend_on_what_was_drawn_before(smooth) -> None:
    _, renderer = smooth
    first = renderer.draw(*SPHERE, CAMERAS[0], SIZE, ViewsLook(Mode.TEXEL, Warping.SPLIT))
    for mode in Mode:
        renderer.draw(*SPHERE, CAMERAS[1], 16, ViewsLook(mode, Warping.SINGLE))
    np.testing.assert_array_equal(
        renderer.draw(*SPHERE, CAMERAS[0], SIZE, ViewsLook(Mode.TEXEL, Warping.SPLIT)), first
    )


def test_the_order_of_triangles_does_not_show() -> None:
    positions, normals, triangles = fine_sphere(64)
    renderer = PreviewRenderer(GpuRadianceViews(smooth_views(12, 32)))
    shuffled = np.random.default_rng(3).permutation(triangles)
    given, other = (
        renderer.draw(positions, normals, of, CAMERAS[1], SIZE, ViewsLook()) for of in (triangles, shuffled)
    )
    np.testing.assert_array_equal(given, other)
