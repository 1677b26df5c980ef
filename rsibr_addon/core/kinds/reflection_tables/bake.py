"""From an environment and a material to reflection tables."""

from dataclasses import dataclass

import numpy as np

from ...conventions import Array, texel_centres
from ...errors import RangeError
from ...filtering.harmonics.analysis import analyse_environment
from ...filtering.irradiance import irradiance_exact
from ...filtering.prefilter import analysis_degree, prefilter, prefilter_exact
from ...filtering.radial_lobes import phong_lobe
from ...filtering.zonal import TOLERANCE, expand
from ...maps import equirect
from ...maps.representation import representation
from ...progress import Progress, Steps
from ...resample import resample
from .material import TableMaterial
from .models import LambertTable, MirrorTable, PhongTable
from .tables import ReflectionTables, Role
from .weights import table_weights

DIFFUSE_ROWS = 36
"""Rows of a diffuse table, and the fewest of a lobe's: [Miller1984] section 6.1."""

LOOKUP_ERROR = 0.01
"""Error of a bilinear lookup beside a single light, relative to a lobe's peak, at the rows of `lobe_rows`."""

LARGEST = 8192
"""Rows of the largest table."""

_KINKED = 2.0
_KINKED_TOLERANCE = 1e-4
"""Tolerance of lobes with small exponents, which fall so abruptly to 0 that less would take too many
harmonics."""


@dataclass(frozen=True)
class TableSizes:
    """Rows of tables; they have twice as many columns.

    Attributes
    ----------
    diffuse : int
        Rows of the diffuse table, 1 to `LARGEST`.
    others : int or None
        Rows of all other tables; by default the environment's for mirrors, and `lobe_rows` for lobes.

    Raises
    ------
    RangeError
        A size is out of range.
    """

    diffuse: int = DIFFUSE_ROWS
    others: int | None = None

    def __post_init__(self) -> None:
        for rows in (self.diffuse, self.others):
            if rows is not None and not 1 <= rows <= LARGEST:
                raise RangeError(f"A table cannot have {rows} rows: choose 1 to {LARGEST}.")


@dataclass(frozen=True)
class BakedTables:
    """Tables, and bounds on their errors.

    Attributes
    ----------
    tables : ReflectionTables
    bounds : dict of Role to ndarray, shape (3,)
        Bounds of tables of lobes: no texel is further than this from the sum over all texels of the
        environment, rounding to single precision aside.
    """

    tables: ReflectionTables
    bounds: dict[Role, Array]


def lobe_rows(n: float, environment_rows: int) -> int:
    """Rows of a Phong lobe's table.

    Parameters
    ----------
    n : float
        The lobe's exponent, at least 1.
    environment_rows : int
        Rows of the environment; no lobe's table is finer.

    Returns
    -------
    int
        pi sqrt(n / (4 `LOOKUP_ERROR`)), at least `DIFFUSE_ROWS`.

    Notes
    -----
    Near its peak cos^n falls as 1 - n angle^2 / 2: linear interpolation over a step h errs by n h^2 / 8 of
    the peak, bilinear by twice that. At h = pi / rows this is `LOOKUP_ERROR`.
    """
    rows = int(np.ceil(np.pi * np.sqrt(n / (4.0 * LOOKUP_ERROR))))
    return min(max(rows, DIFFUSE_ROWS), max(environment_rows, DIFFUSE_ROWS))


def largest_rows(material: TableMaterial, sizes: TableSizes, environment_rows: int) -> int:
    """Most rows of a material's tables."""
    rows = [sizes.diffuse] if Role.DIFFUSE in material.roles else []
    for model in material.lobes.values():
        if isinstance(model, MirrorTable):
            rows.append(sizes.others or environment_rows)
        else:
            rows.append(sizes.others or lobe_rows(model.n, environment_rows))
    return max(rows)


def bake_tables(
    radiance: Array, material: TableMaterial, sizes: TableSizes, exact: bool = False
) -> Steps[BakedTables]:
    """Make the tables of a material.

    Parameters
    ----------
    radiance : ndarray, shape (height, 2 * height, 3)
        The environment's.
    material : TableMaterial
    sizes : TableSizes
    exact : bool
        Whether lobes are summed over all texels of the environment, which takes long, instead of filtered by
        spherical harmonics.

    Yields
    ------
    Progress
        Before each table.

    Raises
    ------
    RangeError
        A lobe is narrower than the environment resolves; see also `table_weights`.
    """
    count = len(material.roles) + 1
    yield Progress(0, count, "weighting the tables")
    weights = table_weights(material).astype(np.float32)
    maps: dict[Role, Array] = {}
    bounds: dict[Role, Array] = {}
    if Role.DIFFUSE in material.roles:
        yield Progress(1, count, "making the diffuse table")
        maps[Role.DIFFUSE] = _diffuse_table(radiance, material, sizes.diffuse).astype(np.float32)
    for role, model in material.lobes.items():
        yield Progress(len(maps) + 1, count, f"making the {role} table")
        if isinstance(model, MirrorTable):
            maps[role] = _mirror_table(radiance, model, sizes.others)
            continue
        rows = sizes.others or lobe_rows(model.n, len(radiance))
        try:
            made, bounds[role] = _lobe_table(radiance, model, rows, exact)
        except RangeError as error:
            raise RangeError(f"{role}: {error}") from error
        maps[role] = made.astype(np.float32)
    return BakedTables(ReflectionTables(maps, weights, material.eta), bounds)


def _directions(rows: int) -> Array:
    """Directions of a table's texel centres, shape (rows, 2 rows, 3)."""
    return equirect.direction_from_uv(texel_centres(2 * rows, rows))


def _diffuse_table(radiance: Array, material: TableMaterial, rows: int) -> Array:
    """D of [Miller1984] section 6.1, with the material's emission."""
    table = np.zeros((rows, 2 * rows, 3))
    if isinstance(material.diffuse, LambertTable):
        table += material.diffuse.gain / np.pi * irradiance_exact(radiance, _directions(rows))
    elif material.diffuse is not None:
        solid_angle = equirect.texel_solid_angle(radiance.shape[1], len(radiance))
        mean = np.einsum("hw,hwc->c", solid_angle, radiance) / (4.0 * np.pi)
        table += material.diffuse.gain * mean
    if material.emission is not None:
        table += material.emission.radiance
    return table


def _mirror_table(radiance: Array, model: MirrorTable, rows: int | None) -> Array:
    """The environment, resized if asked."""
    if rows is not None and rows != len(radiance):
        layout = representation("equirect")
        radiance = resample(radiance[None], layout, layout, 2 * rows)[0]
    # Not in double precision: it is as large as the environment
    table: Array = np.multiply(radiance, model.gain, dtype=np.float32, casting="same_kind")
    return table


def _lobe_table(radiance: Array, model: PhongTable, rows: int, exact: bool) -> tuple[Array, Array]:
    """S of [Miller1984] section 6.2 with its bound, which is 0 for a sum over all texels."""
    lobe, directions = phong_lobe(model.n), _directions(rows)
    if exact:
        return model.gain * prefilter_exact(radiance, [lobe], directions)[0], np.zeros(3)
    series = [expand(lobe, _KINKED_TOLERANCE if model.n < _KINKED else TOLERANCE)]
    filtered = prefilter(analyse_environment(radiance, analysis_degree(series)), series, directions)
    return model.gain * filtered.radiance[0], model.gain * filtered.bound[0]
