"""Both sides of surfaces beside Cycles: smooth and flat, mirrored, and mirrored instances, on the display."""

from collections.abc import Callable
from dataclasses import replace
from functools import cache
from typing import Any

import bpy
import mathutils
import numpy as np
import pytest
from rsibr.rsibr_addon.core.brdf.principled import Surface
from rsibr.rsibr_addon.core.conventions import texel_centres
from rsibr.rsibr_addon.core.environment import Environment
from rsibr.rsibr_addon.core.geometry.camera import Camera
from rsibr.rsibr_addon.core.kinds.environment import EnvironmentLook
from rsibr.rsibr_addon.core.kinds.kernel_pyramid.bake import bake_pyramid
from rsibr.rsibr_addon.core.kinds.reflection_tables.bake import TableSizes, bake_tables
from rsibr.rsibr_addon.core.kinds.reflection_tables.material import material_from_texts
from rsibr.rsibr_addon.core.kinds.reflection_tables.shading import TablesLook
from rsibr.rsibr_addon.core.maps import equirect
from rsibr.rsibr_addon.core.metrics import unpremultiplied
from rsibr.rsibr_addon.core.progress import drain
from rsibr.rsibr_addon.device.kinds.environment import GpuEnvironment
from rsibr.rsibr_addon.device.kinds.kernel_pyramid import GpuPyramid
from rsibr.rsibr_addon.device.kinds.reflection_tables import GpuReflectionTables
from rsibr.rsibr_addon.files.brdfs import read_measured
from rsibr.rsibr_addon.files.kinds.kernel_pyramid import shipped_families
from rsibr.rsibr_addon.host.cameras import add_camera
from rsibr.rsibr_addon.host.cycles import RenderSettings, render_view
from rsibr.rsibr_addon.host.display import displayed_colours
from rsibr.rsibr_addon.host.meshes import TriangleMesh, add_mesh
from rsibr.rsibr_addon.host.scenes import temporary_scene
from rsibr.rsibr_addon.host.worlds import light_with
from rsibr.tests.placed_drawing import MIRRORING, drawn, flat, inside_out, leaf, shell
from rsibr.tests.synthetic_views import environment_radiance

pytestmark = [pytest.mark.needs("cycles"), pytest.mark.needs("gl")]

SIZE, SAMPLES = 48, 512
CAMERA = Camera((0.5, -0.7, 0.6), 0.8)

STRETCHED = np.array(
    [[-0.64, -0.6, 0.0, 0.0], [-0.48, 0.8, 0.0, 0.05], [0.0, 0.0, 1.1, 0.0], [0.0, 0.0, 0.0, 1.0]]
)
"""A turn of a place whose scale is negative along one axis, and another along each."""

SURFACES: dict[str, tuple[Callable[[], TriangleMesh], np.ndarray, bool]] = {
    "shell": (shell, np.eye(4), False),
    "leaf": (leaf, np.eye(4), False),
    "leaf from behind": (lambda: inside_out(leaf()), np.eye(4), False),
    "flat leaf": (lambda: flat(leaf()), np.eye(4), False),
    "negative scale": (leaf, STRETCHED, False),
    "mirrored instance": (leaf, STRETCHED, True),
    "mirrored shell": (shell, MIRRORING, True),
}
"""Name -> the mesh, its place, and whether a second object has the mesh, so that Cycles keeps it as it is."""


@cache
def light() -> Environment:
    """Light that changes slowly."""
    directions = equirect.direction_from_uv(texel_centres(256, 128))
    return Environment((0.4 * environment_radiance(directions)).astype(np.float32), "smooth")


@cache
def white() -> GpuReflectionTables:
    """A white Lambert surface, at every angle alike."""
    made = material_from_texts({"diffuse": "lambert:kd=1"}, read_measured)
    tables = drain(bake_tables(light().radiance, made, TableSizes())).tables
    return GpuReflectionTables(replace(tables, weights=np.ones_like(tables.weights)))


@cache
def pyramid() -> GpuPyramid:
    return GpuPyramid(drain(bake_pyramid(light().radiance, 128)).pyramid, shipped_families())


def material(kind: str, **values: Any) -> bpy.types.Material:
    made = bpy.data.materials.new(kind)
    nodes = made.node_tree.nodes
    nodes.clear()
    surface, output = nodes.new(f"ShaderNodeBsdf{kind}"), nodes.new("ShaderNodeOutputMaterial")
    made.node_tree.links.new(surface.outputs["BSDF"], output.inputs["Surface"])
    for name, value in values.items():
        surface.inputs[name].default_value = value
    return made


WHITE = (1.0, 1.0, 1.0, 1.0)
KINDS: dict[str, tuple[Callable[[], bpy.types.Material], Callable[[], Any], Any]] = {
    "mirror": (
        lambda: material("Glossy", Color=WHITE, Roughness=0.0),
        lambda: GpuEnvironment(light()),
        EnvironmentLook(antialiased=False),
    ),
    "diffuse": (lambda: material("Diffuse", Color=WHITE), white, TablesLook()),
    "principled": (
        lambda: material("Principled", **{"Base Color": (0.8, 0.3, 0.1, 1.0), "Roughness": 0.4}),
        pyramid,
        Surface(base_color=(0.8, 0.3, 0.1), roughness=0.4),
    ),
}
"""Name -> the material in Cycles, what is drawn, and its look."""


def shown(pictures: list[np.ndarray], transform: str) -> list[np.ndarray]:
    """Colours on the display, in steps of 255."""
    with temporary_scene() as scene:
        scene.view_settings.view_transform = transform
        return [255.0 * displayed_colours(scene, unpremultiplied(picture)) for picture in pictures]


def rendered(kind: str, mesh: TriangleMesh, model: np.ndarray, shared: bool) -> np.ndarray:
    """Radiance times coverage, and coverage, by Cycles; the surface hides no light from itself."""
    with temporary_scene() as scene:
        light_with(scene, light())
        made = KINDS[kind][0]()
        item = add_mesh(scene, mesh, made)
        item.matrix_world = mathutils.Matrix(model.tolist())
        item.visible_diffuse = item.visible_glossy = item.visible_transmission = item.visible_shadow = False
        if shared:
            other = bpy.data.objects.new("other", item.data)
            other.location = (0.0, 0.0, 1e3)
            scene.collection.objects.link(other)
        add_camera(scene, CAMERA)
        return render_view(scene, RenderSettings(SIZE, SAMPLES)).rgba


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("name", SURFACES)
def test_both_sides_are_those_of_cycles(name: str, kind: str) -> None:
    make, model, shared = SURFACES[name]
    _, content, look = KINDS[kind]
    reference = rendered(kind, make(), model, shared)
    ours = drawn(content(), make(), model, CAMERA, SIZE, look)
    covered = np.minimum(ours[..., 3], reference[..., 3]) > 0.999
    assert np.count_nonzero(covered) > 0.08 * SIZE**2
    for transform in ("Standard", "AgX"):
        first, second = shown([ours, reference], transform)
        apart = np.abs(first - second).max(axis=-1)[covered]
        # Noise, and errors of lobes' fits, are within a third of that
        assert np.median(apart) < 1.0
        assert np.std(second[covered]) > 5.0
