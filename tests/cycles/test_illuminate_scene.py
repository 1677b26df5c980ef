"""Light around a point of a scene: as much of it as Cycles itself brings to a white surface there."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import bpy
import numpy as np
import pytest
from mathutils import Matrix, Vector
from rsibr.rsibr_addon.core.conventions import texel_centres
from rsibr.rsibr_addon.core.errors import OutputFileError, RangeError, RsibrWarning, SceneError
from rsibr.rsibr_addon.core.maps import equirect
from rsibr.rsibr_addon.core.progress import drain
from rsibr.rsibr_addon.files.radiance_pictures import read_radiance
from rsibr.rsibr_addon.host.rendering import configure_cycles, render_passes
from rsibr.rsibr_addon.host.scenes import temporary_copy
from rsibr.rsibr_addon.settings.environment import SceneLight
from rsibr.rsibr_addon.tasks.light.scene import illuminate_from_scene
from rsibr.tests.open_file import open_file_state

SIZE = 128
POINT = (3.0, -2.0, 1.5)

AddLamp = Callable[..., bpy.types.Object]


@pytest.fixture
def add_lamp() -> AddLamp:
    """Add a lamp at a distance from `POINT` in the direction of a texel's centre, and aim it there.

    So no cosine changes when its light is moved to the centre of the texel.
    """

    def add(kind: str, row: int, column: int, distance: float = 3.0, **settings: Any) -> bpy.types.Object:
        data = bpy.data.lights.new(kind, kind)
        for name, value in settings.items():
            setattr(data, name, value)
        item = bpy.data.objects.new(kind, data)
        towards = Vector(texel_direction(row, column))
        item.location = Vector(POINT) + distance * towards
        item.rotation_euler = towards.to_track_quat("Z", "Y").to_euler()
        bpy.context.scene.collection.objects.link(item)
        return item

    return add


@pytest.fixture(autouse=True)
def _empty_scene(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("rsibr.rsibr_addon.tasks.light.scene.PANORAMA_STEPS", 2)
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.context.scene.cycles.max_bounces = bpy.context.scene.cycles.diffuse_bounces = 2


def texel_direction(row: int, column: int) -> np.ndarray:
    return equirect.direction_from_uv(np.array([(column + 0.5) / SIZE, (row + 0.5) / (SIZE // 2)]))


def add_box(location: tuple[float, float, float], size: float = 1.0) -> bpy.types.Object:
    bpy.ops.mesh.primitive_cube_add(size=size, location=location)
    box = bpy.context.object
    box.data.materials.append(bpy.data.materials.new("grey"))
    return box


def add_world(strength: float) -> None:
    bpy.context.scene.world = bpy.data.worlds.new("sky")
    background = bpy.context.scene.world.node_tree.nodes["Background"]
    background.inputs["Color"].default_value = (strength, strength, strength, 1.0)


def captured(tmp_path: Path, **settings: Any) -> np.ndarray:
    """The map, shape (SIZE / 2, SIZE, 3), after a look at what is left behind."""
    bpy.context.view_layer.update()
    before = open_file_state()
    given = {"size": SIZE, "samples": 16, "point": POINT, **settings}
    path = drain(illuminate_from_scene(SceneLight(**given), tmp_path / "light.exr", force=True))
    assert open_file_state() == before
    return read_radiance(path)


def irradiance(radiance: np.ndarray, normal: np.ndarray) -> float:
    """What a map brings to a surface, in green."""
    height, width = radiance.shape[:2]
    cosine = equirect.direction_from_uv(texel_centres(width, height)) @ normal
    weight = equirect.texel_solid_angle(width, height) * np.maximum(cosine, 0.0)
    return float(np.sum(weight * radiance[..., 1]))


def irradiance_in_cycles(normal: np.ndarray) -> float:
    """What Cycles brings to a small white surface at `POINT`, by one bounce more, in green."""
    with temporary_copy(bpy.context.scene) as scene:
        bounces = scene.cycles.max_bounces
        mesh = bpy.data.meshes.new("probe")
        side = 1e-3
        mesh.from_pydata(
            [(-side, -side, 0), (side, -side, 0), (side, side, 0), (-side, side, 0)], [], [(0, 1, 2, 3)]
        )
        white = bpy.data.materials.new("white")
        white.node_tree.nodes.clear()
        diffuse = white.node_tree.nodes.new("ShaderNodeBsdfDiffuse")
        diffuse.inputs["Color"].default_value = (1.0, 1.0, 1.0, 1.0)
        output = white.node_tree.nodes.new("ShaderNodeOutputMaterial")
        white.node_tree.links.new(diffuse.outputs[0], output.inputs["Surface"])
        mesh.materials.append(white)
        rotation = Vector(normal).to_track_quat("Z", "Y")
        camera = bpy.data.cameras.new("probe")
        camera.type, camera.ortho_scale, camera.clip_start = "ORTHO", side, 1e-4
        for data, height in ((mesh, 0.0), (camera, 2e-3)):
            item = bpy.data.objects.new("probe", data)
            item.location = Vector(POINT) + height * Vector(normal)
            item.rotation_euler = rotation.to_euler()
            # It must not shade what it looks at
            item.visible_diffuse = item.visible_shadow = item.visible_transmission = False
            scene.collection.objects.link(item)
        scene.camera = item
        configure_cycles(scene, 8, 8, 1024)
        scene.cycles.max_bounces = scene.cycles.diffuse_bounces = bounces + 1
        scene.cycles.sample_clamp_indirect = 0.0
        return float(np.pi * render_passes(scene)["Combined"][..., 1].mean())


def assert_equal_light(radiance: np.ndarray, tolerance: float) -> None:
    for normal in ((0.0, 0.0, 1.0), (0.6, 0.0, -0.8), (-0.48, -0.64, 0.6)):
        expected = irradiance_in_cycles(np.array(normal))
        assert irradiance(radiance, np.array(normal)) == pytest.approx(expected, rel=tolerance, abs=tolerance)


LAMPS: dict[str, dict[str, Any]] = {
    "point": {"kind": "POINT", "energy": 200.0, "shadow_soft_size": 0.0},
    "ball": {"kind": "POINT", "energy": 200.0, "shadow_soft_size": 0.02},
    "large ball": {"kind": "POINT", "energy": 200.0, "shadow_soft_size": 0.8},
    "sun": {"kind": "SUN", "energy": 2.0, "angle": 0.009},
    "wide sun": {"kind": "SUN", "energy": 2.0, "angle": 0.6},
    "spot": {"kind": "SPOT", "energy": 200.0, "shadow_soft_size": 0.0, "spot_size": 0.6},
    "small area": {"kind": "AREA", "energy": 20.0, "size": 0.03},
    "area": {"kind": "AREA", "energy": 20.0, "size": 1.5, "shape": "DISK"},
}


@pytest.mark.parametrize("name", LAMPS)
def test_a_lamp_brings_as_much_light_as_in_cycles(name: str, add_lamp: AddLamp, tmp_path: Path) -> None:
    add_lamp(row=45, column=70, **LAMPS[name])
    # Rays find a lamp of 10 texels or more, whose rim is a seventh of them or less, with 16 samples a texel:
    # the rim is known to 1 / 16 at worst, the whole to a hundredth.
    assert_equal_light(captured(tmp_path), 0.01)


@pytest.mark.parametrize("faces", [False, True])
@pytest.mark.parametrize("radius", [0.12, 0.135])
def test_a_large_lamp_overhead_is_not_larger(
    radius: float, faces: bool, add_lamp: AddLamp, tmp_path: Path
) -> None:
    add_lamp("POINT", 0, 0, 0.0, energy=1.0, shadow_soft_size=radius).location = (
        POINT[0],
        POINT[1],
        POINT[2] + 1.0,
    )
    radiance = captured(tmp_path, faces=faces, samples=64)[..., 0]
    fluence = np.sum(equirect.texel_solid_angle(SIZE, SIZE // 2) * radiance)
    # The solid angle of a disk at distance 1 times the radiance of a ball of 1 W, as Cycles has it. Of four
    # rows for each texel the one that the rim lies in counts for up to a quarter of its width wrongly.
    expected = 2.0 * np.pi * (1.0 - 1.0 / np.sqrt(1.0 + radius**2)) / (4.0 * np.pi**2 * radius**2)
    assert fluence == pytest.approx(expected, rel=0.01)


def test_all_the_light_of_a_room_arrives(add_lamp: AddLamp, tmp_path: Path) -> None:
    add_world(0.3)
    add_box((3.0, -2.0, -1.0), 2.0)
    add_box((0.0, -2.0, 1.5))
    for column, settings in enumerate(LAMPS.values()):
        add_lamp(row=30 + 3 * column, column=5 + 16 * column, distance=4.0, **settings)
    for faces in (False, True):
        # As above, and noise of light that comes from the boxes: less than a tenth of all, known to 5 %
        assert_equal_light(captured(tmp_path, samples=32, faces=faces), 0.015)


def test_a_lamp_behind_something_adds_nothing(add_lamp: AddLamp, tmp_path: Path) -> None:
    bpy.context.scene.cycles.max_bounces = 0
    add_lamp("POINT", 40, 70, 6.0, energy=200.0, shadow_soft_size=0.0)
    lit = captured(tmp_path)
    add_box(tuple(np.array(POINT) + 2.0 * texel_direction(40, 70)))
    assert lit.max() > 0.0
    with pytest.warns(RsibrWarning, match=r"No light arrives there, so .*light\.exr is black"):
        assert captured(tmp_path).max() == 0.0


def test_point_lamps_are_energy_over_distance_squared(add_lamp: AddLamp, tmp_path: Path) -> None:
    add_lamp("POINT", 40, 70, 5.0, energy=200.0, shadow_soft_size=0.0)
    radiance = captured(tmp_path)
    solid_angle = equirect.texel_solid_angle(SIZE, SIZE // 2)
    expected = np.zeros_like(radiance)
    # P / 4 pi over distance squared; what the probe's radius of 5e-4 makes of 5 is 1e-4
    expected[40, 70] = 200.0 / (4.0 * np.pi * 5.0**2) / solid_angle[40, 70]
    np.testing.assert_allclose(radiance, expected, rtol=1e-3)


def test_a_lamp_counts_as_it_lights_surfaces_not_as_the_camera_sees_it(
    add_lamp: AddLamp, tmp_path: Path
) -> None:
    for size in (0.0, 1.0):
        lamp = add_lamp("POINT", 40, 70, 5.0, energy=200.0, shadow_soft_size=size)
        lamp.visible_camera = lamp.visible_transmission = False
        lamp.data.cycles.use_multiple_importance_sampling = False
        seen = captured(tmp_path).sum()
        lamp.visible_camera = lamp.visible_transmission = True
        lamp.data.cycles.use_multiple_importance_sampling = True
        assert captured(tmp_path).sum() == seen > 0.0
        lamp.visible_diffuse = False
        with pytest.warns(RsibrWarning, match="No light arrives"):
            captured(tmp_path)
        bpy.data.objects.remove(lamp)


def test_a_lamps_nodes_and_its_frame_count(add_lamp: AddLamp, tmp_path: Path) -> None:
    lamp = add_lamp("POINT", 40, 70, 5.0, energy=200.0, shadow_soft_size=0.0).data
    plain = captured(tmp_path)[40, 70]
    emission = lamp.node_tree.nodes["Emission"]
    emission.inputs["Color"].default_value = (1.0, 0.5, 0.25, 1.0)
    emission.inputs["Strength"].default_value = 2.0
    np.testing.assert_allclose(captured(tmp_path)[40, 70], plain * (2.0, 1.0, 0.5), rtol=1e-4)
    for frame, energy in ((1, 200.0), (10, 600.0)):
        lamp.energy = energy
        lamp.keyframe_insert("energy", frame=frame)
    bpy.context.scene.frame_set(1)
    np.testing.assert_allclose(captured(tmp_path, frame=10)[40, 70], plain * (6.0, 3.0, 1.5), rtol=1e-4)


@pytest.mark.parametrize("size", [0.0, 1.0])
def test_lamps_that_light_chosen_objects_count_if_they_light_the_subject(
    size: float, add_lamp: AddLamp, tmp_path: Path
) -> None:
    lamp = add_lamp("POINT", 40, 70, 5.0, energy=200.0, shadow_soft_size=size)
    subject, other = add_box(POINT), add_box((9.0, 9.0, 9.0))
    lit = captured(tmp_path, subject=subject.name)
    chosen = bpy.data.collections.new("chosen")
    lamp.light_linking.receiver_collection = chosen
    for item, state, counts in (
        (other, "INCLUDE", False),
        (other, "EXCLUDE", True),
        (subject, "INCLUDE", True),
        (subject, "EXCLUDE", False),
    ):
        chosen.objects.link(item)
        chosen.collection_objects[0].light_linking.link_state = state
        seen = captured(tmp_path, subject=subject.name)[40, 70]
        np.testing.assert_array_equal(seen, lit[40, 70] if counts else 0.0)
        chosen.objects.unlink(item)
    group = bpy.data.collections.new("group")
    group.objects.link(subject)
    chosen.children.link(group)
    np.testing.assert_array_equal(captured(tmp_path, subject=subject.name)[40, 70], lit[40, 70])


def test_instances_of_lamps_count_each(add_lamp: AddLamp, tmp_path: Path) -> None:
    for size in (0.0, 0.8):
        lamp = add_lamp("POINT", 40, 70, 3.0, energy=200.0, shadow_soft_size=size)
        once = captured(tmp_path)
        holder = bpy.data.collections.new("holder")
        bpy.context.scene.collection.objects.unlink(lamp)
        holder.objects.link(lamp)
        for height in (0.0, 1e-3):  # too close to tell apart
            instancer = bpy.data.objects.new("instancer", None)
            instancer.location.z = height
            instancer.instance_type, instancer.instance_collection = "COLLECTION", holder
            bpy.context.scene.collection.objects.link(instancer)
        twice = captured(tmp_path)
        if size == 0.0:
            np.testing.assert_allclose(twice, 2.0 * once, rtol=2e-3)
        else:  # they overlap, but each is transparent to the other: Cycles adds up what a ray meets
            assert twice.sum() == pytest.approx(2.0 * once.sum(), rel=0.02)
        for item in list(bpy.data.objects):
            bpy.data.objects.remove(item)


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


def test_a_point_without_size_at_the_place_itself_is_left_out(add_lamp: AddLamp, tmp_path: Path) -> None:
    add_world(1.0)
    add_lamp("POINT", 60, 70, 0.0, energy=200.0, shadow_soft_size=0.0)
    np.testing.assert_allclose(captured(tmp_path), 1.0, rtol=1e-5)


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


def test_an_existing_file_is_kept(tmp_path: Path) -> None:
    path = tmp_path / "light.exr"
    path.write_text("precious")
    with pytest.raises(OutputFileError, match=r"light\.exr exists: "):
        drain(illuminate_from_scene(SceneLight(), path))
    assert path.read_text() == "precious"
