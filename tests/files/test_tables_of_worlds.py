"""Reflection tables of one of Blender's own environments against brute force."""

from pathlib import Path

import numpy as np
import pytest
from rsibr.rsibr_addon.core.conventions import texel_centres
from rsibr.rsibr_addon.core.environment import Environment
from rsibr.rsibr_addon.core.kinds.reflection_tables.bake import BakedTables, TableSizes, bake_tables
from rsibr.rsibr_addon.core.kinds.reflection_tables.material import material_from_texts
from rsibr.rsibr_addon.core.kinds.reflection_tables.tables import Role
from rsibr.rsibr_addon.core.maps import equirect
from rsibr.rsibr_addon.core.progress import drain
from rsibr.rsibr_addon.files.brdfs import read_measured
from rsibr.rsibr_addon.files.environments import read_environment

ROWS = 4
DIRECTIONS = equirect.direction_from_uv(texel_centres(2 * ROWS, ROWS))


@pytest.fixture
def world(blender_worlds: Path) -> Environment:
    """A room of 1024 x 512 texels with lamps of a few texels, thousands of times as bright as its walls."""
    return read_environment(blender_worlds / "interior.exr")


def bake(world: Environment, **texts: str) -> BakedTables:
    material = material_from_texts(texts, read_measured)
    return drain(bake_tables(world.radiance, material, TableSizes(ROWS, ROWS)))


def sum_over_texels(world: Environment, n: float) -> np.ndarray:
    """Radiance times solid angle times the n-th power of the cosine, summed up direction by direction."""
    height, width = world.radiance.shape[:2]
    texels = equirect.direction_from_uv(texel_centres(width, height)).reshape(-1, 3)
    light = world.radiance * equirect.texel_solid_angle(width, height)[..., None]
    sums = [np.maximum(texels @ axis, 0.0) ** n @ light.reshape(-1, 3) for axis in DIRECTIONS.reshape(-1, 3)]
    return np.reshape(sums, (ROWS, 2 * ROWS, 3))


@pytest.mark.needs("bpy")
def test_the_diffuse_table_is_exact(world: Environment) -> None:
    made = bake(world, diffuse="lambert:kd=0.8").tables.maps[Role.DIFFUSE]
    # Radiance and tables are of single precision.
    np.testing.assert_allclose(made, 0.8 / np.pi * sum_over_texels(world, 1.0), rtol=2.0**-22)


@pytest.mark.needs("bpy")
@pytest.mark.parametrize("n", [2.0, 30.0, 400.0])
def test_a_phong_table_keeps_its_bound(world: Environment, n: float) -> None:
    baked = bake(world, specular=f"phong:n={n},ks=0.5")
    expected = 0.5 * (n + 1.0) / (2.0 * np.pi) * sum_over_texels(world, n)
    error = np.abs(baked.tables.maps[Role.SPECULAR] - expected)
    assert np.all(error <= baked.bounds[Role.SPECULAR] + 2.0**-23 * expected)
    assert baked.bounds[Role.SPECULAR].max() < 1e-4 * expected.max()
