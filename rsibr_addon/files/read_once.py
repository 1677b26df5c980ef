"""What is told of a file is kept, and read again only after the file has changed."""

import os
from collections.abc import Callable
from functools import lru_cache, wraps
from pathlib import Path
from typing import TypeVar, TypeVarTuple

from .pictures import split_layer

More = TypeVarTuple("More")
Told = TypeVar("Told")


def read_once(read: Callable[[Path, *More], Told], most: int = 16) -> Callable[[Path, *More], Told]:
    """Make a function of a file remember its result until the file's time or size changes.

    Parameters
    ----------
    read : callable
        Takes the path of a file, that need not be there, or FILE.exr:LAYER, and perhaps more that can be
        hashed. What it raises is not kept.
    most : int
        How many results are kept.
    """

    @lru_cache(maxsize=most)
    def kept(stamp: tuple[int, int] | None, path: Path, more: tuple[*More]) -> Told:
        return read(path, *more)

    @wraps(read)
    def told(path: Path, *more: *More) -> Told:
        return kept(file_stamp(split_layer(path)[0]), path, more)

    return told


def file_stamp(path: Path) -> tuple[int, int] | None:
    """Time and size of a file, which tell whether it has changed; None where it is not there."""
    try:
        status = os.stat(path)
    except OSError:
        return None
    return status.st_mtime_ns, status.st_size
