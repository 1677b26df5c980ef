"""Shading from reflection tables [Miller1984]: a weighted sum of lookups."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from ...antialiased.footprint import footprint_or_point
from ...antialiased.summed_area import footprint_mean
from ...conventions import Array, ArrayLike
from ...errors import RangeError
from ...geometry.directions import dot, reflect, refract
from ...geometry.sides import Seen, seen_surface
from ...maps import equirect, sphere_map
from ...options import Choice, Options, option
from ...resample import bilinear
from ..look_options import antialiased_option
from .tables import ReflectionTables, Role

MIRRORED = (Role.SPECULAR, Role.COAT)
"""Tables that are looked up by the mirrored view direction, which turns fastest from pixel to pixel."""


_TABLES = {
    Role.DIFFUSE: Choice("Diffuse", "by the normal"),
    Role.SPECULAR: Choice("Specular", "by the mirror direction"),
    Role.COAT: Choice("Coat", "a clear varnish, by the mirror direction"),
    Role.RETRO: Choice("Retro", "light sent back, by the view direction"),
    Role.REFRACTION: Choice("Refraction", "light let through, by the refracted direction"),
}
"""Table -> what it is looked up by."""


def _weight(label: str, help: str) -> Any:
    return option(1.0, label=label, help=help, least=0.0, most=1e6, soft_most=2.0, metavar="W")


@dataclass(frozen=True)
class TablesLook(Options):
    """How reflection tables are shaded.

    Raises
    ------
    RangeError
        There is no table of that name, or none is named; a weight is out of range.
    """

    shown: tuple[Role, ...] = option(
        tuple(Role),
        label="Tables",
        help="What is shown",
        choices=_TABLES,
        flag="--tables",
        metavar="NAMES",
    )
    w_diffuse: float = _weight(
        "Diffuse Weight", "Multiplies the diffuse table's weight, Wd of the paper of 1984"
    )
    w_specular: float = _weight(
        "Specular Weight", "Multiplies the specular table's weight, Ws of the paper of 1984"
    )
    w_coat: float = _weight("Coat Weight", "Multiplies the coat's weight")
    w_retro: float = _weight("Retro Weight", "Multiplies the weight of light that is sent back")
    w_refraction: float = _weight("Refraction Weight", "Multiplies the weight of light that is let through")
    antialiased: bool = antialiased_option("specular and coat", default=False)

    def __post_init__(self) -> None:
        super().__post_init__()
        if not self.shown:
            raise RangeError(f"A picture needs a table: choose from {', '.join(Role)}.")

    def weight(self, role: Role) -> float:
        """The factor of a table's weights.

        Returns
        -------
        float
            0 where it is not shown.
        """
        return float(getattr(self, f"w_{role}")) if role in self.shown else 0.0


def lookup_direction(role: Role, seen: Seen, view_dir: ArrayLike, eta: float) -> Array:
    """The direction that a table is looked up by.

    Parameters
    ----------
    role : Role
    seen : Seen
        The normals.
    view_dir : array_like, shape (..., 3)
        Unit vectors in world coordinates.
    eta : float
        See `ReflectionTables`; for REFRACTION. From the inside, light goes the other way.

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
            return seen.normal
        case Role.SPECULAR | Role.COAT:
            return reflect(view_dir, seen.mirror_normal)
        case Role.RETRO:
            return np.asarray(view_dir)
        case Role.REFRACTION:
            return refract(view_dir, seen.mirror_normal, np.where(seen.outside, eta, 1.0 / eta)[..., None])


def reflect_tables(
    tables: ReflectionTables,
    normal: ArrayLike,
    view_dir: ArrayLike,
    look: TablesLook,
    mirror_footprint: ArrayLike | None = None,
    facet: ArrayLike | None = None,
) -> Array:
    """Radiance of surface points: the sum over the tables of weight times table.

    Wd(E.N) D[N] + Ws(E.N) S[R] of [Miller1984] section 3, and so for the other tables. Parameters and result
    are those of every kind's shading: see `core.kinds`.

    Notes
    -----
    Tables are interpolated (section 7.1) between texel centres, across seam and poles too, weights between
    their columns. Antialiased tables are averaged as in section 8.3. GLSL twin:
    gpu_shaders/reflection_tables_frag.glsl.
    """
    normal, view_dir = np.broadcast_arrays(np.asarray(normal, np.float64), np.asarray(view_dir, np.float64))
    seen = seen_surface(normal, view_dir, facet)
    corners = footprint_or_point(mirror_footprint, reflect(view_dir, seen.mirror_normal))
    cosine = dot(seen.mirror_normal, view_dir)
    radiance = np.zeros(normal.shape)
    for number, role in enumerate(Role):
        if role not in tables.maps or look.weight(role) == 0.0:
            continue
        row = np.full_like(cosine, (number + 0.5) / len(Role))
        weight = look.weight(role) * bilinear(
            tables.weights, np.stack([cosine, row], axis=-1), sphere_map.wrap
        )
        table, direction = tables.maps[role], lookup_direction(role, seen, view_dir, tables.eta)
        if look.antialiased and role in MIRRORED:
            radiance += weight * footprint_mean(table, direction, corners)
        else:
            radiance += weight * bilinear(table, equirect.uv_from_direction(direction), equirect.wrap)
    return radiance
