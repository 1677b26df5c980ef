"""Pictures of light in whatever format they come."""

from pathlib import Path

from ..core.conventions import Array
from ..core.environment import usable_radiance
from ..files.photographs import read_photograph
from ..files.radiance_pictures import holds_radiance, read_radiance


def read_light(path: Path, clamp: float | None = None) -> Array:
    """Read a picture as radiance.

    Parameters
    ----------
    path : Path
        OpenEXR or Radiance HDR, or a picture of 8 or 16 bits, whose curve is undone.
    clamp : float, optional
        See `usable_radiance`.

    Returns
    -------
    ndarray, shape (height, width, 3), float32
        Linear Rec. 709, at least 0, row 0 at the bottom.

    Raises
    ------
    InputFileError
        The file is missing or unreadable, or holds no finite value.

    Warns
    -----
    RsibrWarning
        See `usable_radiance` and `read_photograph`.
    """
    if holds_radiance(path):
        return usable_radiance(read_radiance(path), path.name, clamp)
    return usable_radiance(read_photograph(path).radiance(), path.name, clamp)
