"""Light around a point of a scene: as much of it as Cycles itself brings to a white surface there."""

from pathlib import Path
from typing import Any

import bpy
import numpy as np
import pytest
from mathutils import Matrix, Vector
from rsibr.rsibr_addon.core.errors import OutputFileError, RangeError, RsibrWarning, SceneError
from rsibr.rsibr_addon.core.progress import drain
from rsibr.rsibr_addon.settings.environment import SceneLight
from rsibr.rsibr_addon.tasks.light.scene import illuminate_from_scene
from rsibr.tests.cycles.scene_light import POINT, SIZE, AddLamp, add_box, add_world, captured
from rsibr.tests.open_file import open_file_state

pytestmark = pytest.mark.usefixtures("empty_scene")


def test_the_subject_and_its_parts_are_left_out(tmp_path: Path) -> None:
    add_world(1.0)
    subject = add_box(POINT)
    part = add_box((3.0, -2.0, 2.5), 0.5)
    part.parent, part.matrix_parent_inverse = subject, subject.matrix_world.inverted()
    holder = bpy.data.collections.new("holder")
    source = bpy.data.objects.new("source", part.data)
    holder.objects.link(source)
    instancer = bpy.data.objects.new("instancer", None)
    instancer.parent, instancer.location = subject, (0.0, 2.0, 0.0)
    instancer.instance_type, instancer.instance_collection = "COLLECTION", holder
    bpy.context.scene.collection.objects.link(instancer)
    radiance = captured(tmp_path, subject=subject.name)
    np.testing.assert_allclose(radiance, 1.0, rtol=1e-5)
    # What is hidden in the viewport only is still there
    add_box((-3.0, -2.0, 1.5)).hide_viewport = True
    assert captured(tmp_path, subject=subject.name).min() < 0.9
    with pytest.warns(RsibrWarning, match="is black"):
        captured(tmp_path)  # from inside the box


def test_what_stands_within_the_subjects_bounding_box_is_seen(tmp_path: Path) -> None:
    add_world(1.0)
    subject = add_box(POINT)
    # Two pieces, far apart, and a small thing between them and beside the middle
    subject.data.transform(Matrix.Scale(0.2, 4))
    for vertex in subject.data.vertices:
        vertex.co += Vector((4.0 if vertex.co.x > 0.0 else -4.0, 0.0, 0.0))
    add_box((POINT[0] + 1.0, *POINT[1:]), 0.4)
    assert captured(tmp_path, subject=subject.name, point=None).min() < 0.9


def test_the_place_is_the_middle_of_the_subject_at_its_frame_or_the_cursor(
    add_lamp: AddLamp, tmp_path: Path
) -> None:
    add_world(0.1)
    add_lamp("POINT", 40, 70, 5.0, energy=200.0, shadow_soft_size=0.0)
    there = captured(tmp_path)
    bpy.context.scene.cursor.location = POINT
    np.testing.assert_array_equal(captured(tmp_path, point=None), there)
    box = add_box((0.0, 0.0, 0.0))
    box.data.transform(Matrix.Translation((5.0, 0.0, 0.0)))
    for frame, x in ((1, 0.0), (10, POINT[0] - 5.0)):
        box.location = (x, *POINT[1:])
        box.keyframe_insert("location", frame=frame)
    bpy.context.scene.frame_set(1)
    at_frame = captured(tmp_path, subject=box.name, point=None, frame=10)
    np.testing.assert_allclose(at_frame, there, rtol=1e-5)
    assert not np.allclose(captured(tmp_path, subject=box.name, point=None), there, rtol=0.1)


def test_only_what_is_rendered_counts(tmp_path: Path) -> None:
    scene = bpy.context.scene
    add_world(1.0)
    box = add_box((5.0, -2.0, 1.5))
    open_sky = captured(tmp_path, subject=box.name)
    away = bpy.data.collections.new("away")
    scene.collection.children.link(away)
    scene.collection.objects.unlink(box)
    away.objects.link(box)
    layer = bpy.context.view_layer.layer_collection.children["away"]
    shown = captured(tmp_path)
    assert not np.array_equal(shown, open_sky)
    for owner, setting in ((box, "hide_render"), (away, "hide_render"), (layer, "exclude")):
        setattr(owner, setting, True)
        np.testing.assert_array_equal(captured(tmp_path), open_sky)
        setattr(owner, setting, False)
    for setting in ("holdout", "indirect_only"):  # made for pictures, not for light
        setattr(layer, setting, True)
        np.testing.assert_array_equal(captured(tmp_path), shown)
        setattr(layer, setting, False)


