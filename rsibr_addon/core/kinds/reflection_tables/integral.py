"""What reflection tables stand for, without tables: lobes over the light above the horizon, and mirrors."""

from collections.abc import Callable

import numpy as np

from ...conventions import Array
from ...geometry.directions import dot
from ...maps import equirect
from .material import TableMaterial
from .models import LambertTable, LuminousTable, MirrorTable, PhongTable
from .tables import ReflectionTables, Role
from .weights import table_weights

COLUMNS = 1024
"""Cosines at which the weights of mirrors are tabulated: 16 times as many as tables have."""


def lobes_reflectance(material: TableMaterial) -> Callable[[Array, Array], Array] | None:
    """The reflectance of a material's lobes, of which tables hold sums.

    Parameters
    ----------
    material : TableMaterial

    Returns
    -------
    callable or None
        A `core.brdf.model.BrdfFunction`; None where the material has no lobes.

    Notes
    -----
    [Miller1984] section 6, scaled as tables are, with light from above the horizon alone. The paper's
    specular lobe has no cosine of the light's angle, by which it is divided here: `geometry.lit_sphere`
    multiplies by it.
    """
    lobes = {role: each for role, each in material.lobes.items() if isinstance(each, PhongTable)}
    diffuse = material.diffuse if isinstance(material.diffuse, LambertTable) else None
    if not lobes and diffuse is None:
        return None

    def reflectance(light_dir: Array, view_dir: Array) -> Array:
        light_dir, view_dir = np.broadcast_arrays(light_dir, view_dir)
        found = np.zeros(light_dir.shape)
        above = (light_dir[..., 2] > 0.0) & (view_dir[..., 2] > 0.0)
        light, view = light_dir[above], view_dir[above]
        cosines, places = np.unique(view[:, 2], return_inverse=True)
        weights = dict(zip(Role, table_weights(material, cosines=cosines)[:, places], strict=True))
        value = np.zeros(light.shape)
        if diffuse is not None:
            value += weights[Role.DIFFUSE] * diffuse.gain / np.pi
        for role, lobe in lobes.items():
            axis = view * ((-1.0, -1.0, 1.0) if role is Role.SPECULAR else 1.0)
            shape = (lobe.n + 1.0) / (2.0 * np.pi) * np.maximum(dot(axis, light), 0.0) ** lobe.n
            value += weights[role] * lobe.gain * (shape / light[:, 2])[:, None]
        found[above] = value
        return found

    return reflectance


def mirrors(material: TableMaterial, radiance: Array) -> ReflectionTables | None:
    """What of a material needs no sum: mirrors and refraction, in the environment itself, and even light.

    Parameters
    ----------
    material : TableMaterial
    radiance : ndarray, shape (height, 2 * height, 3)
        The environment's.

    Returns
    -------
    ReflectionTables or None
        None where there is nothing of the kind.
    """
    maps = {
        role: (radiance * each.gain).astype(np.float32)
        for role, each in material.lobes.items()
        if isinstance(each, MirrorTable)
    }
    even = np.zeros(3)
    if isinstance(material.diffuse, LuminousTable):
        solid_angle = equirect.texel_solid_angle(radiance.shape[1], len(radiance))
        even = material.diffuse.gain * np.einsum("hw,hwc->c", solid_angle, radiance) / (4.0 * np.pi)
    if material.emission is not None:
        even = even + material.emission.radiance
    if np.any(even > 0.0):
        maps[Role.DIFFUSE] = np.broadcast_to(even, (1, 2, 3)).astype(np.float32)
    if not maps:
        return None
    cosines = (np.arange(COLUMNS) + 0.5) / COLUMNS
    weights = table_weights(material, cosines=cosines).astype(np.float32)
    return ReflectionTables(maps, weights, material.eta)
