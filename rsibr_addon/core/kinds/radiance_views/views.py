"""Radiance sphere maps of one material in one environment, seen from around it."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from ...conventions import Array
from ...errors import RangeError, ShapeError
from ...geometry.directions import camera_frame
from ...geometry.geodesic import VERTEX_COUNTS, GeodesicSphere, geodesic_sphere
from ...geometry.view_sphere import view_sphere
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
        whole.
    albedo : ndarray, shape (2, M, 3), float32
        Directional albedo of the material, diffuse part in row 0 and glossy in row 1; column k is
        for n.v = (k + 0.5) / M. By default the same for every view direction.
    left_out : mapping of Warping to float
        Relative root-mean-square error of captured views that were predicted from their neighbours, by warp;
        empty where it is not known.
    view_dirs : ndarray, shape (V, 3), optional
        Directions from the sphere to the camera of each view. By default V is 12, 42 or 162, and they are
        `geodesic_sphere(V).vertices`.

    Raises
    ------
    ShapeError
        The maps differ in shape, or are not square; the albedo does not have two rows; there are not as many
        directions as maps.
    RangeError
        V is not one of `geodesic.VERTEX_COUNTS`; or see `view_sphere`.
    """

    diffuse: Array
    glossy: Array
    albedo: Array = field(default_factory=_constant_albedo)
    left_out: Mapping[Warping, float] = field(default_factory=dict)
    view_dirs: Array | None = None

    def __post_init__(self) -> None:
        count, height, width, channels = self.diffuse.shape
        if self.glossy.shape != self.diffuse.shape or height != width or channels != 3:
            raise ShapeError(
                f"Radiance views need diffuse and glossy maps of equal, square size, not "
                f"{self.diffuse.shape} and {self.glossy.shape}."
            )
        if self.albedo.ndim != 3 or self.albedo.shape[::2] != (2, 3):
            raise ShapeError(f"A table of albedo has the shape (2, M, 3), not {self.albedo.shape}.")
        if len(self.sphere.vertices) != count:
            raise ShapeError(f"There are {count} views but {len(self.sphere.vertices)} directions.")

    @cached_property
    def sphere(self) -> GeodesicSphere:
        """The view directions, and the triangles between them."""
        return geodesic_sphere(len(self.diffuse)) if self.view_dirs is None else view_sphere(self.view_dirs)

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
            There are not so many views, no sphere has so many, or they are of other directions.
        """
        if vertex_count > len(self.diffuse):
            raise RangeError(
                f"There are only {len(self.diffuse)} views, not {vertex_count}: use fewer or capture more."
            )
        if vertex_count == len(self.diffuse):
            return self
        if len(self.diffuse) not in VERTEX_COUNTS or self.sphere is not geodesic_sphere(len(self.diffuse)):
            raise RangeError(
                f"The {len(self.diffuse)} views have directions of their own, of which no part is a coarser "
                f"set: use all."
            )
        return RadianceViews(self.diffuse[:vertex_count], self.glossy[:vertex_count], self.albedo)

    @property
    def combined(self) -> Array:
        """The whole reflected radiance, shape (V, size, size, 3)."""
        whole: Array = np.add(self.diffuse, self.glossy)
        return whole
