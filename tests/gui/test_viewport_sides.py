"""Previews in Blender's window shade both sides of a surface alike, mirrored objects and instances too."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
from rsibr.tests.mirror_capture import radiance_from, write_mirror_capture

SCENARIO = """
def scenario(told):
    bare(view())
    bpy.context.scene.view_settings.view_transform = "Standard"
    bpy.data.objects.remove(bpy.data.objects["Cube"])
    space = view().spaces.active
    space.region_3d.view_perspective = "ORTHO"
    space.region_3d.view_rotation = (1.0, 0.0, 0.0, 0.0)
    mesh = bpy.data.meshes.new("sheet")
    mesh.from_pydata([(-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0)], [], [(0, 1, 2, 3)])
    sheet = bpy.data.objects.new("sheet", mesh)
    bpy.context.collection.objects.link(sheet)
    sheet.rotation_euler = (0.3, 0.2, 0.0)
    sheet.rsibr.map_set = "/job/sides.rsibr.exr"

    def shown(name):
        yield from drawn()
        told[name] = np.median(
            pixels()[pixels().shape[0] // 2 - 10:][:20, pixels().shape[1] // 2 - 10:][:, :20], axis=(0, 1)
        ).tolist()

    yield from shown("front")
    mesh.flip_normals()
    yield from shown("back")
    sheet.scale = (-1.0, 1.0, 1.0)
    yield from shown("mirrored back")
    mesh.flip_normals()
    yield from shown("mirrored front")
    collection = bpy.data.collections.new("sheets")
    bpy.context.collection.objects.unlink(sheet)
    collection.objects.link(sheet)
    instance = bpy.data.objects.new("instance", None)
    instance.instance_type, instance.instance_collection = "COLLECTION", collection
    bpy.context.collection.objects.link(instance)
    sheet.scale, instance.scale = (1.0, 1.0, 1.0), (1.0, 1.0, -1.0)
    sheet.rotation_euler = (-0.3, -0.2, 0.0)
    yield from shown("mirrored instance")
"""


def test_both_sides(told: Callable[[str], dict], job: Path) -> None:
    write_mirror_capture(job / "sides.rsibr.exr", view_count=42)
    answer = told(SCENARIO)
    assert set(answer) == {"front", "back", "mirrored back", "mirrored front", "mirrored instance"}
    # Seen from above, the sheet's normal is that of its turn about x, then about y
    x, y = 0.3, 0.2
    normal = np.array([np.sin(y) * np.cos(x), -np.sin(x), np.cos(y) * np.cos(x)])
    mirror_dir = 2.0 * normal[2] * normal - (0.0, 0.0, 1.0)
    linear = np.clip(radiance_from(mirror_dir), 0.0, 1.0)
    expected = 255.0 * np.where(linear < 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)
    for name, colour in answer.items():
        # Half a percent of interpolation, and drivers' encoding: see `in_window.like`
        assert np.abs(np.array(colour) - expected).max() < 6.0, name
