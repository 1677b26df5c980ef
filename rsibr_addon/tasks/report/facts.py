"""Facts of map sets for panels; a file is read again only after it has changed."""

import os
from collections.abc import Callable
from functools import lru_cache, wraps
from pathlib import Path
from typing import Any

from ...core.lobes.fit import Fit
from ...files.kinds import environment
from ...files.kinds.registry import STORED
from ...files.map_set import read_map_set_header
from ...files.map_set_facts import told_errors, told_facts
from ...files.map_set_header import content_hash
from ...files.pictures import split_layer


def read_once[*More, Told](read: Callable[[Path, *More], Told]) -> Callable[[Path, *More], Told]:
    """Make a function of a file remember its result until the file's time or size changes.

    Parameters
    ----------
    read : callable
        Takes the path of a file, that need not be there, or FILE.exr:LAYER, and perhaps more that can be
        hashed. What it raises is not kept.
    """

    @lru_cache(maxsize=16)
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


@read_once
def map_set_header(path: Path) -> dict[str, Any]:
    """The description of a map set; not to be changed.

    Raises
    ------
    MapSetError
        See `files.map_set.read_map_set_header`; so with all others here.
    """
    return read_map_set_header(path)


@read_once
def is_picture(path: Path) -> bool:
    """Whether a file that shades is no map set, but a picture of an environment."""
    return environment.is_environment(path)


@read_once
def map_set_content(path: Path) -> str:
    """Hash of what a map set holds: see `files.map_set_header.content_hash`."""
    return content_hash(map_set_header(path))


@read_once
def map_set_fit(path: Path) -> Fit | None:
    """The lobes that a map set was made of; None where there are none, or it does not tell them."""
    header = map_set_header(path)
    return STORED[header["kind"]].lobes(path, header)


@read_once
def map_set_facts(path: Path) -> dict[str, str]:
    """What a map set is and promises: see `files.map_set_facts`."""
    header = map_set_header(path)
    return told_facts(header) | told_errors(header)
