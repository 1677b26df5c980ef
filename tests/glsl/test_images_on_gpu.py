"""Images of Blender as materials look them up."""

from dataclasses import replace

import bpy
import gpu
import numpy as np
from rsibr.rsibr_addon.core.brdf.principled import Surface
from rsibr.rsibr_addon.core.light.transfer_curve import linear_from_srgb
from rsibr.rsibr_addon.core.materials.packing import CHANNELS
from rsibr.rsibr_addon.core.materials.principled import Input, Texture
from rsibr.rsibr_addon.core.materials.stand_ins import PLAIN
from rsibr.rsibr_addon.device.kinds.kernel_pyramid import GpuPyramid
from rsibr.rsibr_addon.device.own_materials import DrawnMaterial, OwnMaterials
from rsibr.tests.glsl.evaluation import evaluate
from rsibr.tests.glsl.test_textured_materials import assert_shows, content, drawn, square

__all__ = ["content"]


def test_images_of_blender_are_linear_and_have_mips(content: GpuPyramid) -> None:
    """A checker of sRGB bytes, of squares of a texel, 32 in a pixel: its mean is that of linear colours."""
    image = bpy.data.images.new("checker", 2048, 2048)
    values = np.ones((2048, 2048, 4), np.float32)
    values[..., :3] = np.where(np.indices((2048, 2048)).sum(axis=0) % 2, 0.8, 0.2)[..., None]
    image.pixels.foreach_set(values.ravel())
    image.update()
    texture = Texture("checker", extension="EXTEND", closest=True)
    on_gpu = gpu.texture.from_image(image)
    inputs = replace(PLAIN, base_color=Input(CHANNELS, texture))
    picture = drawn(content, square(), OwnMaterials((DrawnMaterial(inputs, {texture: on_gpu}),)))
    # Rounded to bytes of sRGB at each of five mips
    assert_shows(picture, Surface(base_color=np.full(3, linear_from_srgb(np.array([0.2, 0.8])).mean())))


def test_images_of_blender_stay_as_they_were(content: GpuPyramid) -> None:
    """A material lets the last column go on beyond the image; in Blender it begins anew."""
    image = bpy.data.images.new("columns", 8, 8, float_buffer=True)
    values = np.ones((8, 8, 4), np.float32)
    values[..., :3] = np.arange(8)[None, :, None] / 8.0
    image.pixels.foreach_set(values.ravel())
    image.update()
    texture = Texture("columns", extension="EXTEND", closest=True)
    on_gpu = gpu.texture.from_image(image)
    inputs = replace(PLAIN, base_color=Input(CHANNELS, texture))
    drawn(content, square(), OwnMaterials((DrawnMaterial(inputs, {texture: on_gpu}),)))
    on_gpu.anisotropic_filter(False)  # Mesa blurs by it
    beyond = np.array([[1.4, 0.5], [-0.6, 0.5]], np.float32)
    code = "result_0 = textureLod(image, in_0.xy, 0.0); result_1 = textureLod(image, fract(in_0.xy), 0.0);"
    looked_up = evaluate("directions_lib.glsl", code, [beyond], 2, {"image": ("FLOAT_2D", on_gpu)})
    np.testing.assert_allclose(looked_up[:, 0], looked_up[:, 1], atol=1e-3)
    # Between two columns, smoothly
    np.testing.assert_allclose(looked_up[0, 0, 0], 2.7 / 8.0, atol=1e-3)
