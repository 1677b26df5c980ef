"""Sets of view directions as people write them: as text, or as JSON."""

from pathlib import Path

import numpy as np

from ..core.conventions import Array
from ..core.errors import InputFileError, RangeError, SchemaError, ShapeError
from ..core.geometry.view_sphere import view_sphere
from ..core.schema import decode, loads
from .ball_list import Triple
from .reading import opened, text_of

LARGEST = 1 << 20
"""Largest file in bytes."""


def read_view_dirs(path: str | Path) -> Array:
    """Read a set of view directions.

    Parameters
    ----------
    path : str or Path
        JSON: a list of lists of three numbers. Or text: three numbers a line, between them spaces, commas or
        semicolons; a comment follows #.

    Returns
    -------
    ndarray, shape (V, 3), float64
        Unit vectors from the object to the camera.

    Raises
    ------
    InputFileError
        The file is missing or unreadable, holds something else, or see `view_sphere`.
    """
    with opened(path) as stream:
        data = stream.read(LARGEST)
    text = text_of(data, "replace")
    try:
        rows = decode(list[Triple], loads(text)) if text.lstrip().startswith("[") else _rows(text)
        return view_sphere(np.array(rows, dtype=np.float64)).vertices
    except (RangeError, ShapeError) as error:
        raise InputFileError(f"{path}: {error}") from error
    except (SchemaError, ValueError) as error:
        raise InputFileError(
            f"{path} is no list of view directions: write three numbers a line, as 0 -1 0.5, or "
            f"[[0, -1, 0.5], ...]."
        ) from error


def _rows(text: str) -> list[list[float]]:
    lines = (line.partition("#")[0].replace(",", " ").replace(";", " ").split() for line in text.splitlines())
    return [[float(number) for number in line] for line in lines if line]
