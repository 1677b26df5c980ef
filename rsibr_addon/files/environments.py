"""Environments from disk: OpenEXR and Radiance HDR."""

from pathlib import Path

import numpy as np

from ..core.environment import Environment, environment_from_pixels
from ..core.errors import InputFileError
from . import exr, radiance_hdr
from .pictures import read_exr
from .reading import opened


def read_environment(path: str | Path) -> Environment:
    """Read a latitude-longitude map of incoming radiance.

    Parameters
    ----------
    path : str or Path
        OpenEXR or Radiance HDR, told by its first bytes, not by its name.

    Returns
    -------
    Environment
        Named as the file.

    Raises
    ------
    InputFileError
        The file is missing, unreadable, of another format, truncated or damaged, has no colour, is not
        twice as wide as high, or holds NaN or infinite values.

    Warns
    -----
    RsibrWarning
        Negative values were set to 0; says how many.
    """
    with opened(path) as stream:
        start = stream.read(max(len(exr.MAGIC), len(radiance_hdr.MAGIC)))
    if start.startswith(exr.MAGIC):
        pixels = read_exr(path)[..., :3]
    elif start.startswith(radiance_hdr.MAGIC):
        pixels = radiance_hdr.read_hdr(path)
    else:
        raise InputFileError(f"{path} is neither OpenEXR nor Radiance HDR: convert it to one of them.")
    height, width = pixels.shape[:2]
    return environment_from_pixels(np.broadcast_to(pixels, (height, width, 3)), Path(path).name)
