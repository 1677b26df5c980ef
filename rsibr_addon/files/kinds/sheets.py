"""Maps of several square sheets as one picture."""

from ...core.conventions import Array
from ...core.errors import ShapeError


def strip_from_sheets(sheets: Array) -> Array:
    """Sheets below each other, the first at the top.

    Parameters
    ----------
    sheets : ndarray, shape (sheets, height, width, 3)
        Each with its row 0 at the bottom.

    Returns
    -------
    ndarray, shape (sheets * height, width, 3)
        Row 0 at the bottom.
    """
    return sheets[::-1].reshape(-1, *sheets.shape[2:])


def sheets_from_strip(strip: Array, shape: tuple[int, int, int]) -> Array:
    """The inverse of `strip_from_sheets`.

    Parameters
    ----------
    strip : ndarray, shape (sheets * height, width, 3)
    shape : tuple of three int
        Sheets, height and width.

    Returns
    -------
    ndarray, shape (sheets, height, width, 3)

    Raises
    ------
    ShapeError
        The picture has another size.
    """
    count, height, width = shape
    if strip.shape[:2] != (count * height, width):
        raise ShapeError(f"A map of {width}x{strip.shape[0]} does not have {count} sheets: bake it again.")
    return strip.reshape(*shape, -1)[::-1]
