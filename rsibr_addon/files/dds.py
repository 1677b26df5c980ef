"""Cubes as DDS textures with the header of DirectX 10: half floats, or compressed as BC6H."""

import struct
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from ..core.bc6h.encode import bc6h_blocks
from ..core.conventions import Array
from .atomic import written_aside

RGBA16F, BC6H_UF16, BC6H_SF16 = 10, 95, 96
"""DXGI's numbers of formats."""

_HEADER = struct.Struct("<4s7I44x8I5I5I")
_CAPS, _HEIGHT, _WIDTH, _PITCH, _FORMAT, _MIPS, _LINEAR_SIZE = 0x1, 0x2, 0x4, 0x8, 0x1000, 0x20000, 0x80000
_COMPLEX, _TEXTURE, _MIPMAP = 0x8, 0x1000, 0x400000
_CUBE, _ALL_FACES = 0x200, 0xFC00
_FOUR_CC, _TEXTURE_2D, _IS_CUBE = 0x4, 3, 0x4


def write_dds(path: str | Path, mips: Sequence[Array], compressed: bool, force: bool = False) -> None:
    """Write a cube.

    Parameters
    ----------
    path : str or Path
        Usually NAME.dds.
    mips : sequence of ndarray, shape (6, n, n, 3)
        Faces of `core.maps.cube_map`, n a half from mip to mip; within `core.bc6h.encode.LARGEST`.
    compressed : bool
        BC6H, a byte a texel: unsigned, where no value is negative. Else half floats, eight bytes; alpha is 1.
    force : bool
        Whether an existing file is replaced.

    Raises
    ------
    OutputFileError
        See `written_aside`.

    Notes
    -----
    Face by face with all mips of each, each in rows from v = 0, which Direct3D and OpenGL call the first.
    """
    size = mips[0].shape[1]
    signed = any(bool((faces < 0.0).any()) for faces in mips)
    if compressed:
        texels = [[bc6h_blocks(face, signed) for face in faces] for faces in mips]
        stated, of_rows = BC6H_SF16 if signed else BC6H_UF16, (_LINEAR_SIZE, texels[0][0].nbytes)
    else:
        texels = [[*_with_alpha(faces)] for faces in mips]
        stated, of_rows = RGBA16F, (_PITCH, 8 * size)
    header = _HEADER.pack(
        b"DDS ",
        *(124, _CAPS | _HEIGHT | _WIDTH | _FORMAT | _MIPS | of_rows[0], size, size, of_rows[1], 0, len(mips)),
        *(32, _FOUR_CC, int.from_bytes(b"DX10", "little"), 0, 0, 0, 0, 0),
        *(_COMPLEX | _TEXTURE | _MIPMAP, _CUBE | _ALL_FACES, 0, 0, 0),
        *(stated, _TEXTURE_2D, _IS_CUBE, 1, 0),
    )
    with written_aside(path, force) as aside, aside.open("wb") as file:
        file.write(header)
        for face in range(6):
            for level in texels:
                file.write(level[face].tobytes())


def _with_alpha(faces: Array) -> Array:
    texels = np.ones((*faces.shape[:-1], 4), dtype="<f2")
    texels[..., :3] = faces
    return texels
