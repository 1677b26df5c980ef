"""Every map representation by its name, all alike.

The other modules have one or several sheets, parameters, and axes of their own. Here they have one interface:
a map is an array (sheets, height, width, channels), a point of it is a uv and the number of a sheet, and
directions are in world coordinates.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np
from numpy.typing import NDArray

from ..conventions import Array, ArrayLike, Indices, texel_centres
from ..errors import RangeError
from ..geometry.directions import camera_frame
from . import (
    angular_map,
    cube_map,
    dual_paraboloid,
    equirect,
    mirror_ball,
    octahedral,
    orthographic,
    sphere_map,
)

WORLD = np.eye(3)
"""Axes of the world, as columns."""

FRONT = camera_frame((0.0, -1.0, 0.0))
"""Axes of a picture from Blender's front view: x right (+X), y up (+Z), z towards the viewer (-Y)."""

AHEAD = FRONT * (1.0, 1.0, -1.0)
"""Axes of a viewer who looks along +Y: x right, y up, z ahead. Left-handed, as axes of cube pictures are."""

DirectionFromUv = Callable[[ArrayLike, Indices], Array]
DirectionOfGrid = Callable[[Array, Array], Array]
UvFromDirection = Callable[[ArrayLike], tuple[Array, Indices]]
Sectors = Sequence[tuple[Array, Array]]
"""For each sector of a map the matrix, shape (3, 3), that takes directions of the first one there, and its
texels, shape (sheets, rows, columns, channels), in the order of the first one's."""

WrapSheets = Callable[[Indices, Indices, Indices, int, int], tuple[Indices, Indices, Indices]]


