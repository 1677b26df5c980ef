"""Shading from reflection tables [Miller1984]: a weighted sum of lookups."""

from dataclasses import dataclass

import numpy as np

from ..conventions import Array, ArrayLike
from ..directions import dot, reflect, refract
from ..errors import RangeError
from ..maps import equirect, sphere_map
from ..reflection_tables import ReflectionTables, Role
from ..resample import bilinear


@dataclass(frozen=True)
class TablesLook:
    """How reflection tables are shaded.

    Attributes
    ----------
    shown : tuple of Role
        Or their values, as text: the tables that count; what a material lacks is not missed.

    Raises
    ------
    RangeError
        There is no table of that name, or none is named.
    """

    shown: tuple[Role, ...] = tuple(Role)

    def __post_init__(self) -> None:
        try:
            object.__setattr__(self, "shown", tuple(Role(name) for name in self.shown))
        except ValueError as error:
            raise RangeError(f"There is no such table ({error}): choose from {', '.join(Role)}.") from error
        if not self.shown:
            raise RangeError(f"A picture needs a table: choose from {', '.join(Role)}.")


def lookup_direction(role: Role, normal: ArrayLike, view_dir: ArrayLike, eta: float) -> Array:
    """The direction that a table is looked up by.

    Parameters
    ----------
    role : Role
    normal, view_dir : array_like, shape (..., 3)
        Unit vectors in world coordinates.
    eta : float
        Of `ReflectionTables`; for REFRACTION.

    Returns
    -------
    ndarray, shape (..., 3)
        Unit directions in world coordinates.

    Notes
    -----
    [Miller1984] section 3, line 9, and section 9.
    """
    match role:
        case Role.DIFFUSE:
            return np.asarray(normal)
        case Role.SPECULAR | Role.COAT:
            return reflect(view_dir, normal)
        case Role.RETRO:
            return np.asarray(view_dir)
        case Role.REFRACTION:
            return refract(view_dir, normal, eta)


def reflect_tables(
    tables: ReflectionTables, normal: ArrayLike, view_dir: ArrayLike, look: TablesLook
) -> Array:
    """Radiance of surface points: the sum over the tables of weight times table.

    Parameters
    ----------
    tables : ReflectionTables
    normal, view_dir : array_like, shape (..., 3)
        Unit vectors in world coordinates.
    look : TablesLook

    Returns
    -------
    ndarray, shape (..., 3), float64
        Radiance: Wd(E.N) D[N] + Ws(E.N) S[R] of [Miller1984] section 3, and so for the other tables.

    Notes
    -----
    Tables are interpolated (section 7.1) between texel centres, across seam and poles too, weights
    between their columns. GLSL twin: gpu_shaders/reflection_tables_frag.glsl.
    """
    normal, view_dir = np.broadcast_arrays(np.asarray(normal, np.float64), np.asarray(view_dir, np.float64))
    cosine = dot(normal, view_dir)
    radiance = np.zeros(normal.shape)
    for number, role in enumerate(Role):
        if role not in tables.maps or role not in look.shown:
            continue
        row = np.full_like(cosine, (number + 0.5) / len(Role))
        weight = bilinear(tables.weights, np.stack([cosine, row], axis=-1), sphere_map.wrap)
        uv = equirect.uv_from_direction(lookup_direction(role, normal, view_dir, tables.eta))
        radiance += weight * bilinear(tables.maps[role], uv, equirect.wrap)
    return radiance
