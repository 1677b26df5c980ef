"""Folders for temporary files, which are removed even if their process is killed, and report a full disk."""

import contextlib
import os
import tempfile
from collections.abc import Iterator
from pathlib import Path

from ..core.errors import InputFileError, NotNowError, OutputFileError, RenderError
from .staging import is_staging_folder, staging_folder

_PROBE_BYTES = 65536


@contextlib.contextmanager
def temporary_folder() -> Iterator[Path]:
    """A new folder for temporary files, removed after the body.

    Yields
    ------
    Path

    Raises
    ------
    OutputFileError
        The disk with temporary files is full, or takes none.
    """
    with contextlib.ExitStack() as stack:
        try:
            folder = stack.enter_context(staging_folder(Path(tempfile.gettempdir())))
        except OSError as error:
            raise OutputFileError(
                f"No temporary files can be written ({error.strerror}): free some space, or set TMPDIR to "
                f"another folder."
            ) from error
        try:
            yield folder
        except (InputFileError, RenderError, OSError) as error:
            # Blender does not report that it wrote half a file; its reader then calls it damaged
            if _is_full(folder):
                # A command has its own folder in the user's
                place = next(each for each in folder.parents if not is_staging_folder(each))
                raise NotNowError(
                    f"The disk with the temporary files is full ({place}): free some space there, or set "
                    f"TMPDIR to another folder."
                ) from error
            raise


def _is_full(folder: Path) -> bool:
    try:
        with (folder / "probe").open("wb") as file:
            file.write(bytes(_PROBE_BYTES))
            os.fsync(file.fileno())
    except OSError:
        return True
    return False
