"""Several pictures in one."""

from collections.abc import Sequence

import numpy as np

from ...core.conventions import Array


def contact_sheet(pictures: Sequence[Array], columns: int) -> Array:
    """Put pictures side by side in rows, the first at the top left.

    Parameters
    ----------
    pictures : sequence of ndarray, each of shape (height, width, channels)
        At least one.
    columns : int
        Pictures in a full row; fewer pictures make one shorter row.

    Returns
    -------
    ndarray, shape (rows * height, columns * width, channels), float32
        Row 0 at the bottom, places without a picture 0.
    """
    height, width, channels = pictures[0].shape
    columns = min(len(pictures), columns)
    rows = -(-len(pictures) // columns)
    sheet = np.zeros((rows, height, columns, width, channels), dtype=np.float32)
    for number, picture in enumerate(pictures):
        row, column = divmod(number, columns)
        sheet[rows - 1 - row, :, column] = picture
    return sheet.reshape(rows * height, columns * width, channels)
