"""Renders by the engine RSIBR: the viewport's picture, in the places where Cycles has the same surfaces."""

from collections.abc import Callable
from pathlib import Path

import bpy
import gpu
import numpy as np
import pytest
from rsibr.rsibr_addon.core.at_once import AtOnce
from rsibr.rsibr_addon.core.light.transfer_curve import srgb_from_linear
from rsibr.rsibr_addon.host.render_views import NOTHING
from rsibr.rsibr_addon.host.visible_surfaces import View, layer_of
from rsibr.rsibr_addon.tasks.light import environments
from rsibr.rsibr_addon.tasks.methods.live_materials import LiveFits
from rsibr.rsibr_addon.tasks.viewport.previews import Previews
from rsibr.tests.blender.conftest import HEIGHT, WIDTH, Render
from rsibr.tests.blender.skies import add_sky
from rsibr.tests.flat_capture import write_flat_capture

pytestmark = [pytest.mark.needs("gl", "cycles"), pytest.mark.usefixtures("registered")]


def perspective(scene: bpy.types.Scene) -> None:
    scene.camera.data.shift_x = 0.1


def orthographic(scene: bpy.types.Scene) -> None:
    scene.camera.data.type, scene.camera.data.ortho_scale = "ORTHO", 6.0
    scene.camera.scale = (2.0, 1.0, 3.0)


def bordered(scene: bpy.types.Scene) -> None:
    render = scene.render
    render.use_border, render.use_crop_to_border = True, True
    render.border_min_x, render.border_max_x, render.border_min_y = 0.21, 0.83, 0.1
    render.pixel_aspect_x, render.resolution_percentage = 1.5, 90


def stereoscopic(scene: bpy.types.Scene) -> None:
    scene.render.use_multiview, scene.render.image_settings.views_format = True, "INDIVIDUAL"
    stereo = scene.camera.data.stereo
    stereo.convergence_mode, stereo.interocular_distance, stereo.convergence_distance = "OFFAXIS", 1.0, 7.0
    scene.camera.data.shift_x = 0.1


def orthographic_eye(scene: bpy.types.Scene) -> None:
    stereoscopic(scene)
    orthographic(scene)


def add_shapes() -> None:
    """What renders have otherwise than viewports: levels, hidden objects, instances."""
    cube = bpy.data.objects["Cube"]
    subdivision = cube.modifiers.new("Subdivision", "SUBSURF")
    subdivision.levels, subdivision.render_levels = 0, 3
    names = "rendered only", "hidden in renders", "pattern"
    others = [bpy.data.objects.new(name, bpy.data.meshes["Cube"].copy()) for name in names]
    for other, place in zip(others, [(2.5, 0, 0), (0, 2.5, 0), (0, -3, 0)], strict=True):
        other.location, other.scale = place, (0.5, 0.7, -0.6)
    others[0].display_type, others[1].hide_render = "WIRE", True
    for other in others[:2]:
        bpy.context.collection.objects.link(other)
    others[0].hide_viewport = True
    pattern = bpy.data.collections.new("pattern")
    pattern.objects.link(others[2])
    instance = bpy.data.objects.new("instance", None)
    instance.instance_type, instance.instance_collection = "COLLECTION", pattern
    bpy.context.collection.objects.link(instance)


