"""Outputs that leave what they are made of as it is."""

from collections.abc import Iterable
from pathlib import Path

from ..core.errors import OutputFileError
from .pictures import split_layer


def check_apart(output: str | Path, sources: Iterable[Path]) -> None:
    """Refuse an output that would take the place of what it is made of, before long work begins.

    Parameters
    ----------
    output : str or Path
        The file or folder that will be written.
    sources : iterable of Path
        Files that the work reads, or layers of files: see `split_layer`.

    Raises
    ------
    OutputFileError
        One of them is `output`, or in it.
    """
    target = Path(output).resolve()
    for source in sources:
        file, _ = split_layer(source)
        if file.resolve().is_relative_to(target):
            raise OutputFileError(f"{output} would replace {file}, of which it is made: give another name.")
