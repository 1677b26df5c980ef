"""Radiance sphere maps of one material in one environment, seen from around it."""

from dataclasses import dataclass

import numpy as np

from .conventions import Array
from .directions import camera_frame
from .errors import RangeError, ShapeError
from .geodesic import GeodesicSphere, geodesic_sphere


@dataclass(frozen=True)
class RadianceViews:
    """What [Cabral1999] calls L_r,j: one radiance sphere map a view direction.

    Attributes
    ----------
    diffuse, glossy : ndarray, shape (V, size, size, 3), float32
        Reflected radiance of the glossy lobes, and of everything else (Lambert, emission); their
        sum is the whole. V is 12, 42 or 162, in the order of `geodesic_sphere(V).vertices`.

    Raises
    ------
    ShapeError
        The two differ in shape, or the maps are not square.
    RangeError
        V is not one of `geodesic.VERTEX_COUNTS`.
    """

    diffuse: Array
    glossy: Array

    def __post_init__(self) -> None:
        count, height, width, channels = self.diffuse.shape
        if self.glossy.shape != self.diffuse.shape or height != width or channels != 3:
            raise ShapeError(
                f"Radiance views need diffuse and glossy maps of equal, square size, not "
                f"{self.diffuse.shape} and {self.glossy.shape}."
            )
        geodesic_sphere(count)

    @property
    def sphere(self) -> GeodesicSphere:
        """The view directions, and the triangles between them."""
        return geodesic_sphere(len(self.diffuse))

    @property
    def frames(self) -> Array:
        """Camera axes of every view as columns, shape (V, 3, 3): T_s of [Cabral1999]."""
        return camera_frame(self.sphere.vertices)

    @property
    def size(self) -> int:
        """Width and height of each map in texels."""
        return int(self.diffuse.shape[1])

    def coarser(self, vertex_count: int) -> "RadianceViews":
        """The first `vertex_count` views alone, which are those of a coarser sphere.

        Raises
        ------
        RangeError
            There are not that many views, or not a sphere of that many.
        """
        if vertex_count > len(self.diffuse):
            raise RangeError(
                f"There are only {len(self.diffuse)} views, not {vertex_count}: use fewer or capture more."
            )
        return RadianceViews(self.diffuse[:vertex_count], self.glossy[:vertex_count])

    @property
    def combined(self) -> Array:
        """The whole reflected radiance, shape (V, size, size, 3)."""
        whole: Array = np.add(self.diffuse, self.glossy)
        return whole
