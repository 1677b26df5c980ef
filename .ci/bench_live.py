"""Measure own materials in live light beside the same from a baked pyramid, by numpy, without a GPU.

Faces are an environment's means, as a viewport renders them. Errors are relative root-mean-square errors over
a sphere seen from afar, whose points have equal areas of the picture.
"""

import argparse

import numpy as np
from bench_materials import CLOTH, MATERIALS, uniform
from docs_table import write_table
from rsibr.rsibr_addon.core.brdf.principled import Surface
from rsibr.rsibr_addon.core.conventions import Array
from rsibr.rsibr_addon.core.geometry.camera import Camera
from rsibr.rsibr_addon.core.kinds.kernel_pyramid.bake import EQUIRECT, bake_pyramid
from rsibr.rsibr_addon.core.kinds.kernel_pyramid.live import CUBE, live_pyramid
from rsibr.rsibr_addon.core.kinds.kernel_pyramid.pyramid import Pyramid
from rsibr.rsibr_addon.core.kinds.kernel_pyramid.shading import principled_radiance
from rsibr.rsibr_addon.core.progress import drain
from rsibr.rsibr_addon.core.resample import resample
from rsibr.rsibr_addon.files.kinds.kernel_pyramid import shipped_families
from rsibr.rsibr_addon.settings.kernel_pyramid import KernelPyramidSettings
from rsibr.rsibr_addon.tasks.light.environments import load_environment

SIZES = (32, 64, 128)
ENVIRONMENTS = ("forest", "city")
RINGS, AROUND = 24, 64


def sphere() -> tuple[Array, Array]:
    """Normals and views of points, shapes (N, 3)."""
    frame = Camera((0.0, 0.0, 1.0)).frame
    radius = np.sqrt((np.arange(RINGS) + 0.5) / RINGS)[:, None]
    # Each ring turned against the last, by the golden angle
    turn = 2.0 * np.pi * np.arange(AROUND) / AROUND + 2.4 * np.arange(RINGS)[:, None]
    points = np.broadcast_arrays(radius * np.cos(turn), radius * np.sin(turn), np.sqrt(1.0 - radius**2))
    normal = np.stack(points, axis=-1).reshape(-1, 3) @ frame.T
    return normal, np.broadcast_to(frame[:, 2], normal.shape)


def shown(pyramid: Pyramid, surface: Surface) -> Array:
    """Radiance of those points."""
    return principled_radiance(pyramid, shipped_families(), surface, *sphere())


def rows() -> list[str]:
    """Of each material and environment, the error at each width of a face."""
    materials = {**MATERIALS, "cloth, sheen of roughness .5": {**CLOTH, "sheen_roughness": 0.5}}
    found = []
    for environment in ENVIRONMENTS:
        radiance = load_environment(environment).radiance
        baked = drain(bake_pyramid(radiance, KernelPyramidSettings().size)).pyramid
        faces = [resample(radiance[None], EQUIRECT, CUBE, size, np.float32) for size in SIZES]
        live = [live_pyramid(each) for each in faces]
        for name, inputs in materials.items():
            surface = uniform(inputs, RINGS * AROUND)
            expected = shown(baked, surface)
            wrong = [np.mean((shown(each, surface) - expected) ** 2) for each in live]
            errors = (f"{np.sqrt(each / np.mean(expected**2)):.1%}" for each in wrong)
            found.append(f"| {name} | {environment} | {' | '.join(errors)} |")
    return found


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--write", action="store_true", help="write docs/live-light.md, not only print it")
    header = [f"| material | environment |{''.join(f' {size} pixels |' for size in SIZES)}"]
    arguments = parser.parse_args()
    table = "\n".join([*header, "|---|---|---:|---:|---:|", *rows()])
    print(table)
    if arguments.write:
        write_table("live-light.md", "live", table)
