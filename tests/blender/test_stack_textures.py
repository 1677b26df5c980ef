"""What is stated of a lobe stack's lookups, in Blender's `city`, against sums over all its texels."""

from pathlib import Path

import numpy as np
import pytest
from rsibr.rsibr_addon.core.conventions import Array, texel_centres
from rsibr.rsibr_addon.core.geometry.directions import camera_frame, dot, normalize
from rsibr.rsibr_addon.core.kinds.lobe_stack.stack import stack_representation
from rsibr.rsibr_addon.core.lobes.bake import bake_stack
from rsibr.rsibr_addon.core.lobes.bank import KernelBank
from rsibr.rsibr_addon.core.lobes.fit import Fit
from rsibr.rsibr_addon.core.maps import equirect
from rsibr.rsibr_addon.core.progress import drain
from rsibr.rsibr_addon.core.resample import bilinear, clamp_to_edge, lookup
from rsibr.rsibr_addon.core.suns import find_suns
from rsibr.rsibr_addon.files.kinds.lobe_stack import from_map_set, in_turn
from rsibr.rsibr_addon.files.map_set import read_map_set, write_map_set
from rsibr.rsibr_addon.files.map_set_header import Origin
from rsibr.rsibr_addon.tasks.export.export import export
from rsibr.rsibr_addon.tasks.light.environments import load_environment
from rsibr.tests.files.test_export import read as read_ktx2

SIZE, COUNT = 128, 300
BANK = KernelBank((256.0,))
REACH = 0.03
"""1 less the cosine: there the kernel is 5e-4 of its peak."""


def one_kernel() -> Fit:
    """Seen from afar, a sphere shows the kernel's map once, whole."""
    one = np.ones((1, 1, 1))
    colour = np.ones((1, 1, 3))
    return Fit("vMF", "single", np.array([0.5]), BANK, colour[None], colour, np.zeros((1, 1, 1, 2)), one)


def directions_around(sun: Array) -> tuple[Array, Array]:
    """Directions, half of them in the kernel's reach of a sun, and the solid angle that each stands for."""
    rng = np.random.default_rng(3)
    azimuth, height = 2.0 * np.pi * rng.random(COUNT), 1.0 - REACH * rng.random(COUNT)
    radius = np.sqrt(1.0 - height**2)
    around = (
        np.stack([radius * np.cos(azimuth), radius * np.sin(azimuth), height], axis=-1) @ camera_frame(sun).T
    )
    direction = np.concatenate([around, normalize(rng.standard_normal((COUNT, 3)))])
    density = COUNT / (4.0 * np.pi) + (direction @ sun > 1.0 - REACH) * COUNT / (2.0 * np.pi * REACH)
    return direction, 1.0 / density


def sums_over_texels(radiance: Array, direction: Array) -> Array:
    height, width = radiance.shape[:2]
    texels = equirect.direction_from_uv(texel_centres(width, height)).reshape(-1, 3).astype(np.float32)
    power = (radiance * equirect.texel_solid_angle(width, height)[..., None]).reshape(-1, 3)
    sums = np.empty(direction.shape)
    for number, towards in enumerate(direction):
        near = texels @ towards.astype(np.float32) > 0.92  # beyond lies 1e-9 of the kernel
        chord = texels[near] - towards
        sums[number] = BANK.values(0.25 * dot(chord, chord))[:, 0] @ power[near]
    return sums


@pytest.mark.slow
def test_lookups_with_and_without_suns_cost_what_is_stated(tmp_path: Path) -> None:
    """By textures for engines, which hold suns, and by our own shading, which takes them apart."""
    light, path = load_environment("city"), tmp_path / "a.rsibr.exr"
    baked = drain(bake_stack(light.radiance, one_kernel(), "octahedral", SIZE))
    write_map_set(path, in_turn(baked, Origin(light, {}, "a test")))
    direction, angle = directions_around(find_suns(light.radiance).direction[0])
    truth = sums_over_texels(light.radiance, direction)

    def error(shown: Array) -> float:
        return float(
            np.sqrt(angle @ np.sum((shown - truth) ** 2, axis=1) / (angle @ np.sum(truth**2, axis=1)))
        )

    (written,) = drain(export(path, tmp_path / "a.ktx2"))
    texture = read_ktx2(written)
    uv, _ = stack_representation("octahedral", SIZE).uv_from_direction(direction)
    texels = texture.levels[0][0, ..., :3].astype(np.float64)
    looked_up = bilinear(texels, (uv * SIZE + 1.0) / (SIZE + 2.0), clamp_to_edge)
    stack = from_map_set(path, read_map_set(path))
    first = np.zeros(len(direction), np.intp)
    apart = lookup(stack.maps[0, 0], direction, stack.representation)
    apart += stack.sunlight.along(0, direction, first, np.zeros(len(direction)))
    stated = texture.note["error_bound"]
    # A sun may fall on skewed texels, which cost half more than those of a mean map
    assert 0.6 < error(looked_up) / stated["interpolation"] < 1.6
    assert 0.6 < error(apart) / stated["interpolation_suns_apart"] < 1.6
    assert stated["interpolation_suns_apart"] < 0.2 * stated["interpolation"]
