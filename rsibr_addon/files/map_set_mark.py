"""What tells a map set from a picture: it describes itself."""

from pathlib import Path

from .exr import MAGIC, OpenExr
from .reading import opened

ATTRIBUTE = "rsibr"
"""Name of the first part's string attribute that holds the description, as JSON."""


def description(file: OpenExr) -> str | None:
    """The first part's description, unchecked; None where there is none."""
    text = file.headers[0].get(ATTRIBUTE) if file.headers else None
    return text if isinstance(text, str) else None


def is_map_set(path: str | Path) -> bool:
    """Whether a file describes itself as a map set, even with a bad description.

    Returns
    -------
    bool
        False for anything but OpenEXR.

    Raises
    ------
    InputFileError
        The file is missing, unreadable, or damaged in its headers.
    """
    with opened(path) as stream:
        return stream.read(len(MAGIC)) == MAGIC and description(OpenExr(path, stream)) is not None
