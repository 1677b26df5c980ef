"""Binary files of the MERL BRDF database."""

import struct
from pathlib import Path

import numpy as np

from ..core.brdf.measured_merl import SHAPE, below_horizon, merl_brdf
from ..core.brdf.tabulated import Tabulated
from ..core.conventions import Array
from ..core.errors import InputFileError
from ..core.warned import warn
from .reading import opened

HEADER = struct.Struct("<3i")
SIZE = HEADER.size + 3 * 8 * SHAPE[0] * SHAPE[1] * SHAPE[2]
"""Bytes of every file of the format: three counts, then red, green and blue as doubles."""


def read_merl(path: str | Path) -> Tabulated:
    """Read a measured reflectance of the MERL database.

    Parameters
    ----------
    path : str or Path
        A `.binary` file.

    Returns
    -------
    Tabulated
        Its spec is `merl:path=` and the path.

    Raises
    ------
    InputFileError
        The file is missing or unreadable, states other counts than 90, 90 and 180, is shorter or longer than
        these require, or holds no measurement.

    Warns
    -----
    RsibrWarning
        Cells above the horizon are negative or NaN, which marks them as not measured; the message counts
        them. They take the value of the nearest measured azimuth.
    """
    samples = _read_samples(path)
    missing = ~(samples >= 0.0).all(axis=3)
    samples[missing] = np.nan
    unexpected = int(np.count_nonzero(missing & ~below_horizon()))
    if missing.all():
        raise InputFileError(f"{path} holds no measurement at all: fetch it again.")
    if unexpected:
        warn(
            f"{path} lacks {unexpected} measurements above the horizon (negative, NaN or infinite); "
            f"each is taken from its neighbour in azimuth."
        )
    return merl_brdf(samples, f"merl:path={path}")


def _read_samples(path: str | Path) -> Array:
    with opened(path) as stream:
        header = stream.read(HEADER.size)
        if len(header) < HEADER.size or HEADER.unpack(header) != SHAPE:
            raise InputFileError(f"{path} is no MERL measurement of 90 x 90 x 180 angles: give another file.")
        data = stream.read(SIZE)
    if len(data) != SIZE - HEADER.size:
        found = "longer" if len(data) > SIZE - HEADER.size else "shorter"
        raise InputFileError(
            f"{path} is {found} than the {SIZE} bytes of a MERL measurement: fetch it again."
        )
    channels = np.frombuffer(data, "<f8").reshape(3, *SHAPE)
    return np.moveaxis(np.where(np.isfinite(channels), channels, np.nan), 0, 3).copy()
