"""Pictures of light in whatever format they come."""

from pathlib import Path

from ..core.conventions import Array
from ..core.environment import usable_radiance
from ..files.radiance_pictures import holds_radiance, read_radiance


def read_light(path: Path) -> Array:
    """Read a picture as radiance.

    Parameters
    ----------
    path : Path
        OpenEXR or Radiance HDR, or a picture of 8 or 16 bits, whose curve is undone.

    Returns
    -------
    ndarray, shape (height, width, 3), float32
        Linear Rec. 709, at least 0, row 0 at the bottom.

    Raises
    ------
    InputFileError
        The file is missing or unreadable, or holds NaN or infinite values.

    Warns
    -----
    RsibrWarning
        Negative values were set to 0; says how many.
    """
    if holds_radiance(path):
        return usable_radiance(read_radiance(path), path.name)
    # Only such pictures need Blender, which takes a second to start
    from ..host.photographs import read_photograph

    return read_photograph(path)
