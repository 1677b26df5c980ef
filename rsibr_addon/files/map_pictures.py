"""Maps as pictures: a file for each sheet, or the faces of a cube as a cross or a strip in one."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from ..core.conventions import Array
from ..core.errors import InputFileError, RangeError
from ..core.maps.representation import AHEAD, Representation, representation
from .outputs import together
from .radiance_pictures import check_radiance_target, write_radiance


@dataclass(frozen=True)
class Grid:
    """Places of a cube's faces in a picture of equal squares.

    Attributes
    ----------
    rows, columns : int
        Numbers of squares.
    places : tuple of six (int, int)
        Row from the top and column of each face, in the order of its sheets.
    turned : int or None
        A face that is upside down.
    """

    rows: int
    columns: int
    places: tuple[tuple[int, int], ...]
    turned: int | None = None


CROSSES = (
    Grid(3, 4, ((1, 2), (1, 0), (0, 1), (2, 1), (1, 1), (1, 3))),
    Grid(4, 3, ((1, 2), (1, 0), (0, 1), (2, 1), (1, 1), (3, 1)), turned=5),
)
"""Crosses with the face ahead, +Z, in the middle and the others around it as a viewer sees them; the first is
written."""

STRIPS = (
    Grid(1, 6, tuple((0, face) for face in range(6))),
    Grid(6, 1, tuple((face, 0) for face in range(6))),
)
"""Strips of the faces in their order; the first is written."""


@dataclass(frozen=True)
class Layout:
    """The layout of a map in pictures.

    Attributes
    ----------
    name : str
    representation : Representation
    grids : tuple of Grid
        Ways in which one picture may hold all sheets; empty where each sheet has a file of its own.
    """

    name: str
    representation: Representation
    grids: tuple[Grid, ...] = ()

    @property
    def is_cube(self) -> bool:
        """Whether the pictures are a cube's, which have OpenGL's row 0 at the top."""
        return self.representation.name == "cube_map"

    def paths(self, path: Path) -> list[Path]:
        """The files of a map.

        Parameters
        ----------
        path : Path
            Name of the whole map: NAME.exr.

        Returns
        -------
        list of Path
            `path` itself; or, where each sheet has a file, NAME-SHEET.exr for each.
        """
        if self.grids or len(self.representation.sheets) == 1:
            return [path]
        return [path.with_name(f"{path.stem}-{sheet}{path.suffix}") for sheet in self.representation.sheets]

    def whole(self, path: Path) -> Path:
        """The map that a file belongs to.

        Parameters
        ----------
        path : Path
            One of `paths`, as NAME-SHEET.exr; or already the name of the whole map.

        Returns
        -------
        Path
            The name that `paths` takes: NAME.exr.
        """
        name, _, sheet = path.stem.rpartition("-")
        is_sheet = len(self.paths(path)) > 1 and name and sheet in self.representation.sheets
        return path.with_name(name + path.suffix) if is_sheet else path


CUBES: dict[str, tuple[Grid, ...]] = {"cube_faces": (), "cube_cross": CROSSES, "cube_strip": STRIPS}


def layout(name: str, **parameters: float) -> Layout:
    """A layout by its name.

    Parameters
    ----------
    name : str
        One of `CUBES`, or of `core.maps.representation.REPRESENTATIONS` but the cube map.
    **parameters : float
        Parameters of the representation.

    Returns
    -------
    Layout
        Pictures of cubes are seen by a viewer who looks along +Y: `AHEAD`.

    Raises
    ------
    RangeError
        See `representation`.
    """
    if name in CUBES:
        return Layout(name, replace(representation("cube_map"), frame=AHEAD), CUBES[name])
    return Layout(name, representation(name, **parameters))


def fitting_layouts(path: Path, size: tuple[int, int]) -> tuple[str, ...]:
    """The layouts that a picture may have, by its shape and the files beside it.

    Parameters
    ----------
    path : Path
        One of a map's files.
    size : (int, int)
        Its width and height.

    Returns
    -------
    tuple of str
        The likeliest first: one of `LIKELY` each.
    """
    return tuple(name for name in LIKELY if _may_be(layout(name), path, size))


LIKELY = (
    "equirect",
    "cube_faces",
    "dual_paraboloid",
    "cube_cross",
    "cube_strip",
    "angular_map",
    "mirror_ball",
    "octahedral",
    "sphere_map",
)
"""Layouts that light is found in, the likeliest first among those of one shape."""


def _may_be(layout: Layout, path: Path, size: tuple[int, int]) -> bool:
    width, height = size
    if layout.grids:
        return any(
            width * grid.rows == height * grid.columns and width % grid.columns == 0 for grid in layout.grids
        )
    files = layout.paths(layout.whole(path))
    if len(files) > 1 and not (path in files and all(file.exists() for file in files)):
        return False
    return _fits(layout, size)


def read_map(path: Path, layout: Layout, read_picture: Callable[[Path], Array]) -> Array:
    """Read a map.

    Parameters
    ----------
    path : Path
        See `Layout.paths`.
    layout : Layout
    read_picture : callable
        Reads one file as radiance (height, width, 3), row 0 at the bottom.

    Returns
    -------
    ndarray, shape (sheets, height, width, 3), float32

    Raises
    ------
    InputFileError
        A file is missing, or its size does not fit the layout or the other files; or as `read_picture`.
    """
    paths = layout.paths(path)
    missing = [file.name for file in paths if not file.exists()]
    if missing and len(paths) > 1:
        raise InputFileError(
            f"{path} as {layout.name} is {len(paths)} files, of which {', '.join(missing)} "
            f"{'is' if len(missing) == 1 else 'are'} missing: give NAME.exr for {paths[0].name} and so on."
        )
    pictures = [read_picture(file) for file in paths]
    sizes = [picture.shape[1::-1] for picture in pictures]
    for file, size in zip(paths, sizes, strict=True):
        if size != sizes[0]:
            raise InputFileError(
                f"{file} is {size[0]}x{size[1]}, but {paths[0].name} is {sizes[0][0]}x{sizes[0][1]}: "
                f"the pictures of a map must be of one size."
            )
    if layout.grids:
        return _faces(path, layout, pictures[0])
    _check_shape(paths[0], layout, sizes[0])
    if len(pictures) == 1:  # not copied, as it may be large
        return pictures[0][None]
    return np.stack([picture[::-1] if layout.is_cube else picture for picture in pictures])


def write_map(path: Path, layout: Layout, image: Array, force: bool = False) -> list[Path]:
    """Write a map.

    Parameters
    ----------
    path : Path
        See `Layout.paths`; NAME.exr or NAME.hdr.
    layout : Layout
    image : ndarray, shape (sheets, height, width, 3)
    force : bool
        Whether existing files are replaced.

    Returns
    -------
    list of Path
        The files that were written.

    Raises
    ------
    OutputFileError, RangeError
        See `write_radiance`.
    """
    check_map_target(path, layout, force)
    if layout.grids:
        pictures = [_picture(layout.grids[0], image)]
    else:
        pictures = [sheet[::-1] if layout.is_cube else sheet for sheet in image]
    paths = layout.paths(path)
    with together():
        for file, picture in zip(paths, pictures, strict=True):
            write_radiance(file, picture, force)
    return paths


def check_map_target(path: Path, layout: Layout, force: bool = False, sources: Iterable[Path] = ()) -> None:
    """Refuse names that `write_map` would refuse, before long work begins.

    Parameters
    ----------
    path : Path
    layout : Layout
    force : bool
        Whether existing files may be replaced.
    sources : iterable of Path
        Files that the map is made of.

    Raises
    ------
    OutputFileError
        See `check_radiance_target`.
    """
    made_of = list(sources)
    for file in layout.paths(path):
        check_radiance_target(file, force, made_of)


def _fits(layout: Layout, size: tuple[int, ...]) -> bool:
    """Whether a sheet may be so large."""
    width, height = size
    try:
        return layout.representation.shape(width)[1] == height
    except RangeError:
        return False


def _check_shape(path: Path, layout: Layout, size: tuple[int, ...]) -> None:
    width, height = size
    if not _fits(layout, size):
        shape = "square" if layout.representation.aspect == 1 else "twice as wide as high"
        raise InputFileError(
            f"{path} is {width}x{height}, but {layout.name} is {shape}: check the layout, or crop it."
        )


def _faces(path: Path, layout: Layout, picture: Array) -> Array:
    """The faces in a picture; row 0 of each is its first row from the top."""
    height, width = picture.shape[:2]
    for grid in layout.grids:
        size = width // grid.columns
        if size > 0 and (height, width) == (grid.rows * size, grid.columns * size):
            squares = picture[::-1].reshape(grid.rows, size, grid.columns, size, 3)
            faces = np.stack([squares[row, :, column] for row, column in grid.places])
            if grid.turned is not None:
                faces[grid.turned] = faces[grid.turned, ::-1, ::-1]
            return faces
    shapes = " or ".join(f"{grid.columns}:{grid.rows}" for grid in layout.grids)
    raise InputFileError(
        f"{path} is {width}x{height}, but {layout.name} is six square faces in a picture of {shapes}: "
        f"check the layout, or crop it."
    )


def _picture(grid: Grid, faces: Array) -> Array:
    """A picture of faces, black where there is no face."""
    size = faces.shape[1]
    squares = np.zeros((grid.rows, size, grid.columns, size, 3))
    for face, (row, column) in zip(faces, grid.places, strict=True):
        squares[row, :, column] = face
    return squares.reshape(grid.rows * size, grid.columns * size, 3)[::-1]
