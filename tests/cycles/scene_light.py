"""Light around a point of a scene, as it is captured and as Cycles brings it to a white surface."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import bpy
import numpy as np
import pytest
from mathutils import Vector
from rsibr.rsibr_addon.core.conventions import texel_centres
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
