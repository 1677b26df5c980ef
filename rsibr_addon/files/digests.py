"""Hashes of files."""

import hashlib
from pathlib import Path

from .read_once import read_once


@read_once
def digest(path: Path) -> str:
    """SHA-256 of a file, as hexadecimal digits; computed again only after the file has changed.

    Raises
    ------
    OSError
        It cannot be read.
    """
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()
