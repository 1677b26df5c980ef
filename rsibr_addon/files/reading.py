"""Opening a file to read it, with a sentence for each obstacle, and its text."""

import codecs
import contextlib
from collections.abc import Iterator
from io import BufferedReader
from pathlib import Path

from ..core.errors import InputFileError
from ..core.schema import LARGEST_TEXT


@contextlib.contextmanager
def opened(path: str | Path) -> Iterator[BufferedReader]:
    """Open `path` for reading.

    Yields
    ------
    BufferedReader
        The file's bytes, from the first.

    Raises
    ------
    InputFileError
        The file is missing, a folder, a pipe or a device, which may never end; or the system refuses to read
        it, now or in the body.
    """
    path = Path(path)
    if path.is_dir():
        raise InputFileError(f"{path} is a folder: give the name of a file in it.")
    if path.exists() and not path.is_file():
        raise InputFileError(f"{path} is a pipe or a device, not a file: save it as a file first.")
    try:
        with path.open("rb") as stream:
            yield stream
    except (FileNotFoundError, NotADirectoryError) as error:
        there = Path(str(path).replace("\\", "/"))
        if there != path and there.exists():
            raise InputFileError(f"{path} does not exist, but {there} does: write / for \\.") from error
        raise InputFileError(f"{path} does not exist: check the name and the folder.") from error
    except OSError as error:
        raise InputFileError(f"{path} cannot be read ({error.strerror}): check its permissions.") from error


def read_text(path: str | Path) -> str:
    """Read a text that people write: see `text_of`.

    Raises
    ------
    InputFileError
        See `opened`; or the file is longer than `core.schema.LARGEST_TEXT`.
    UnicodeDecodeError
        It is no text.
    """
    with opened(path) as stream:
        data = stream.read(LARGEST_TEXT + 1)
    if len(data) > LARGEST_TEXT:
        raise InputFileError(
            f"{path} is longer than {LARGEST_TEXT // 2**20} MiB, so no text for this: give another file."
        )
    return text_of(data)


def text_of(data: bytes, errors: str = "strict") -> str:
    """The text of a file that people write: UTF-8, or UTF-16 with its mark, as Windows' programs save it.

    Parameters
    ----------
    data : bytes
    errors : str
        What becomes of bytes that are no text, as `bytes.decode` has it.

    Raises
    ------
    UnicodeDecodeError
    """
    is_utf16 = data.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE))
    return data.decode("utf-16" if is_utf16 else "utf-8-sig", errors)
