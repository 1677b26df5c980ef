"""Previews among what a frame buffer holds already: their colours, what hides them, and a turned world."""

from collections.abc import Iterator
from contextlib import contextmanager

import gpu
import numpy as np
import pytest
from mathutils import Matrix
from rsibr.rsibr_addon.core.brdf.principled import Surface
from rsibr.rsibr_addon.core.geometry.camera import Camera
from rsibr.rsibr_addon.core.kinds.radiance_views.shading import ViewsLook, views_fragment
from rsibr.rsibr_addon.core.light.transfer_curve import linear_from_srgb
from rsibr.rsibr_addon.core.pictures.display import TABLE_SIZE, displayed
from rsibr.rsibr_addon.core.pictures.false_colour import heat
from rsibr.rsibr_addon.device import buffers
from rsibr.rsibr_addon.device.context import ensure_context
from rsibr.rsibr_addon.device.drawing import GpuMesh
from rsibr.rsibr_addon.device.kinds.kernel_pyramid import GpuPyramid
from rsibr.rsibr_addon.device.kinds.radiance_views import GpuRadianceViews
from rsibr.rsibr_addon.device.preview_stage import (
    Beneath,
    Difference,
    Stage,
    current_sight,
    draw_occluder,
)
from rsibr.tests.glsl.principled_inputs import families, pyramid
from rsibr.tests.synthetic_views import smooth_views, visible_points

SIZE = 64
CAMERA = Camera((0.3, -0.8, 0.45), field_of_view=np.radians(40.0))
STRAIGHT = np.eye(3)
QUARTER = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
VIEWS = smooth_views(12, 64)
LOOK = ViewsLook(warping="split")


def table() -> np.ndarray:
    """A display of six stops about radiance 1, other colours for each channel."""
    part = np.clip((np.arange(TABLE_SIZE) - 40.0) / 30.0, 0.0, 1.0)
    blue, green, red = np.meshgrid(part, part, part, indexing="ij")
    return np.stack([red, 0.6 * green + 0.4 * blue, 1.0 - blue], axis=-1)


def sphere(radius: float = 1.0) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """A sphere's positions, normals and triangles."""
    from rsibr.rsibr_addon.host.meshes import load_mesh

    mesh = load_mesh("sphere")
    return radius * mesh.positions, mesh.normals, mesh.triangles


@contextmanager
def screen() -> Iterator[gpu.types.GPUFrameBuffer]:
    """A frame buffer of floats in Blender's stead, empty and far away, seen through `CAMERA`."""
    ensure_context()
    colour = gpu.types.GPUTexture((SIZE, SIZE), format="RGBA32F")
    depth = gpu.types.GPUTexture((SIZE, SIZE), format="DEPTH_COMPONENT32F")
    target = gpu.types.GPUFrameBuffer(depth_slot=depth, color_slots=(colour,))
    with target.bind(), gpu.matrix.push_pop(), gpu.matrix.push_pop_projection():
        target.clear(color=(0.0, 0.0, 0.0, 0.0), depth=1.0)
        gpu.matrix.load_matrix(Matrix(np.linalg.inv(CAMERA.world_from_camera)))
        gpu.matrix.load_projection_matrix(Matrix(CAMERA.projection))
        yield target


def shown(
    turn: np.ndarray = STRAIGHT,
    scale: float = 1.0,
    span: tuple[float, float] = (0.0, 1.0),
    in_front: float | None = None,
    among_others: bool = True,
) -> np.ndarray:
    """A sphere, previewed; perhaps within another of radius `in_front`; shape (SIZE, SIZE, 4)."""
    with screen() as target:
        stage, sight = Stage(), current_sight()
        subject = GpuRadianceViews(VIEWS)
        if in_front is not None:
            gpu.state.depth_test_set("LESS_EQUAL")
            gpu.state.depth_mask_set(True)
            draw_occluder(GpuMesh(*sphere(in_front)), sight.on(np.eye(4), STRAIGHT))
            gpu.state.depth_test_set("NONE")
        with stage.drawing():
            subject.draw(GpuMesh(*sphere()), sight.on(np.eye(4), turn), LOOK)
        stage.show(buffers.table_texture(table()), scale, span, among_others)
        return buffers.pixels(target, SIZE)


def expected(turn: np.ndarray, scale: float) -> tuple[np.ndarray, np.ndarray]:
    """Colours within 0.9 of the silhouette, and which pixels these are."""
    points = 2.0 * (np.arange(SIZE) + 0.5) / SIZE - 1.0
    inside = np.hypot(points[None, :], points[:, None]) < 0.9
    normal, view_dir = visible_points(CAMERA, SIZE, radius=0.9)
    radiance = scale * views_fragment(VIEWS, normal @ turn.T, view_dir @ turn.T, LOOK.warping)
    return linear_from_srgb(displayed(table(), radiance)), inside


