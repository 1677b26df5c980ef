"""Lamps around a point of a scene: as much light as Cycles itself brings to a white surface."""

from pathlib import Path

import bpy
import numpy as np
import pytest
from rsibr.rsibr_addon.core.errors import RsibrWarning
from rsibr.rsibr_addon.core.maps import equirect
from rsibr.tests.cycles.scene_light import (
    LAMPS,
    POINT,
    SIZE,
    AddLamp,
    add_box,
    add_world,
    assert_equal_light,
    captured,
    texel_direction,
)

pytestmark = pytest.mark.usefixtures("empty_scene")


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


def test_a_point_without_size_at_the_place_itself_is_left_out(add_lamp: AddLamp, tmp_path: Path) -> None:
    add_world(1.0)
    add_lamp("POINT", 60, 70, 0.0, energy=200.0, shadow_soft_size=0.0)
    np.testing.assert_allclose(captured(tmp_path), 1.0, rtol=1e-5)
