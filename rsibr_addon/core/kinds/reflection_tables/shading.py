"""Shading from reflection tables [Miller1984]: a weighted sum of lookups."""

from dataclasses import dataclass

import numpy as np

from ...antialiased.footprint import footprint_or_point
from ...antialiased.summed_area import footprint_mean
from ...conventions import Array, ArrayLike
from ...errors import RangeError
from ...geometry.directions import dot, reflect, refract
from ...maps import equirect, sphere_map
from ...resample import bilinear
from .tables import ReflectionTables, Role

MIRRORED = (Role.SPECULAR, Role.COAT)
"""Tables that are looked up by the mirrored view direction, which turns fastest from pixel to pixel."""


@dataclass(frozen=True)
class TablesLook:
    """Look of reflection tables.

    Attributes
    ----------
    shown : tuple of Role
        The tables that are shown, or their values as text; tables that a material lacks are ignored.
    w_diffuse, w_specular, w_coat, w_retro, w_refraction : float
        Factors, at least 0, of the weights that the tables come with; the paper's Wd and Ws.
    antialiased : bool
        Whether tables of `MIRRORED` are averaged over what a pixel reflects; otherwise they are interpolated.

    Raises
    ------
    RangeError
        There is no table of that name, or no table is named; a weight is negative or not finite.
    """

    shown: tuple[Role, ...] = tuple(Role)
    w_diffuse: float = 1.0
    w_specular: float = 1.0
    w_coat: float = 1.0
    w_retro: float = 1.0
    w_refraction: float = 1.0
    antialiased: bool = False

    def __post_init__(self) -> None:
        for role in Role:
            weight = getattr(self, f"w_{role}")
            if not 0.0 <= weight < np.inf:
                raise RangeError(f"A weight of {weight:g} is out of range: choose a number from 0.")
        try:
            object.__setattr__(self, "shown", tuple(Role(name) for name in self.shown))
        except ValueError as error:
            raise RangeError(f"There is no such table ({error}): choose from {', '.join(Role)}.") from error
        if not self.shown:
            raise RangeError(f"A picture needs a table: choose from {', '.join(Role)}.")

    def weight(self, role: Role) -> float:
        """The factor of a table's weights.

        Parameters
        ----------
        role : Role

        Returns
        -------
        float
            0 where it is not shown.
        """
        return float(getattr(self, f"w_{role}")) if role in self.shown else 0.0


def lookup_direction(role: Role, normal: ArrayLike, view_dir: ArrayLike, eta: float) -> Array:
    """The direction that a table is looked up by.

    Parameters
    ----------
    role : Role
    normal, view_dir : array_like, shape (..., 3)
        Unit vectors in world coordinates.
    eta : float
        See `ReflectionTables`; for REFRACTION.

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
    tables: ReflectionTables,
    normal: ArrayLike,
    view_dir: ArrayLike,
    look: TablesLook,
    mirror_footprint: ArrayLike | None = None,
) -> Array:
    """Radiance of surface points: the sum over the tables of weight times table.

    Parameters
    ----------
    tables : ReflectionTables
    normal, view_dir : array_like, shape (..., 3)
        Unit vectors in world coordinates.
    look : TablesLook
    mirror_footprint : array_like, shape (..., 4, 3), optional
        Mirrored view directions at the corners of each point's pixel, over which an antialiased look
        averages: see `core.antialiased`. None for points, which reflect one direction each.

    Returns
    -------
    ndarray, shape (..., 3), float64
        Radiance: Wd(E.N) D[N] + Ws(E.N) S[R] of [Miller1984] section 3, and so for the other tables.

    Notes
    -----
    Tables are interpolated (section 7.1) between texel centres, across seam and poles too, weights between
    their columns. Antialiased tables are averaged as in section 8.3. GLSL twin:
    gpu_shaders/reflection_tables_frag.glsl.
    """
    normal, view_dir = np.broadcast_arrays(np.asarray(normal, np.float64), np.asarray(view_dir, np.float64))
    corners = footprint_or_point(mirror_footprint, reflect(view_dir, normal))
    cosine = dot(normal, view_dir)
    radiance = np.zeros(normal.shape)
    for number, role in enumerate(Role):
        if role not in tables.maps or look.weight(role) == 0.0:
            continue
        row = np.full_like(cosine, (number + 0.5) / len(Role))
        weight = look.weight(role) * bilinear(
            tables.weights, np.stack([cosine, row], axis=-1), sphere_map.wrap
        )
        table, direction = tables.maps[role], lookup_direction(role, normal, view_dir, tables.eta)
        if look.antialiased and role in MIRRORED:
            radiance += weight * footprint_mean(table, direction, corners)
        else:
            radiance += weight * bilinear(table, equirect.uv_from_direction(direction), equirect.wrap)
    return radiance
