"""Radiance sphere maps of one material in one environment, seen from around it."""

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from ...conventions import Array
from ...errors import RangeError, ShapeError
from ...geometry.directions import camera_frame
from ...geometry.geodesic import GeodesicSphere, geodesic_sphere
from .warping import Warping


def _constant_albedo() -> Array:
    return np.ones((2, 1, 3), dtype=np.float32)


@dataclass(frozen=True)
class RadianceViews:
    """A radiance sphere map for each view direction, L_r,j of [Cabral1999].

    Attributes
    ----------
    diffuse, glossy : ndarray, shape (V, size, size, 3), float32
        Radiance of everything but glossy lobes (Lambert, emission), and of glossy lobes; their sum is the
        whole. V is 12, 42 or 162, in the order of `geodesic_sphere(V).vertices`.
    albedo : ndarray, shape (2, M, 3), float32
        Directional albedo of the material, diffuse part in row 0 and glossy in row 1; column k is
        for n.v = (k + 0.5) / M. By default the same for every view direction.
    left_out : mapping of Warping to float
        Relative root-mean-square error of captured views that were predicted from their neighbours, by warp;
        empty where it is not known.

    Raises
    ------
    ShapeError
        The maps differ in shape, or are not square; the albedo does not have two rows.
    RangeError
        V is not one of `geodesic.VERTEX_COUNTS`.
    """

    diffuse: Array
    glossy: Array
    albedo: Array = field(default_factory=_constant_albedo)
    left_out: Mapping[Warping, float] = field(default_factory=dict)

    def __post_init__(self) -> None:
        count, height, width, channels = self.diffuse.shape
        if self.glossy.shape != self.diffuse.shape or height != width or channels != 3:
            raise ShapeError(
                f"Radiance views need diffuse and glossy maps of equal, square size, not "
                f"{self.diffuse.shape} and {self.glossy.shape}."
            )
        if self.albedo.ndim != 3 or self.albedo.shape[::2] != (2, 3):
            raise ShapeError(f"A table of albedo has the shape (2, M, 3), not {self.albedo.shape}.")
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
        """The first `vertex_count` views, which are the views of a coarser sphere.

        Raises
        ------
        RangeError
            There are not so many views, or no sphere has so many.
        """
        if vertex_count > len(self.diffuse):
            raise RangeError(
                f"There are only {len(self.diffuse)} views, not {vertex_count}: use fewer or capture more."
            )
        return RadianceViews(self.diffuse[:vertex_count], self.glossy[:vertex_count], self.albedo)

    @property
    def combined(self) -> Array:
        """The whole reflected radiance, shape (V, size, size, 3)."""
        whole: Array = np.add(self.diffuse, self.glossy)
        return whole