@dataclass(frozen=True, eq=False)
class Representation:
    """A way to lay out the sphere of directions on sheets of texels.

    Attributes
    ----------
    name : str
        Name of its module.
    frame : ndarray, shape (3, 3)
        The map's own axes as columns, in world coordinates.
    sheets : tuple of str
        A name for each sheet; of a single one, "".
    aspect : int
        Width of a sheet over its height.
    disk : float
        Radius of the disk that counts, in half-widths of a sheet; infinite if the whole sheet counts.
    goes_on : bool
        Whether texels outside the disk show directions of their own, instead of repeating its rim.
    blind_angle : float
        Half-angle of the cone about its own -z that the map does not show [rad].
    symmetric : bool
        Whether quarter turns about the world's z, and mirrors along its axes, take texels to texels, where a
        sheet's width is a multiple of 4.
    own_grid : callable, optional
        The module's directions of a grid, in the map's own axes, where that is faster than point by point.
        They go on beyond the map's edges.
    own_sectors : callable, optional
        The module's views of a map's sectors, which these take to each other, where sectors are grids.
    own_direction, own_uv, solid_angle, wrap_sheets : callable
        The module's four functions with their parameters filled in, in the map's own axes.
    """

    name: str
    own_direction: DirectionFromUv
    own_uv: UvFromDirection
    wrap_sheets: WrapSheets
    solid_angle: Callable[[int, int], Array]
    frame: Array
    sheets: tuple[str, ...] = ("",)
    aspect: int = 1
    disk: float = np.inf
    goes_on: bool = False
    blind_angle: float = 0.0
    symmetric: bool = False
    own_grid: DirectionOfGrid | None = None
    own_sectors: Callable[[Array], Sectors] | None = None

    def shape(self, size: int) -> tuple[int, int, int]:
        """The shape of a map, without its channels.

        Parameters
        ----------
        size : int
            Width of a sheet in texels.

        Returns
        -------
        sheets, height, width : int

        Raises
        ------
        RangeError
            No map of this kind is so wide.
        """
        if size < 1 or size % self.aspect:
            raise RangeError(
                f"A map of kind {self.name} cannot be {size} texels wide: choose a multiple of {self.aspect}."
            )
        return len(self.sheets), size // self.aspect, size

    def direction_from_uv(self, uv: ArrayLike, sheet: Indices) -> Array:
        """The directions that points of a map show.

        Parameters
        ----------
        uv : array_like, shape (..., 2)
            Coordinates on the sheet, in [0, 1].
        sheet : ndarray of int, broadcastable to uv's shape (...,)

        Returns
        -------
        ndarray, shape (..., 3), float64
            Unit directions in world coordinates.
        """
        direction = self.own_direction(uv, sheet)
        return direction if self.frame is WORLD else direction @ self.frame.T

    def direction_of_grid(self, u: Array, v: Array, sheet: int) -> Array:
        """The directions that a grid of points shows.

        Parameters
        ----------
        u : ndarray, shape (columns,)
        v : ndarray, shape (rows,)
            Coordinates of its columns and rows on the sheet, in [0, 1].
        sheet : int

        Returns
        -------
        ndarray, shape (rows, columns, 3), float64
            As those of `direction_from_uv`.
        """
        if self.own_grid is None:
            return self.direction_from_uv(np.stack(np.meshgrid(u, v), axis=-1), np.array(sheet))
        direction = self.own_grid(u, v)
        return direction if self.frame is WORLD else direction @ self.frame.T

    def sectors(self, image: Array) -> Sectors:
        """The sectors of a map, or the whole map alone, where it has none.

        Parameters
        ----------
        image : ndarray, shape (sheets, height, width, channels)
        """
        if self.own_sectors is None or image.shape[2] % 8:
            return [(WORLD, image)]
        return self.own_sectors(image)

    def is_symmetric(self, size: int) -> bool:
        """Whether a map, `size` texels wide, is `symmetric`, and so has `turned_texels`."""
        return self.symmetric and size % 4 == 0

    def turned_texels(self, texel: Indices, size: int, matrices: Array) -> Indices:
        """Where texels come to lie when a `symmetric` map is turned or mirrored.

        Parameters
        ----------
        texel : ndarray of int, shape (N,)
            Numbers of texels, sheet by sheet and row by row.
        size : int
            Width of a sheet in texels.
        matrices : ndarray, shape (turns, 3, 3)
            New directions from old ones.

        Returns
        -------
        ndarray of int, shape (turns, N)
        """
        _, height, width = shape = self.shape(size)
        sheet, row, column = np.unravel_index(texel, shape)
        centre = np.stack([(column + 0.5) / width, (row + 0.5) / height], axis=-1)
        # Texels' centres meet
        uv, on = self.uv_from_direction(self.direction_from_uv(centre, sheet) @ matrices.mT)
        columns, rows = np.moveaxis(np.floor(uv * (width, height)).astype(np.intp), -1, 0)
        turned: Indices = (on * height + rows) * width + columns
        return turned

    def uv_from_direction(self, direction: ArrayLike) -> tuple[Array, Indices]:
        """The inverse of `direction_from_uv`; directions in the blind spot are taken to its edge."""
        direction = np.asarray(direction, dtype=np.float64)
        return self.own_uv(direction if self.frame is WORLD else direction @ self.frame)

    def shows(self, direction: ArrayLike) -> NDArray[np.bool]:
        """Whether unit directions in world coordinates, shape (..., 3), lie outside the blind spot."""
        if self.blind_angle == 0.0:  # rounding shall hide nothing
            return np.ones(np.shape(direction)[:-1], dtype=np.bool)
        towards_blind = -np.asarray(direction) @ self.frame[:, 2]
        shown: NDArray[np.bool] = towards_blind <= np.cos(self.blind_angle)
        return shown

    def texel_solid_angle(self, size: int) -> Array:
        """Solid angle of every texel, for a width as that of `shape`.

        Returns
        -------
        ndarray, shape (sheets, height, width), float64
            [sr]; sums to 4 pi less the blind spot. It is 0 outside the disk of a map that has one: such
            texels serve lookups across the rim alone.

        Raises
        ------
        RangeError
            See `shape`.
        """
        shape = self.shape(size)
        return self.solid_angle(shape[2], shape[1]).reshape(shape)

    def texel_directions(self, size: int) -> Array:
        """Unit direction of every texel's centre in world coordinates, shape (sheets, height, width, 3).

        Raises
        ------
        RangeError
            See `shape`.
        """
        sheets, height, width = self.shape(size)
        uv = np.broadcast_to(texel_centres(width, height), (sheets, height, width, 2))
        return self.direction_from_uv(uv, np.arange(sheets)[:, None, None])

    def wrap(
        self, columns: Indices, rows: Indices, sheet: Indices, width: int, height: int
    ) -> tuple[Indices, Indices, Indices]:
        """Texel that a lookup beyond a sheet's edge falls on.

        Parameters
        ----------
        columns, rows, sheet : ndarray of int, any shape
            Texel indices, at most one sheet's size outside the sheet.
        width, height : int
            Size of a sheet.

        Returns
        -------
        columns, rows, sheet : ndarray of int
            Indices within a sheet; a negative sheet where there is no texel.
        """
        return self.wrap_sheets(columns, rows, sheet, width, height)


