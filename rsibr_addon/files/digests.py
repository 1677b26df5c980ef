"""Hashes of files."""

import hashlib
from functools import partial
from pathlib import Path

from .read_once import read_once
from .reading import opened

MOST = 4096
"""Hashes that are kept. All images of a scene are looked at in turn: with fewer, each would be read anew."""


@partial(read_once, most=MOST)
def digest(path: Path) -> str:
    """SHA-256 of a file, as hexadecimal digits; computed again only after the file has changed.

    Raises
    ------
    InputFileError
        It cannot be read.
    """
    with opened(path) as file:
        return hashlib.file_digest(file, "sha256").hexdigest()
