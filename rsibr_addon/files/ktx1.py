"""Cubes as KTX 1 textures of packed floats, as Filament reads them: the Khronos Group's format of 2010."""

import struct
from collections.abc import Mapping, Sequence
from pathlib import Path

from ..core.conventions import Array
from ..core.packed_floats import packed_r11g11b10
from .atomic import written_aside

IDENTIFIER = b"\xabKTX 11\xbb\r\n\x1a\n"

R11F_G11F_B10F, RGB = 0x8C3A, 0x1907
"""OpenGL's numbers."""

_HEADER = struct.Struct("<12s13I")
_SIZE = struct.Struct("<I")


def write_ktx1(
    path: str | Path, mips: Sequence[Array], notes: Mapping[str, str], force: bool = False
) -> None:
    """Write a cube in R11F_G11F_B10F: see `core.packed_floats`.

    Parameters
    ----------
    path : str or Path
        Usually NAME.ktx.
    mips : sequence of ndarray, shape (6, n, n, 3)
        Faces of `core.maps.cube_map`, n a half from mip to mip; from 0 to `core.packed_floats.LARGEST`.
    notes : mapping of str to str
        Texts by their keys.
    force : bool
        Whether an existing file is replaced.

    Raises
    ------
    OutputFileError
        See `written_aside`.

    Notes
    -----
    As cmgen writes them: the field for the type of texels holds the internal format, and texts do not end
    with a zero. Filament reads them so.
    """
    noted = b"".join(_note(key, value) for key, value in notes.items())
    size = mips[0].shape[1]
    head = _HEADER.pack(
        IDENTIFIER,
        *(0x04030201, R11F_G11F_B10F, 1, RGB, R11F_G11F_B10F, R11F_G11F_B10F),
        *(size, size, 0),
        *(0, 6, len(mips), len(noted)),
    )
    with written_aside(path, force) as aside, aside.open("wb") as file:
        file.write(head + noted)
        for faces in mips:
            texels = packed_r11g11b10(faces).astype("<u4")
            file.write(_SIZE.pack(texels[0].nbytes))
            file.write(texels.tobytes())


def _note(key: str, value: str) -> bytes:
    pair = f"{key}\0{value}".encode()
    return _SIZE.pack(len(pair)) + pair + bytes(-len(pair) % 4)