def representation(name: str, **parameters: float) -> Representation:
    """A map representation by its name.

    Parameters
    ----------
    name : str
        One of `REPRESENTATIONS`.
    **parameters : float
        `distance` of a mirror_ball (default: infinite), `overscan` of a dual_paraboloid (1).

    Raises
    ------
    RangeError
        There is no such representation, or a parameter is out of its range.
    """
    if name not in REPRESENTATIONS:
        raise RangeError(f"There are no maps of kind {name}: choose one of {', '.join(REPRESENTATIONS)}.")
    return REPRESENTATIONS[name](**parameters)


def _one_sheet(
    direction_from_uv: Callable[[ArrayLike], Array],
    uv_from_direction: Callable[[ArrayLike], Array],
    wrap: Callable[[Indices, Indices, int, int], tuple[Indices, Indices]],
) -> tuple[DirectionFromUv, UvFromDirection, WrapSheets]:
    """The functions of a map without sheets, with a sheet added."""

    def uv_on_sheet(direction: ArrayLike) -> tuple[Array, Indices]:
        uv = uv_from_direction(direction)
        return uv, np.zeros(uv.shape[:-1], dtype=np.intp)

    return (
        lambda uv, sheet: direction_from_uv(uv),
        uv_on_sheet,
        lambda columns, rows, sheet, width, height: (*wrap(columns, rows, width, height), sheet),
    )


def _equirect() -> Representation:
    functions = _one_sheet(equirect.direction_from_uv, equirect.uv_from_direction, equirect.wrap)
    return Representation(
        "equirect",
        *functions,
        equirect.texel_solid_angle,
        WORLD,
        aspect=2,
        symmetric=True,
        own_grid=equirect.direction_of_grid,
        own_sectors=equirect.sectors,
    )


def _sphere_map() -> Representation:
    functions = _one_sheet(sphere_map.direction_from_uv, sphere_map.uv_from_direction, sphere_map.wrap)
    return Representation(
        "sphere_map", *functions, lambda n, _: sphere_map.texel_solid_angle(n), FRONT, disk=1.0
    )


def _mirror_ball(distance: float = np.inf) -> Representation:
    functions = _one_sheet(
        partial(mirror_ball.direction_from_uv, distance=distance),
        partial(mirror_ball.uv_from_direction, distance=distance),
        mirror_ball.wrap,
    )
    return Representation(
        "mirror_ball",
        *functions,
        lambda n, _: mirror_ball.texel_solid_angle(n, distance),
        FRONT,
        disk=1.0,
        blind_angle=mirror_ball.blind_angle(distance),
    )


def _angular_map() -> Representation:
    functions = _one_sheet(angular_map.direction_from_uv, angular_map.uv_from_direction, angular_map.wrap)
    return Representation(
        "angular_map", *functions, lambda n, _: angular_map.texel_solid_angle(n), FRONT, disk=1.0
    )


def _octahedral() -> Representation:
    functions = _one_sheet(octahedral.direction_from_uv, octahedral.uv_from_direction, octahedral.wrap)
    return Representation(
        "octahedral", *functions, lambda n, _: octahedral.texel_solid_angle(n), WORLD, symmetric=True
    )


def _dual_paraboloid(overscan: float = 1.0) -> Representation:
    return Representation(
        "dual_paraboloid",
        partial(dual_paraboloid.direction_from_uv, overscan=overscan),
        partial(dual_paraboloid.uv_from_direction, overscan=overscan),
        dual_paraboloid.wrap,
        lambda n, _: dual_paraboloid.texel_solid_angle(n, overscan),
        FRONT,
        dual_paraboloid.SHEETS,
        disk=dual_paraboloid.disk_radius(overscan),
        goes_on=True,
    )


def _orthographic() -> Representation:
    return Representation(
        "orthographic",
        orthographic.direction_from_uv,
        orthographic.uv_from_direction,
        orthographic.wrap,
        lambda n, _: orthographic.texel_solid_angle(n),
        FRONT,
        orthographic.SHEETS,
        disk=1.0,
    )


def _cube_map() -> Representation:
    return Representation(
        "cube_map",
        cube_map.direction_from_uv,
        cube_map.uv_from_direction,
        cube_map.wrap,
        lambda n, _: cube_map.texel_solid_angle(n),
        WORLD,
        cube_map.SHEETS,
        symmetric=True,
    )


REPRESENTATIONS: dict[str, Callable[..., Representation]] = {
    "equirect": _equirect,
    "sphere_map": _sphere_map,
    "mirror_ball": _mirror_ball,
    "angular_map": _angular_map,
    "dual_paraboloid": _dual_paraboloid,
    "orthographic": _orthographic,
    "cube_map": _cube_map,
    "octahedral": _octahedral,
}
"""Name -> function that makes the representation from its parameters."""