def test_what_was_set_for_pictures_does_not_count(add_lamp: AddLamp, tmp_path: Path) -> None:
    add_world(1.0)
    add_box((5.0, -2.0, 1.5))
    add_lamp("POINT", 40, 70, 5.0, energy=200.0, shadow_soft_size=0.0)
    plain = captured(tmp_path)
    scene = bpy.context.scene
    scene.render.film_transparent = scene.render.use_border = scene.render.use_crop_to_border = True
    scene.render.border_max_x = scene.render.border_max_y = 0.5
    scene.render.pixel_aspect_x, scene.render.resolution_percentage = 2.0, 10
    scene.cycles.film_exposure, scene.cycles.sample_clamp_indirect = 3.0, 0.01
    scene.cycles.use_sample_subset, scene.cycles.sample_offset = True, 7
    scene.view_layers[0].name, scene.view_layers[0].use_sky = "a.layer", False
    scene.view_layers.new("another")
    np.testing.assert_array_equal(captured(tmp_path), plain)


def test_denoising_keeps_lamps_and_makes_light_smoother(add_lamp: AddLamp, tmp_path: Path) -> None:
    add_lamp("POINT", 60, 70, 4.0, energy=200.0, shadow_soft_size=0.0)
    add_lamp("AREA", 50, 10, 3.0, energy=100.0, size=2.0)
    add_box((3.0, -2.0, -1.0), 2.0)
    for faces in (False, True):
        noisy, clean = (
            captured(tmp_path, samples=4, faces=faces, denoise=denoise) for denoise in (False, True)
        )
        assert clean[60, 70, 1] == pytest.approx(noisy[60, 70, 1], rel=1e-6)
        below = slice(0, SIZE // 8)
        assert (
            np.abs(np.diff(clean[below], axis=1)).mean() < 0.7 * np.abs(np.diff(noisy[below], axis=1)).mean()
        )
        assert clean.min() >= 0.0


def test_nothing_stays_when_it_is_interrupted(add_lamp: AddLamp, tmp_path: Path) -> None:
    add_lamp("POINT", 60, 70, 4.0, energy=200.0)
    bpy.context.view_layer.update()
    before = open_file_state()
    steps = illuminate_from_scene(SceneLight(size=SIZE, samples=16), tmp_path / "light.exr")
    for _ in range(3):
        assert next(steps).total == 3
        assert open_file_state() == before
    steps.close()
    assert open_file_state() == before
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    ("settings", "error", "words"),
    [
        ({"size": 7}, RangeError, "Size cannot be 7 texels: choose 8 to 16384"),
        ({"size": 32768}, RangeError, "Size cannot be 32768 texels"),
        ({"samples": 0}, RangeError, "Samples cannot be 0: choose 1 to"),
        ({"seed": -1}, RangeError, "Seed cannot be -1: choose 0 to"),
        ({"scene": "Studio"}, SceneError, "This file holds no scene Studio: choose one of Scene"),
        ({"subject": "Car"}, SceneError, "Scene Scene holds no object Car"),
    ],
)
def test_bad_input_is_said(
    settings: dict[str, Any], error: type[Exception], words: str, tmp_path: Path
) -> None:
    add_box(POINT)
    bpy.context.view_layer.update()
    before = open_file_state()
    with pytest.raises(error, match=words):
        captured(tmp_path, **settings)
    assert open_file_state() == before
    assert list(tmp_path.iterdir()) == []


def test_an_empty_scene_is_refused(tmp_path: Path) -> None:
    with pytest.raises(SceneError, match="There is nothing to see in scene Scene: add a world"):
        captured(tmp_path)


def test_particles_are_computed_anew_after_a_copy_of_their_scene(tmp_path: Path) -> None:
    # Blender keeps particles of both in one memory, and now and then leaves none alive there
    add_world(1.0)
    swarm, still = add_box((3.0, 0.0, 0.0)), add_box((-3.0, 0.0, 0.0))
    swarm.modifiers.new("Particles", "PARTICLE_SYSTEM")
    computed: list[str] = []

    def note(scene: bpy.types.Scene, depsgraph: bpy.types.Depsgraph) -> None:
        computed.extend(each.id.name for each in depsgraph.updates if each.is_updated_geometry)

    captured(tmp_path, subject=swarm.name)
    bpy.app.handlers.depsgraph_update_post.append(note)
    try:
        bpy.context.view_layer.update()
    finally:
        bpy.app.handlers.depsgraph_update_post.remove(note)
    assert swarm.name in computed
    assert still.name not in computed


def test_an_existing_file_is_kept(tmp_path: Path) -> None:
    path = tmp_path / "light.exr"
    path.write_text("precious")
    with pytest.raises(OutputFileError, match=r"light\.exr exists: "):
        drain(illuminate_from_scene(SceneLight(), path))
    assert path.read_text() == "precious"
