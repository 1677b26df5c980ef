"""Antialiased highlights of materials: against the mean of 64 samples of each pixel."""

from dataclasses import replace

import bpy
import gpu
import numpy as np
import pytest
from rsibr.rsibr_addon.core.conventions import texel_centres
from rsibr.rsibr_addon.core.kinds.kernel_pyramid.bake import bake_pyramid
from rsibr.rsibr_addon.core.kinds.kernel_pyramid.look import PrincipledLook
from rsibr.rsibr_addon.core.maps import equirect
from rsibr.rsibr_addon.core.materials.packing import CHANNELS
from rsibr.rsibr_addon.core.materials.principled import Input, NormalMap, PrincipledInputs, Texture
from rsibr.rsibr_addon.core.materials.stand_ins import PLAIN
from rsibr.rsibr_addon.core.progress import drain
from rsibr.rsibr_addon.device import buffers
from rsibr.rsibr_addon.device.context import ensure_context
from rsibr.rsibr_addon.device.drawing import Draw, GpuMesh
from rsibr.rsibr_addon.device.kinds.kernel_pyramid import GpuPyramid
from rsibr.rsibr_addon.device.own_materials import DrawnMaterial, OwnMaterials
from rsibr.rsibr_addon.device.textured_mesh import GpuTexturedMesh
from rsibr.tests.glsl.principled_inputs import families
from rsibr.tests.glsl.test_preview_renderer import fine_sphere
from rsibr.tests.glsl.test_textured_materials import constants
from rsibr.tests.placed_drawing import depth_tested

SAMPLES = 8
"""Along each axis of a pixel."""

FROM_ABOVE = Draw(np.eye(4), np.eye(4), np.diag([1.0, 1.0, -0.4, 1.0]), np.array([0.0, 0.0, 1.0, 0.0]))


@pytest.fixture(scope="module")
def content() -> GpuPyramid:
    """Under a dim sky with eight lamps, 2 to 6 degrees wide."""
    ensure_context()
    texels = equirect.direction_from_uv(texel_centres(256, 128))
    light = np.full((128, 256, 3), 0.2)
    for number, lamp in enumerate(np.random.default_rng(1).normal(size=(8, 3))):
        towards = texels @ (lamp / np.linalg.norm(lamp))
        light += 10.0 * np.exp((3000.0 if number % 2 else 300.0) * (towards - 1.0))[..., None]
    return GpuPyramid(drain(bake_pyramid(light, 512)).pyramid, families())


def drawn(content: GpuPyramid, mesh: GpuMesh, look: object, size: int) -> np.ndarray:
    with depth_tested(size) as target:
        content.draw(mesh, FROM_ABOVE, look)
        return buffers.pixels(target, size)[..., :3]


def means(picture: np.ndarray) -> np.ndarray:
    size = len(picture) // SAMPLES
    return picture.reshape(size, SAMPLES, size, SAMPLES, 3).mean(axis=(1, 3))


def errors(content: GpuPyramid, mesh: GpuMesh, look: object, size: int) -> tuple[float, float, float]:
    """Of the antialiased picture and of the other, over the mean; and the mean of the former over that."""
    place = 2.0 * texel_centres(size, size) - 1.0
    within = np.hypot(place[..., 0], place[..., 1]) < 0.85
    points = replace(look, antialiased=False)
    expected = means(drawn(content, mesh, points, SAMPLES * size))[within]
    shown = [drawn(content, mesh, each, size)[within] for each in (look, points)]
    smooth, rough = (np.sqrt(np.mean((each - expected) ** 2)) / expected.mean() for each in shown)
    return smooth, rough, shown[0].mean() / expected.mean()


def bumpy(bumps: int, texels: int) -> tuple[GpuTexturedMesh, PrincipledInputs, dict]:
    """A sphere with a normal map, seen from above."""
    positions, normals, triangles = fine_sphere(128)
    uv = 0.5 + 0.5 * positions[:, None, :2]
    across = np.array([1.0, 0.0, 0.0]) - normals[:, :1] * normals
    across /= np.maximum(np.linalg.norm(across, axis=-1, keepdims=True), 1e-9)
    tangents = np.concatenate([across, np.ones((len(across), 1))], axis=1)
    mesh = GpuTexturedMesh(
        positions, normals, triangles, np.zeros(len(triangles), int), uv, tangents, ("UVMap",)
    )
    x, y = 2.0 * np.pi * bumps * np.moveaxis(texel_centres(texels, texels), -1, 0)
    slopes = 0.3 * np.stack(
        [np.sin(x) * np.cos(0.7 * y), np.cos(0.6 * x + 1.0) * np.sin(y), np.zeros_like(x)], -1
    )
    leaning = slopes + [0.0, 0.0, 1.0]
    leaning /= np.linalg.norm(leaning, axis=-1, keepdims=True)
    image = bpy.data.images.new("bumps", texels, texels, float_buffer=True)
    image.colorspace_settings.name = "Non-Color"
    image.pixels.foreach_set(buffers.with_alpha(0.5 + 0.5 * leaning).astype(np.float32).ravel())
    image.update()
    image.pack()
    texture = Texture("bumps")
    normal = NormalMap(Input(CHANNELS, texture), constants(1.0))
    inputs = replace(PLAIN, metallic=constants(1.0), roughness=constants(0.22), normal=normal)
    return mesh, inputs, {texture: gpu.texture.from_image(image)}


@pytest.mark.parametrize(("size", "bumps"), [(64, 60), (32, 30), (16, 14)])
def test_bumps_of_pixels_are_as_the_mean_of_their_samples(content: GpuPyramid, size: int, bumps: int) -> None:
    """A sphere near and far, with bumps as wide as a pixel; a sample is a texel wide, and sees no mip."""
    mesh, inputs, textures = bumpy(bumps, SAMPLES * size)
    smooth, rough, energy = errors(content, mesh, OwnMaterials((DrawnMaterial(inputs, textures),)), size)
    assert rough > 0.5
    assert smooth < 0.25 * rough
    assert abs(energy - 1.0) < 0.03


@pytest.mark.parametrize("roughness", [0.0, 0.15])
def test_a_sphere_that_goes_away_is_as_the_mean_of_its_samples(content: GpuPyramid, roughness: float) -> None:
    look = PrincipledLook(metallic=1.0, roughness=roughness)
    mesh = GpuMesh(*fine_sphere(128))
    smooth, rough, energy = np.transpose([errors(content, mesh, look, size) for size in (8, 12, 16, 24)])
    assert np.linalg.norm(smooth) < 0.25 * np.linalg.norm(rough)
    # A dozen pixels are few for lamps of 2 degrees
    assert np.abs(energy - 1.0).max() < 0.06
    assert np.abs(energy - 1.0).mean() < 0.04
