"""The turn that makes a photograph upright, as Exif numbers it."""

from dataclasses import dataclass

from ..core.conventions import Array


@dataclass(frozen=True)
class Orientation:
    """The change that makes a stored picture upright: it may be transposed first, then mirrored.

    Attributes
    ----------
    transposed : bool
        Whether rows become columns.
    mirrored, flipped : bool
        Whether, after that, left and right, or top and bottom, change places.
    """

    transposed: bool = False
    mirrored: bool = False
    flipped: bool = False

    def upright(self, stored: Array) -> Array:
        """The upright picture.

        Parameters
        ----------
        stored : ndarray, shape (height, width, ...)
            Row 0 at the top.

        Returns
        -------
        ndarray, shape (height, width, ...) or (width, height, ...)
            A view of `stored`; row 0 at the top.
        """
        turned = stored.swapaxes(0, 1) if self.transposed else stored
        return turned[:: -1 if self.flipped else 1, :: -1 if self.mirrored else 1]

    def upright_point(self, x: float, y: float, width: float, height: float) -> tuple[float, float]:
        """A point of the stored picture in the upright one.

        Parameters
        ----------
        x, y : float
            In pixels from the top left corner of the stored picture.
        width, height : float
            Size of the upright picture.

        Returns
        -------
        tuple of 2 floats
            In pixels from the top left corner of the upright picture.
        """
        x, y = (y, x) if self.transposed else (x, y)
        return width - x if self.mirrored else x, height - y if self.flipped else y

    def stored_point(self, x: float, y: float, width: float, height: float) -> tuple[float, float]:
        """The inverse of `upright_point`, with the same `width` and `height`."""
        x, y = width - x if self.mirrored else x, height - y if self.flipped else y
        return (y, x) if self.transposed else (x, y)


ORIENTATIONS = {
    1: Orientation(),
    2: Orientation(mirrored=True),
    3: Orientation(mirrored=True, flipped=True),
    4: Orientation(flipped=True),
    5: Orientation(transposed=True),
    6: Orientation(transposed=True, mirrored=True),
    7: Orientation(transposed=True, mirrored=True, flipped=True),
    8: Orientation(transposed=True, flipped=True),
}
"""Orientations by Exif's number; 0 and numbers beyond say nothing."""
