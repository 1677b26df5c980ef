"""What lies behind objects in renders: backgrounds, and shadows that floors catch."""

from pathlib import Path

import bpy
import numpy as np
import pytest
from mathutils import Euler, Vector
from rsibr.rsibr_addon.core.conventions import Array
from rsibr.rsibr_addon.files.pictures import write_exr
from rsibr.rsibr_addon.host.render_views import NOTHING, camera_view
from rsibr.rsibr_addon.tasks.light import environments
from rsibr.tests.blender.conftest import HEIGHT, WIDTH, Render
from rsibr.tests.blender.skies import add_sky

pytestmark = [pytest.mark.needs("gl", "cycles"), pytest.mark.usefixtures("registered")]


@pytest.fixture
def floor(scene: bpy.types.Scene) -> bpy.types.Object:
    """A floor that catches shadows, and instead of the cube a black ball of radius 1 that rests on it."""
    bpy.data.objects.remove(bpy.data.objects["Cube"])
    bpy.ops.mesh.primitive_uv_sphere_add(segments=64, ring_count=32, location=(0.0, 0.0, 1.0))
    ball = bpy.context.object
    ball.name = "Ball"
    ball.data.materials.append(bpy.data.materials["Material"])
    inputs = bpy.data.materials["Material"].node_tree.nodes["Principled BSDF"].inputs
    inputs["Base Color"].default_value, inputs["Specular IOR Level"].default_value = (0, 0, 0, 1), 0.0
    bpy.ops.mesh.primitive_plane_add(size=30.0)
    item: bpy.types.Object = bpy.context.object
    item.name, item.is_shadow_catcher = "Floor", True
    scene.camera.location = (5.0, -6.0, 4.5)
    towards = Vector((0.0, 0.0, 0.3)) - scene.camera.location
    scene.camera.rotation_euler = towards.to_track_quat("-Z", "Y").to_euler()
    scene.camera.data.lens = 40.0
    return item


def places_on_floor(scene: bpy.types.Scene) -> tuple[Array, Array]:
    """The points of z = 0 that pixels' middles see, shape (HEIGHT, WIDTH, 3), and where the ball is."""
    depsgraph = bpy.context.evaluated_depsgraph_get()
    camera = scene.camera
    view = camera_view(depsgraph, camera, camera.matrix_world, 0.0, (WIDTH, HEIGHT))
    x, y = np.meshgrid((np.arange(WIDTH) + 0.5) / WIDTH, (np.arange(HEIGHT) + 0.5) / HEIGHT)
    clip = np.stack([2.0 * x - 1.0, 2.0 * y - 1.0, np.zeros_like(x), np.ones_like(x)], axis=-1)
    world = clip @ (view.pose @ np.linalg.inv(view.projection)).T
    eye = view.pose[:3, 3]
    along = world[..., :3] / world[..., 3:] - eye
    along /= np.linalg.norm(along, axis=-1, keepdims=True)
    to_ball = np.array([0.0, 0.0, 1.0]) - eye
    aside = np.linalg.norm(np.cross(along, to_ball), axis=-1)
    return eye - along * (eye[2] / along[..., 2:]), aside < 1.0


@pytest.mark.slow
@pytest.mark.parametrize("film_transparent", [True, False])
def test_a_ball_s_shadow_is_its_form_factor(
    scene: bpy.types.Scene, render: Render, floor: bpy.types.Object, film_transparent: bool
) -> None:
    """In a white world; by Cycles as well."""
    scene.world.node_tree.nodes["Background"].inputs["Color"].default_value = (1.0, 1.0, 1.0, 1.0)
    scene.render.film_transparent = film_transparent
    bpy.ops.mesh.primitive_cube_add(size=1.0, location=(0.0, 2.0, -2.0))  # behind the floor: not seen
    ours, truth = render(samples=4), render("CYCLES", samples=64)
    taken = ours["Combined"][..., 3] if film_transparent else 1.0 - ours["Combined"][..., 0]
    by_cycles = truth["Combined"][..., 3] if film_transparent else 1.0 - truth["Combined"][..., 0]
    places, is_ball = places_on_floor(scene)
    # A ball of radius 1 on a plane takes 1 / (rho^2 + 1)^(3/2) of its light, rho from its foot
    rho = np.linalg.norm(places[..., :2], axis=-1)
    near = ~is_ball & (rho > 0.6) & (rho < 3.0)
    edge = np.abs(np.diff(is_ball.astype(int), axis=1, append=0)) + np.abs(
        np.diff(is_ball.astype(int), axis=0, append=0)
    )
    near &= (edge == 0) & (np.roll(edge, 1, axis=1) == 0) & (np.roll(edge, 1, axis=0) == 0)
    assert near.sum() > 200
    expected = (rho**2 + 1.0) ** -1.5
    error = (taken - expected)[near]
    # The edge of a lamp's shadow is one step of 256, and some ten lamps' edges may meet nearby
    assert np.abs(error).max() < 12.0 / 256.0
    assert np.sqrt(np.mean(error**2)) < 0.01
    assert abs(error.mean()) < 0.005
    # Cycles' own is a mean of 64 random samples
    apart = (taken - by_cycles)[near]
    assert abs(apart.mean()) < 0.01
    assert np.sqrt(np.mean(apart**2)) < 0.5 / np.sqrt(64)
    np.testing.assert_array_equal(ours["Depth"] < NOTHING, truth["Depth"] < NOTHING)


