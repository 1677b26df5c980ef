"""Shading from reflection tables [Miller1984]: a weighted sum of lookups."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from ...antialiased.averaging import Averaging, footprint_mean
from ...conventions import Array, ArrayLike
from ...errors import RangeError
from ...geometry.directions import dot, mirror_normal, reflect, refract
from ...geometry.sides import Seen, seen_surface
from ...maps import equirect, sphere_map
from ...options import Choice, Options, option
from ...resample import bilinear
from ..look_options import antialiased_option, averaging_option
from .changes import changed_tables
from .material import PARTS, changed_parts
from .part_options import part_option
from .tables import ReflectionTables, Role

AVERAGED = (Role.SPECULAR, Role.COAT, Role.RETRO, Role.REFRACTION)
"""Tables that an antialiased look averages: all but the diffuse one, which is smooth."""

_TABLES = {
    Role.DIFFUSE: Choice("Diffuse", "by the normal"),
    Role.SPECULAR: Choice("Specular", "by the mirror direction"),
    Role.COAT: Choice("Coat", "a clear varnish, by the mirror direction"),
    Role.RETRO: Choice("Retro", "light sent back, by the view direction"),
    Role.REFRACTION: Choice("Refraction", "light let through, by the refracted direction"),
}
"""Table -> what it is looked up by."""


_AS_BAKED = "as it was baked"


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
    fade: bool = option(
        False,
        label="Fade at the Horizon",
        help="Take from lobes what of them is beneath the horizon, where the paper's take light as well",
    )
    antialiased: bool = antialiased_option("all but diffuse light")
    averaging: Averaging = averaging_option()
    diffuse: str | None = part_option("diffuse", _AS_BAKED)
    emission: str | None = part_option("emission", _AS_BAKED)
    specular: str | None = part_option("specular", _AS_BAKED)
    coat: str | None = part_option("coat", _AS_BAKED)
    retro: str | None = part_option("retro", _AS_BAKED)
    refraction: str | None = part_option("refraction", _AS_BAKED)
    weights: str | None = part_option("weights", _AS_BAKED)

    def __post_init__(self) -> None:
        super().__post_init__()
        if not self.shown:
            raise RangeError(f"A picture needs a table: choose from {', '.join(Role)}.")

    def changes(self, tables: ReflectionTables) -> ReflectionTables:
        """The tables with the look's own parts, and its fade.

        Raises
        ------
        RangeError
            See `changed_tables`.
        """
        if not self.fade and all(getattr(self, part) is None for part in PARTS):
            return tables
        return changed_tables(tables, changed_parts(tables.parts, self), self.fade)

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
    view_footprint: ArrayLike | None = None,
) -> Array:
    """Radiance of surface points: the sum over the tables of weight times table.

    Wd(E.N) D[N] + Ws(E.N) S[R] of [Miller1984] section 3, and so for the other tables. Parameters and result
    are those of every kind's shading, see `core.kinds`; `view_footprint`, array_like of shape (..., 4, 3),
    has the view directions at the corners of each pixel, and is None where they are the same all over it.

    Raises
    ------
    RangeError
        See `TablesLook.changes`.

    Notes
    -----
    Tables are interpolated (section 7.1) between texel centres, across seam and poles too, weights between
    their columns. Antialiased tables are averaged as in section 8. GLSL twin:
    gpu_shaders/reflection_tables_frag.glsl.
    """
    tables = look.changes(tables)
    normal, view_dir = np.broadcast_arrays(np.asarray(normal, np.float64), np.asarray(view_dir, np.float64))
    seen = seen_surface(normal, view_dir, facet)
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
        if look.antialiased and mirror_footprint is not None and role in AVERAGED:
            corners = _footprint(role, seen, view_dir, mirror_footprint, view_footprint, tables.eta)
            found = footprint_mean(table, direction, corners, look.averaging)
        else:
            found = bilinear(table, equirect.uv_from_direction(direction), equirect.wrap)
        added = tables.added if role is Role.DIFFUSE else 0.0
        radiance += weight * (tables.gains.get(role, 1.0) * found + added)
    return radiance


def _footprint(
    role: Role,
    seen: Seen,
    view_dir: Array,
    mirror_footprint: ArrayLike,
    view_footprint: ArrayLike | None,
    eta: float,
) -> Array:
    """What pixels look a table up by at their corners, shape (..., 4, 3).

    The normals there are those by which views are mirrored.
    """
    mirrored = np.asarray(mirror_footprint, dtype=np.float64)
    if role in (Role.SPECULAR, Role.COAT):
        return mirrored
    views = np.asarray(view_dir[..., None, :] if view_footprint is None else view_footprint, np.float64)
    normals = mirror_normal(views, mirrored)
    outside = np.broadcast_to(seen.outside[..., None], mirrored.shape[:-1])
    there = lookup_direction(role, Seen(normals, normals, outside), views, eta)
    return np.broadcast_to(there, mirrored.shape)
