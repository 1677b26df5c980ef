"""An environment and a material to reflection tables, in a map set."""

from functools import partial

from ...core.filtering.prefilter import BYTES_BESIDES, bytes_needed
from ...core.kinds.reflection_tables.bake import bake_tables, largest_rows
from ...core.kinds.reflection_tables.material import material_from_texts
from ...core.kinds.reflection_tables.weights import warn_of_table_gain
from ...core.progress import Steps
from ...files.brdfs import read_measured
from ...files.kinds.reflection_tables import to_map_set
from ...files.map_set_header import Origin, Recipe
from ...files.memory import check_memory
from ...job import BakeJob
from ...settings.reflection_tables import ReflectionTablesSettings
from .method import (
    RGB,
    STORED,
    Baked,
    Cost,
    Method,
    Sources,
    cost_in_blender,
    measured_files,
    read_light,
    software_of,
    written,
)

TABLE_OF_TEXEL = 12
"""Bytes of memory for each texel of a table in single precision."""


def material(settings: ReflectionTablesSettings) -> str:
    """See `Method`."""
    return settings.material or ", ".join(settings.parts)


def sources(settings: ReflectionTablesSettings) -> Sources:
    """See `Method`."""
    return Sources(measured_files(partial(material_from_texts, settings.parts)))


def cost(settings: ReflectionTablesSettings) -> Cost:
    """See `Method`; with a mirror's table, as large as the environment where the rows are left open."""
    rows = settings.rows or 512
    maps = (2 * settings.diffuse_rows**2 + 2 * rows**2) * RGB
    diffuse = 3e-4 * settings.diffuse_rows**2
    memory = BYTES_BESIDES + bytes_needed(1, 2 * rows**2) + maps
    return cost_in_blender(0.5 + diffuse + 1.5e-7 * maps, memory, STORED * maps)


def bake(job: BakeJob[ReflectionTablesSettings], recipe: Recipe) -> Steps[Baked]:
    """Make the tables of a material: see `Method`.

    Raises
    ------
    RangeError
        The material is none, a lobe narrower than the environment resolves, or a table too large for this
        machine's memory.

    Warns
    -----
    RsibrWarning
        The material reflects more light than it gets.
    """
    settings = job.settings
    parts = settings.parts
    material = material_from_texts(parts, read_measured)
    warn_of_table_gain(material)
    light = yield from read_light(job)
    rows = largest_rows(material, settings.sizes, len(light.radiance))
    texels = 2 * rows**2
    needed = bytes_needed(1, texels) + TABLE_OF_TEXEL * len(material.roles) * texels
    check_memory(needed, job.output, (2 * rows, rows), BYTES_BESIDES)
    baked = yield from bake_tables(light.radiance, material, settings.sizes, settings.exact)
    bounds = {role.value: bound.tolist() for role, bound in baked.bounds.items()} or None
    origin = Origin(light, {"exact": settings.exact}, software_of(job), dict(parts), bounds)
    path = yield from written(job, recipe, to_map_set(baked.tables, origin))
    return Baked(path, ", ".join(f"{part} {text}" for part, text in parts.items()), {"parts": dict(parts)})


METHOD = Method(bake, cost, material, sources)