@pytest.mark.slow
def test_a_tilted_floor_in_a_turned_sky_has_the_shadow_of_cycles(
    scene: bpy.types.Scene,
    render: Render,
    floor: bpy.types.Object,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(environments, "WORLD_HEIGHT", 128)
    add_sky(scene, tmp_path)
    scene.render.film_transparent = True
    turn = Euler((0.3, -0.25, 0.4)).to_matrix().to_4x4()
    for item in (floor, bpy.data.objects["Ball"]):
        item.matrix_world = turn @ item.matrix_basis
    ours, truth = (render(engine, samples=128)["Combined"][..., 3] for engine in ("RSIBR", "CYCLES"))
    assert ((ours > 0.05) & (ours < 0.95)).sum() > 300
    apart = ours - truth
    # The sky has four colours: Cycles takes the mean of their shadows in another way. The rest is noise
    assert abs(apart.mean()) < 0.01
    assert np.sqrt(np.mean(apart**2)) < 0.05


def test_what_casts_no_shadow_and_floors_that_are_not_flat(
    scene: bpy.types.Scene, render: Render, floor: bpy.types.Object, capfd: pytest.CaptureFixture[str]
) -> None:
    scene.render.film_transparent = True
    ball = bpy.data.objects["Ball"]
    shadow = render()["Combined"][..., 3]
    ball.visible_camera = False
    assert render()["Combined"][..., 3].max() > 0.9, "what is not seen casts a shadow"
    ball.visible_camera, ball.visible_shadow = True, False
    alone = render()["Combined"][..., 3]
    assert set(np.unique(alone)) == {0.0, 1.0}
    assert (shadow > alone).sum() > 300
    ball.visible_shadow = True
    floor.data.vertices[0].co.z = -2.0
    capfd.readouterr()
    np.testing.assert_array_equal(render()["Combined"][..., 3] == 1.0, alone == 1.0)
    told = capfd.readouterr()
    assert (told.out + told.err).count("Floor catches no shadows, as it is not flat") == 1


def test_a_picture_fills_the_frame_with_its_middle(
    scene: bpy.types.Scene, render: Render, tmp_path: Path
) -> None:
    """Also where a border is rendered: with squares of four colours, the frame's quarters."""
    bpy.data.objects.remove(bpy.data.objects["Cube"])
    picture = np.zeros((8, 32, 4), np.float32)
    picture[..., 3] = 1.0
    picture[:4, :16, 0] = picture[:4, 16:, 1] = picture[4:, :16, 2] = 0.5
    write_exr(tmp_path / "picture.exr", picture)
    scene.rsibr_render.background = "//picture.exr"
    scene.rsibr_render.background_exposure = 1.0
    whole = render()["Combined"]
    quarters = whole.reshape(2, HEIGHT // 2, 2, WIDTH // 2, 4)[:, 2:-2, :, 2:-2]
    for row, column, colour in ((0, 0, (1, 0, 0)), (0, 1, (0, 1, 0)), (1, 0, (0, 0, 1)), (1, 1, (0, 0, 0))):
        seen = quarters[row, :, column, :][..., :3]
        # But for the middle, where colours meet over a texel, four pixels wide
        assert np.allclose(np.median(seen, axis=(0, 1)), colour, atol=1e-3)
    scene.render.use_border = scene.render.use_crop_to_border = True
    scene.render.border_min_x, scene.render.border_max_x = 0.25, 0.75
    scene.render.border_min_y, scene.render.border_max_y = 0.25, 1.0
    part = render()["Combined"]
    np.testing.assert_allclose(part, whole[HEIGHT // 4 :, WIDTH // 4 : 3 * WIDTH // 4], atol=1e-5)
    scene.rsibr_render.background = "//missing.exr"
    with pytest.raises(RuntimeError, match=r"missing.exr"):
        render()


def test_a_blurred_background_is_smooth_and_lights_nothing(
    scene: bpy.types.Scene, render: Render, tmp_path: Path
) -> None:
    add_sky(scene, tmp_path)
    plain = render()
    scene.rsibr_render.background_blur = 40.0
    passes = render()
    covered = passes["Depth"][..., 0] < NOTHING
    np.testing.assert_array_equal(passes["Combined"][covered], plain["Combined"][covered])
    seen, sharp = passes["Combined"][~covered], plain["Combined"][~covered]
    assert seen[:, :3].std(axis=0).max() < 0.5 * sharp[:, :3].std(axis=0).max()
    assert (seen[:, 3] == 1.0).all()