@pytest.mark.parametrize("turn", [STRAIGHT, QUARTER], ids=["straight", "turned"])
@pytest.mark.parametrize("scale", [1.0, 0.5])
def test_colours_are_those_of_the_display(turn: np.ndarray, scale: float) -> None:
    picture = shown(turn, scale)
    colours, inside = expected(turn, scale)
    error = np.abs(picture[inside, :3] - colours)
    # The mesh's facets tilt normals by up to 1/400, and mirrored radiance changes by up to 6 of it a radian:
    # 0.02 of a stop. The display has 1/6 a stop, its curve a slope of up to 2.3, half floats add 1e-3.
    assert error.max() < 0.01
    assert np.all(picture[inside, 3] == 1.0)
    assert picture[0, 0, 3] == 0.0


def test_a_turn_shows() -> None:
    straight, turned = (expected(turn, 1.0)[0] for turn in (STRAIGHT, QUARTER))
    assert np.abs(straight - turned).max() > 0.1


def test_what_lies_in_front_hides_and_what_lies_behind_does_not() -> None:
    whole = shown()[..., 3] == 1.0
    assert whole.sum() > 2000
    assert not shown(in_front=1.01)[..., 3].any()
    np.testing.assert_array_equal(shown(in_front=0.99)[..., 3] == 1.0, whole)
    # The same surface: depths agree, and the preview is shown
    np.testing.assert_array_equal(shown(in_front=1.0)[..., 3] == 1.0, whole)
    np.testing.assert_array_equal(shown(in_front=1.01, among_others=False)[..., 3] == 1.0, whole)


def test_a_span_ends_in_lines() -> None:
    whole, part = shown(), shown(span=(0.25, 0.75))
    white = np.all(part == 1.0, axis=(0, 2))
    assert np.flatnonzero(white).tolist() == [15, 16, 47, 48]
    np.testing.assert_array_equal(part[:, 17:47], whole[:, 17:47])
    assert not part[:, :15].any()
    assert not part[:, 49:].any()


def test_what_is_covered_in_part_shows_what_is_behind() -> None:
    with screen() as target:
        stage, sight = Stage(), current_sight()
        subject = GpuPyramid(pyramid(), families())
        clear, half = (Surface(emission=(0.3, 0.5, 0.4), alpha=alpha) for alpha in (1.0, 0.5))
        pictures = []
        for surface in (clear, half):
            target.clear(color=(0.2, 0.4, 0.8, 1.0), depth=1.0)
            with stage.drawing():
                subject.draw(GpuMesh(*sphere()), sight.on(np.eye(4), STRAIGHT), surface)
            stage.show(buffers.table_texture(table()), 1.0, (0.0, 1.0), among_others=True)
            pictures.append(buffers.pixels(target, SIZE))
    inside = expected(STRAIGHT, 1.0)[1]
    whole, veiled = (picture[inside, :3] for picture in pictures)
    np.testing.assert_allclose(veiled, 0.5 * whole + 0.5 * np.array([0.2, 0.4, 0.8]), atol=1e-3)


