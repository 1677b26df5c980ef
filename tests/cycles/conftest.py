"""What several tests of light around a point of a scene need."""

from typing import TYPE_CHECKING, Any

import pytest

if TYPE_CHECKING:
    from rsibr.tests.cycles.scene_light import AddLamp


@pytest.fixture
def add_lamp() -> "AddLamp":
    """Add a lamp at a distance from `POINT` in the direction of a texel's centre, and aim it there.

    So no cosine changes when its light is moved to the centre of the texel.
    """
    import bpy
    from mathutils import Vector
    from rsibr.tests.cycles.scene_light import POINT, texel_direction

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


@pytest.fixture
def empty_scene(monkeypatch: pytest.MonkeyPatch) -> None:
    """An empty file, whose light has two bounces; panoramas of it are quick."""
    import bpy

    monkeypatch.setattr("rsibr.rsibr_addon.tasks.light.scene.PANORAMA_STEPS", 2)
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.context.scene.cycles.max_bounces = bpy.context.scene.cycles.diffuse_bounces = 2