@pytest.mark.slow
@pytest.mark.parametrize("change", [perspective, orthographic, bordered, stereoscopic, orthographic_eye])
def test_the_same_surfaces_are_at_the_same_places_as_by_cycles(
    scene: bpy.types.Scene, render: Render, change: Callable[[bpy.types.Scene], None]
) -> None:
    scene.render.film_transparent = True
    add_shapes()
    change(scene)
    ours, truth = render(samples=64), render("CYCLES", samples=64)
    alike = (ours["Combined"][..., 3] == 1.0) & (truth["Combined"][..., 3] == 1.0)
    assert alike.sum() > 300
    # Depths of 10 are stored between 0.1 and 100 in 24 bits: one step is 6e-5, as is one of single precision
    np.testing.assert_allclose(ours["Depth"][alike], truth["Depth"][alike], atol=5e-4)
    np.testing.assert_array_equal(ours["Depth"] < NOTHING, truth["Depth"] < NOTHING)
    apart = np.abs(ours["Combined"][..., 3] - truth["Combined"][..., 3])
    assert apart[~alike].mean() < 0.01
    deviation = 0.5 / np.sqrt(64)  # of a share that random samples tell, at most
    assert apart.max() < 3.0 * deviation
    normals = np.abs(ours["Normal"] - truth["Normal"])[alike]
    assert np.median(normals) < 1e-3
    assert normals.max() < 2.0 * 3.0 * deviation


@pytest.mark.parametrize("transform", ["Standard", "AgX"])
def test_a_frame_is_the_picture_that_the_viewport_shows(
    scene: bpy.types.Scene,
    render: Render,
    tmp_path: Path,
    stored_bytes: Callable[[Path], np.ndarray],
    transform: str,
) -> None:
    """Objects in the world, and one with a map set: one sample, in the centres of pixels as in viewports."""
    add_sky(scene, tmp_path)
    material = bpy.data.materials["Material"].node_tree.nodes["Principled BSDF"].inputs
    material["Metallic"].default_value, material["Roughness"].default_value = 1.0, 0.2
    scene.view_settings.view_transform = transform
    scene.view_settings.exposure = 0.7
    scene.render.film_transparent = True
    add_shapes()
    shaded = bpy.data.objects["Cube"].copy()
    shaded.location.z, shaded.hide_viewport = 2.0, False
    scene.collection.objects.link(shaded)
    shaded.rsibr.map_set = str(write_flat_capture(tmp_path / "flat.rsibr.exr", (0.5, 0.1, 0.7)))
    for item in bpy.data.objects:  # viewports have surfaces of their own
        item.display_type, item.hide_viewport = "TEXTURED", item.hide_render
    subdivision = bpy.data.objects["Cube"].modifiers["Subdivision"]
    subdivision.levels = shaded.modifiers["Subdivision"].levels = subdivision.render_levels
    render()
    settings = scene.render.image_settings
    settings.media_type, settings.file_format, settings.color_mode = "IMAGE", "PNG", "RGBA"
    settings.color_depth, scene.render.dither_intensity = "8", 0.0
    scene.render.filepath = str(tmp_path / "frame.png")
    bpy.ops.render.render(write_still=True)
    rendered, shown = stored_bytes(tmp_path / "frame.png"), viewport_picture(scene)
    covered = shown[..., 3] == 1.0
    np.testing.assert_array_equal(covered, rendered[..., 3] == 255.0)
    assert covered.sum() > 300
    assert len(np.unique(rendered[covered], axis=0)) > 20
    assert np.abs(255.0 * srgb_from_linear(shown[covered, :3]) - rendered[covered, :3]).max() <= 1.0


def viewport_picture(scene: bpy.types.Scene) -> np.ndarray:
    """What the draw handler draws in Rendered through the scene's camera, shape (HEIGHT, WIDTH, 4)."""
    (space,) = (area.spaces.active for area in bpy.context.screen.areas if area.type == "VIEW_3D")
    space.shading.type, space.overlay.show_overlays = "RENDERED", False
    bpy.context.view_layer.update()
    view = View(scene, layer_of(bpy.context), bpy.context.evaluated_depsgraph_get(), space)
    camera, previews = scene.camera, Previews(LiveFits(), AtOnce())
    projection = camera.calc_matrix_camera(view.depsgraph, x=WIDTH, y=HEIGHT)
    target = gpu.types.GPUOffScreen(WIDTH, HEIGHT, format="RGBA32F")
    with target.bind(), gpu.matrix.push_pop(), gpu.matrix.push_pop_projection():
        framebuffer = gpu.state.active_framebuffer_get()
        gpu.matrix.load_matrix(camera.matrix_world.normalized().inverted())
        gpu.matrix.load_projection_matrix(projection)
        previews.add_display(scene)
        assert previews.draw(view)
        while previews.is_busy:
            framebuffer.clear(color=(0.0, 0.0, 0.0, 0.0), depth=1.0)
            assert previews.draw(view)
        read = framebuffer.read_color(0, 0, WIDTH, HEIGHT, 4, 0, "FLOAT")
    assert previews.faults.trouble is None
    return np.array(read.to_list())


