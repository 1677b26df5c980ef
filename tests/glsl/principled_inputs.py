"""A pyramid of light, and random inputs of Principled materials, for tests of shaders."""

from functools import cache

import numpy as np
from rsibr.rsibr_addon.core.brdf.principled import Surface
from rsibr.rsibr_addon.core.conventions import texel_centres
from rsibr.rsibr_addon.core.kinds.kernel_pyramid.bake import bake_pyramid
from rsibr.rsibr_addon.core.kinds.kernel_pyramid.pyramid import Pyramid
from rsibr.rsibr_addon.core.kinds.kernel_pyramid.shading import Families
from rsibr.rsibr_addon.core.lobes.family import KERNELS
from rsibr.rsibr_addon.core.maps import equirect
from rsibr.rsibr_addon.core.progress import drain
from rsibr.rsibr_addon.device.kinds.kernel_pyramid import SAMPLERS, GpuPyramid
from rsibr.rsibr_addon.files.kinds.kernel_pyramid import shipped_families
from rsibr.rsibr_addon.settings.kernel_pyramid import KernelPyramidSettings
from rsibr.tests.glsl.evaluation import Samplers
from rsibr.tests.glsl.twins import COUNT, single

KERNEL_COUNT = len(KERNELS)

SIZE = KernelPyramidSettings().size


@cache
def families() -> Families:
    return shipped_families()


@cache
def pyramid() -> Pyramid:
    """A dim sky over a red floor, with a window whose light is 60 times as bright."""
    texels = equirect.direction_from_uv(texel_centres(128, 64))
    light = np.where(texels[..., 2:] > 0.0, [0.3, 0.4, 0.6], [0.3, 0.1, 0.05])
    window = np.exp(40.0 * (texels @ [0.6, 0.48, 0.64] - 1.0))
    return drain(bake_pyramid(light + 20.0 * window[..., None] * [1.0, 0.9, 0.7], SIZE)).pyramid


def samplers_of(light: Pyramid) -> Samplers:
    textures = GpuPyramid(light, families()).textures
    return {
        name: (kind, texture.whole())
        for (name, kind), texture in zip(SAMPLERS.items(), textures, strict=True)
    }


def samplers() -> Samplers:
    return samplers_of(pyramid())


def numbers(seed: int, low: float = 0.0, high: float = 1.0, columns: int = 1) -> np.ndarray:
    return single(np.random.default_rng(seed).uniform(low, high, (COUNT, columns)))


def often_zero(seed: int) -> np.ndarray:
    """Half of the numbers are 0."""
    values = numbers(seed)
    values[::2] = 0.0
    return values


def surface_arguments() -> list[np.ndarray]:
    """Random inputs of materials, each argument four numbers wide."""
    return [
        np.hstack([numbers(1, columns=3), often_zero(2)]),
        np.hstack([numbers(3, columns=3), numbers(4, 0.0, 2.0)]),
        np.hstack([numbers(5, columns=3), np.roll(often_zero(6), 1, axis=0)]),
        np.hstack([numbers(7, columns=3), numbers(8)]),
        np.hstack([numbers(9), numbers(10, 1.0, 3.0), np.roll(often_zero(11), COUNT // 2, axis=0)]),
        np.hstack([numbers(12), numbers(13, 1.0, 3.0), np.roll(often_zero(60), 2, axis=0), numbers(61)]),
        numbers(62, columns=3),
    ]


def surface_of(*arguments: np.ndarray) -> Surface:
    base, specular, coat, emission, boundary, coating, sheen_tint = arguments
    return Surface(
        base_color=base[:, :3],
        metallic=base[:, 3],
        roughness=boundary[:, 0],
        ior=boundary[:, 1],
        alpha=emission[:, 3],
        diffuse_roughness=boundary[:, 2],
        specular_level=specular[:, 3],
        specular_tint=specular[:, :3],
        coat_weight=coat[:, 3],
        coat_roughness=coating[:, 0],
        coat_ior=coating[:, 1],
        coat_tint=coat[:, :3],
        sheen_weight=coating[:, 2],
        sheen_roughness=coating[:, 3],
        sheen_tint=sheen_tint[:, :3],
        emission=emission[:, :3],
    )


SURFACE = """
Surface surface = Surface(in_0.rgb, in_0.a, in_4.x, in_4.y, in_3.a, in_4.z, in_1.a, in_1.rgb, in_2.a, in_5.x,
                          in_5.y, in_2.rgb, in_5.z, in_5.w, in_6.rgb, in_3.rgb);
"""
