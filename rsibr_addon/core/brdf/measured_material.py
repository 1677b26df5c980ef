"""A renderer's material, measured with its diffuse and its glossy closures apart."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..conventions import Array
from .model import Brdf, Geometry
from .tabulated import DEFAULT_SHAPE, Tabulated, cell_directions, fill_missing


@dataclass(frozen=True, eq=False)
class FlatTable(Brdf):
    """A table that is flat towards grazing, where highlights are not.

    A microfacet's highlight grows like 1 / (n.l n.v) towards the horizon, and straight lines between a
    table's cells lie far above such a curve. So the reflectance times (n.l + n.v)^2 is interpolated. For GGX
    with alpha 0.1 at 88 degrees, this lowers the error of the albedo from 8.7 % to 1.2 %.

    Attributes
    ----------
    table : Tabulated
        Reflectance times (n.l + n.v)^2.
    """

    table: Tabulated

    def above_horizon(self, geometry: Geometry) -> Array:
        """See `Brdf`."""
        flat = self.table.above_horizon(geometry)
        reflectance: Array = flat / ((geometry.n_dot_l + geometry.n_dot_v) ** 2)[:, None]
        return reflectance


@dataclass(frozen=True, eq=False)
class MeasuredMaterial(Brdf):
    """The sum of two tables.

    Attributes
    ----------
    diffuse : Tabulated
    glossy : FlatTable
        Not reciprocal: artists' materials, and renderers' layers, need not be.
    spec : str
        The text that stands for the sum, ``blend:FILE.blend:NAME``.
    """

    diffuse: Tabulated
    glossy: FlatTable
    spec: str

    def above_horizon(self, geometry: Geometry) -> Array:
        """See `Brdf`."""
        return self.diffuse.above_horizon(geometry) + self.glossy.above_horizon(geometry)

    @property
    def layers(self) -> tuple[Brdf, ...]:
        """The tables that are not black, or one if both are."""
        tables = ((self.diffuse, self.diffuse.table), (self.glossy, self.glossy.table.table))
        return tuple(layer for layer, table in tables if table.any()) or (self.diffuse,)


def measured_pairs(least_cosine: float) -> tuple[Array, Array, NDArray[np.bool]]:
    """Pairs of directions to measure for `measured_material`.

    Parameters
    ----------
    least_cosine : float
        Least cosine between the normal and either direction.

    Returns
    -------
    light_dir, view_dir : ndarray, shape `DEFAULT_SHAPE` + (3,), float64
        Unit vectors; the normal is +Z. The pairs [:, d] all enclose one angle.
    wanted : ndarray of bool, shape `DEFAULT_SHAPE`
        Pairs with both directions so far above the horizon.
    """
    light_dir, view_dir = cell_directions(DEFAULT_SHAPE)
    return light_dir, view_dir, np.minimum(light_dir[..., 2], view_dir[..., 2]) >= least_cosine


def measured_material(diffuse: Array, glossy: Array, spec: str) -> MeasuredMaterial:
    """Make a model of measurements.

    Parameters
    ----------
    diffuse, glossy : ndarray, shape `DEFAULT_SHAPE` + (3,)
        [1/sr] for the pairs of `measured_pairs`; NaN where nothing was measured.
    spec : str
        The text that stands for the model.

    Returns
    -------
    MeasuredMaterial
        Equal to the measurements at their pairs.
    """
    light_dir, view_dir = cell_directions(DEFAULT_SHAPE)
    flat = glossy * (light_dir[..., 2:] + view_dir[..., 2:]) ** 2
    return MeasuredMaterial(
        Tabulated(fill_missing(diffuse), f"{spec} (diffuse)", reciprocal=False),
        FlatTable(Tabulated(fill_missing(flat), f"{spec} (glossy)", reciprocal=False)),
        spec,
    )