def test_the_world_is_seen_as_cycles_shows_it_and_turns_with_its_mapping(
    scene: bpy.types.Scene, render: Render, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(environments, "WORLD_HEIGHT", 128)
    add_sky(scene, tmp_path)
    bpy.data.objects["Cube"].hide_render = True
    ours, truth = render()["Combined"], render("CYCLES", samples=4)["Combined"]
    assert (ours[..., 3] == 1.0).all()
    # Between its 32 columns the picture is interpolated; samples of the world, eight of each, lose edges
    assert np.abs(ours - truth).max() < 0.05 * np.ptp(truth[..., :3])


def test_without_a_world_all_is_dark_but_what_shines(scene: bpy.types.Scene, render: Render) -> None:
    scene.world = None
    inputs = bpy.data.materials["Material"].node_tree.nodes["Principled BSDF"].inputs
    inputs["Emission Color"].default_value, inputs["Emission Strength"].default_value = (0.5, 0.25, 0, 1), 2.0
    passes = render()
    covered = passes["Depth"][..., 0] < NOTHING
    for name in ("Combined", "Emission"):
        seen = passes[name][..., :3]
        np.testing.assert_allclose(
            seen[covered], np.broadcast_to([1.0, 0.5, 0.0], seen[covered].shape), atol=1e-5
        )
        assert not seen[~covered].any()


def test_an_empty_scene_shows_the_world_alone(scene: bpy.types.Scene, render: Render) -> None:
    bpy.data.objects.remove(bpy.data.objects["Cube"])
    passes = render()
    np.testing.assert_allclose(
        passes["Combined"], np.broadcast_to([0.2, 0.4, 0.8, 1.0], (HEIGHT, WIDTH, 4)), 1e-3
    )
    assert (passes["Depth"] == NOTHING).all()


def test_keys_of_looks_and_objects_show_in_each_frame(
    scene: bpy.types.Scene, render: Render, tmp_path: Path
) -> None:
    cube = bpy.data.objects["Cube"]
    cube.rsibr.map_set = str(write_world(scene, render))
    cube.rsibr.kernel_pyramid.own = False
    seen = {}
    for frame, colour, place in ((1, (1, 0, 0), 0.0), (3, (0, 1, 0), 1.5)):
        cube.rsibr.kernel_pyramid.base_color, cube.location.z = colour, place
        cube.rsibr.kernel_pyramid.keyframe_insert("base_color", frame=frame)
        cube.keyframe_insert("location", frame=frame)
    for frame in (1, 3):
        scene.frame_set(frame)
        cube.rsibr.kernel_pyramid.base_color = (0, 0, 1)  # what is keyed does not count
        seen[frame] = render()
    first, last = (each["Combined"][each["Depth"][..., 0] < NOTHING] for each in seen.values())
    assert (first[:, 0] > first[:, 1]).all()
    assert (last[:, 1] > last[:, 0]).all()
    assert (seen[1]["Depth"] != seen[3]["Depth"]).any()


def write_world(scene: bpy.types.Scene, render: Render) -> Path:
    """Have the world baked, and say where."""
    render()
    (path,) = Path(bpy.path.abspath("//rsibr")).glob("*.rsibr.exr")
    return path


def warned(text: str) -> list[str]:
    return [line for line in text.splitlines() if line.startswith("Warning: ")]


def test_what_cannot_be_shown_is_said_once(
    scene: bpy.types.Scene, render: Render, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    cube = bpy.data.objects["Cube"]
    plain = render()["Combined"]
    cube.rsibr.map_set = str(tmp_path / "missing.rsibr.exr")
    scene.render.use_motion_blur = scene.camera.data.dof.use_dof = True
    bpy.context.view_layer.material_override = bpy.data.materials["Material"]
    scene.collection.objects.link(bpy.data.objects.new("Lamp", bpy.data.lights.new("Lamp", "POINT")))
    capfd.readouterr()
    np.testing.assert_array_equal(render()["Combined"], plain)
    told = capfd.readouterr()
    for words in ("missing.rsibr.exr", "motion blur", "depth of field", "material override", "lamp Lamp"):
        assert len([line for line in (told.out + told.err).splitlines() if words in line]) == 1, words


def test_a_panoramic_camera_is_refused(scene: bpy.types.Scene, render: Render) -> None:
    scene.camera.data.type = "PANO"
    with pytest.raises(RuntimeError, match="Camera Camera is panoramic, and RSIBR renders perspective"):
        render()


def test_a_camera_without_size_is_refused(scene: bpy.types.Scene, render: Render) -> None:
    scene.camera.scale = (0.0, 0.0, 0.0)
    with pytest.raises(RuntimeError, match="Camera Camera is scaled to 0"):
        render()


def test_a_world_that_cannot_be_baked_is_told(scene: bpy.types.Scene, render: Render) -> None:
    tree = scene.world.node_tree
    texture = tree.nodes.new("ShaderNodeTexEnvironment")
    texture.image = bpy.data.images.new("painted", 4, 2, float_buffer=True)
    texture.image.pixels[0] = 0.5
    tree.links.new(texture.outputs["Color"], tree.nodes["Background"].inputs["Color"])
    with pytest.raises(RuntimeError, match="painted"):
        render()


@pytest.mark.slow
@pytest.mark.parametrize("has_map_set", [False, True])
def test_what_no_image_says_is_baked_before(
    scene: bpy.types.Scene, render: Render, has_map_set: bool, capfd: pytest.CaptureFixture[str]
) -> None:
    scene.world.node_tree.nodes["Background"].inputs["Color"].default_value = (0.0, 0.0, 0.0, 1.0)
    if has_map_set:
        bpy.data.objects["Cube"].rsibr.map_set = str(write_world(scene, render))
    tree = bpy.data.materials["Material"].node_tree
    checker, inputs = tree.nodes.new("ShaderNodeTexChecker"), tree.nodes["Principled BSDF"].inputs
    checker.inputs["Color1"].default_value, checker.inputs["Color2"].default_value = (
        (1, 0, 0, 1),
        (0, 1, 0, 1),
    )
    checker.inputs["Scale"].default_value = 4.0
    tree.links.new(checker.outputs["Color"], inputs["Emission Color"])
    inputs["Emission Strength"].default_value = 0.5
    passes = render()
    seen = passes["Emission"][passes["Depth"][..., 0] < NOTHING]
    for colour in ((0.5, 0.0, 0.0), (0.0, 0.5, 0.0)):
        assert np.isclose(seen, colour, atol=0.02).all(axis=-1).sum() > 50
    told = capfd.readouterr()
    assert "Until its bake is done" not in told.out + told.err


def test_each_object_s_messages_are_told(
    scene: bpy.types.Scene, render: Render, capfd: pytest.CaptureFixture[str]
) -> None:
    for number, x in enumerate((-1.5, 1.5)):
        item = bpy.data.objects["Cube"].copy()
        item.name, item.location.x = f"Copy {number}", x
        scene.collection.objects.link(item)
        material = item.data.materials[0].copy()
        material.name = f"Veined {number}"
        item.material_slots[0].link, item.material_slots[0].material = "OBJECT", material
        material.node_tree.nodes["Principled BSDF"].inputs["Subsurface Weight"].default_value = 0.5
    capfd.readouterr()
    render()
    told = capfd.readouterr()
    for number in range(2):
        assert f"Material Veined {number} is shown without" in told.out + told.err