@pytest.mark.parametrize("scale", [None, 2.0], ids=["colours", "radiance"])
@pytest.mark.parametrize("alpha", [1.0, 0.5])
def test_what_covers_all_lies_beneath_overlays(scale: float | None, alpha: float) -> None:
    """In the frame buffer of surfaces, as its colours are or as radiance; the rest lies over."""
    with screen() as over, screen() as surfaces:
        stage, sight, subject = Stage(), current_sight(), GpuPyramid(pyramid(), families())
        with stage.drawing():
            emitting = Surface(emission=(0.3, 0.5, 0.4), alpha=alpha)
            subject.draw(GpuMesh(*sphere()), sight.on(np.eye(4), STRAIGHT), emitting)
        drawn = np.array(stage.radiance.read()).reshape(SIZE, SIZE, 4)
        display, span = buffers.table_texture(table()), (0.0, 0.5)
        with over.bind():
            stage.show(display, 1.0, span, True, None, Beneath(surfaces, scale))
            above = buffers.pixels(over, SIZE)
        beneath = buffers.pixels(surfaces, SIZE)
        with over.bind():
            over.clear(color=(0.0, 0.0, 0.0, 0.0), depth=1.0)
            stage.show(display, 1.0, span, True)
            whole = buffers.pixels(over, SIZE)
    column = np.arange(SIZE)[None, :]
    left = column < SIZE // 2 - 1
    covered = (drawn[..., 3] == 1.0) & left
    veiled = (drawn[..., 3] > 0.0) & (drawn[..., 3] < 1.0) & left
    assert np.any(covered) == (alpha == 1.0)
    np.testing.assert_array_equal(above[veiled], whole[veiled])
    assert not above[covered].any()
    # The line of the split is a mark of ours, over all
    np.testing.assert_array_equal(above[:, SIZE // 2 - 1 : SIZE // 2 + 1], 1.0)
    wanted = whole[covered] if scale is None else np.append(scale, [scale, scale, 1.0]) * drawn[covered]
    np.testing.assert_allclose(beneath[covered], wanted, rtol=1e-6)
    assert not beneath[(drawn[..., 3] < 1.0) | (column >= SIZE // 2)].any()


def test_the_state_is_as_before() -> None:
    with screen() as target:
        stage = Stage()
        state = gpu.state.depth_test_get(), gpu.state.depth_mask_get(), gpu.state.blend_get()
        with stage.drawing():
            pass
        stage.show(buffers.table_texture(table()), 1.0, (0.0, 1.0), among_others=True)
        assert (gpu.state.depth_test_get(), gpu.state.depth_mask_get(), gpu.state.blend_get()) == state
        assert not buffers.pixels(target, SIZE).any()


def test_a_difference_is_that_on_the_display() -> None:
    normal, view_dir = visible_points(CAMERA, SIZE, radius=0.9)
    straight, turned = (
        displayed(table(), views_fragment(VIEWS, normal @ turn.T, view_dir @ turn.T, LOOK.warping))
        for turn in (STRAIGHT, QUARTER)
    )
    with screen() as target:
        first, second, sight, subject = Stage(), Stage(), current_sight(), GpuRadianceViews(VIEWS)
        for stage, turn in ((first, STRAIGHT), (second, QUARTER)):
            with stage.drawing():
                subject.draw(GpuMesh(*sphere()), sight.on(np.eye(4), turn), LOOK)
        first.show(
            buffers.table_texture(table()), 1.0, (0.0, 1.0), True, Difference(second.radiance, 1.0, 0.25)
        )
        picture = buffers.pixels(target, SIZE)
    _, inside = expected(STRAIGHT, 1.0)
    # The scale lies over the lower part.
    free = np.arange(SIZE)[:, None] > 40
    apart = np.abs(straight - turned).max(axis=-1) / 0.25
    assert apart.max() > 0.5
    colours = linear_from_srgb(heat(apart))[(inside & free)[inside]]
    # Twice the error of colours, 0.003 before the curve, times 3 / 0.25 for the heat, times the curve's 2.3
    error = np.abs(picture[inside & free, :3] - colours)
    assert error.max() < 2.0 * 0.003 * 12.0 * 2.3


@pytest.mark.parametrize("alpha", [0.5, 1.0])
def test_what_covers_in_part_differs_by_its_light_alone(alpha: float) -> None:
    subject = GpuPyramid(pyramid(), families())
    with screen() as target:
        first, second, sight = Stage(), Stage(), current_sight()
        for stage, coverage in ((first, 0.5), (second, alpha)):
            with stage.drawing():
                surface = Surface(emission=(0.3, 0.5, 0.4), alpha=coverage)
                subject.draw(GpuMesh(*sphere()), sight.on(np.eye(4), STRAIGHT), surface)
        difference = Difference(second.radiance, 1.0, 0.25)
        first.show(buffers.table_texture(table()), 1.0, (0.0, 1.0), True, difference)
        picture = buffers.pixels(target, SIZE)
    _, inside = expected(STRAIGHT, 1.0)
    free = np.arange(SIZE)[:, None] > 40
    none = linear_from_srgb(heat(np.zeros(1)))
    np.testing.assert_allclose(picture[inside & free, :3] - none, 0.0, atol=1e-3)


def test_one_mesh_is_drawn_where_each_draw_of_a_frame_says() -> None:
    mesh, views = GpuMesh(*sphere(0.25)), GpuRadianceViews(VIEWS)

    def covered(*places: float) -> np.ndarray:
        with screen() as target:
            sight = current_sight()
            for place in places:
                model = np.eye(4)
                model[:3, 3] = place * np.cross(CAMERA.view_dir, (0.0, 0.0, 1.0))
                views.draw(mesh, sight.on(model, STRAIGHT), LOOK)
            return buffers.pixels(target, SIZE)[..., 3] == 1.0

    left, right = covered(-0.5), covered(0.5)
    assert min(left.sum(), right.sum()) > 100
    assert not (left & right).any()
    np.testing.assert_array_equal(covered(-0.5, 0.5), left | right)
