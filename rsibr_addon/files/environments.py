"""Environments from disk: OpenEXR and Radiance HDR."""

import os
from pathlib import Path

from ..core.environment import Environment, environment_from_pixels
from .radiance_pictures import read_radiance


def read_environment(path: str | Path, clamp: float | None = None) -> Environment:
    """Read a latitude-longitude map of incoming radiance.

    Parameters
    ----------
    path : str or Path
        OpenEXR or Radiance HDR, recognised by its first bytes, not by its name.
    clamp : float, optional
        See `core.environment.usable_radiance`.

    Returns
    -------
    Environment
        Named as the file.

    Raises
    ------
    InputFileError
        The file is missing, unreadable, of another format, truncated or damaged, has no colour, is not
        twice as wide as high, or holds no finite value.

    Warns
    -----
    RsibrWarning
        See `core.environment.usable_radiance`.
    """
    # A name that is not UTF-8 could not be written into a map set
    name = os.fsencode(Path(path).name).decode("utf-8", "replace")
    return environment_from_pixels(read_radiance(path), name, clamp)
