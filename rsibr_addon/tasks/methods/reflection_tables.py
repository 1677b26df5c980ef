"""An environment and a material to reflection tables, in a map set."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

from ...core.filtering.prefilter import BYTES_BESIDES, bytes_needed
from ...core.kinds.reflection_tables.bake import TableSizes, bake_tables, largest_rows
from ...core.kinds.reflection_tables.material import material_from_texts
from ...core.kinds.reflection_tables.weights import warn_of_table_gain
from ...core.progress import Progress, Steps
from ...files.atomic import check_target
from ...files.brdfs import read_measured
from ...files.kinds.reflection_tables import to_map_set
from ...files.map_set import write_map_set
from ...files.memory import check_memory
from ...host.version import software
from ..light.environments import load_environment

TABLE_OF_TEXEL = 12
"""Bytes of memory for each texel of a table in single precision."""


@dataclass(frozen=True)
class TableSettings:
    """What to make tables of, and how.

    Attributes
    ----------
    material : mapping of str to str
        Part -> its text: see `core.kinds.reflection_tables.material`.
    sizes : TableSizes
    exact : bool
        Whether lobes are summed over all texels by brute force.
    """

    material: Mapping[str, str]
    sizes: TableSizes = field(default_factory=TableSizes)
    exact: bool = False


def bake_table_set(
    environment: str | None,
    settings: TableSettings,
    output: Path,
    force: bool = False,
    clamp: float | None = None,
) -> Steps[Path]:
    """Make the tables of a material.

    Parameters
    ----------
    environment : str or None
        See `load_environment`.
    settings : TableSettings
    output : Path
        By custom NAME.rsibr.exr.
    force : bool
        Whether an existing file is replaced.
    clamp : float, optional
        See `core.environment.usable_radiance`.

    Yields
    ------
    Progress

    Returns
    -------
    Path
        `output`.

    Raises
    ------
    InputFileError, OutputFileError, SceneError
    RangeError
        The material is none, a lobe narrower than the environment resolves, or a table too large for this
        machine's memory.

    Warns
    -----
    RsibrWarning
        Negative values of the environment were set to 0; the material reflects more light than it gets.
    """
    check_target(output, force)
    material = material_from_texts(settings.material, read_measured)
    warn_of_table_gain(material)
    yield Progress(0, 1, "reading the environment")
    light = load_environment(environment, clamp)
    rows = largest_rows(material, settings.sizes, len(light.radiance))
    texels = 2 * rows**2
    needed = bytes_needed(1, texels) + TABLE_OF_TEXEL * len(material.roles) * texels
    check_memory(needed, str(output), (2 * rows, rows), BYTES_BESIDES)
    baked = yield from bake_tables(light.radiance, material, settings.sizes, settings.exact)
    map_set = to_map_set(
        baked.tables,
        light,
        dict(settings.material),
        {role.value: bound.tolist() for role, bound in baked.bounds.items()} or None,
        {"exact": settings.exact},
        software(),
    )
    write_map_set(output, map_set, force)
    return output
