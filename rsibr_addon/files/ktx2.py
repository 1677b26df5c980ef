"""Textures for other programs: KTX 2.0, as the Khronos Group specifies it.

A file holds a texture as graphics interfaces take it: a cube or an array of layers, with its mips. Rows come
in the order of v, so that a lookup at our (u, v) finds the texel in every interface.
"""

import struct
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from enum import StrEnum
from pathlib import Path

import numpy as np

from ..core.bc6h.encode import bc6h_blocks
from ..core.conventions import Array
from .atomic import written_aside
from .textures import Texture

IDENTIFIER = b"\xabKTX 20\xbb\r\n\x1a\n"

_RGBSDA, _BC6H = 1, 133
"""The data format's models of colour."""

HALF, FLOAT = 97, 109
"""Vulkan's R16G16B16A16_SFLOAT and R32G32B32A32_SFLOAT: few programs read three channels."""

_HEADER = struct.Struct("<12s9I4I2Q")
_LEVEL = struct.Struct("<3Q")

BC6H_UFLOAT, BC6H_SFLOAT = 143, 144
"""Vulkan's BC6H_UFLOAT_BLOCK and BC6H_SFLOAT_BLOCK."""


class Texels(StrEnum):
    """What holds a texel.

    FITTING takes 16-bit floats where these can hold the texture, else 32-bit floats. HALF takes 16-bit floats
    in any case, and BC6H compresses: nothing may be beyond `core.bc6h.encode.LARGEST` then.
    """

    FITTING = "fitting"
    HALF = "half"
    BC6H = "bc6h"


@dataclass(frozen=True)
class _Stored:
    """How texels are stored.

    Attributes
    ----------
    number : int
        Vulkan's, of the format.
    unit : int
        Bytes of a number that has an order of bytes.
    size : int
        Bytes of a texel, or of a block of them.
    description : bytes
        The data format descriptor.
    encoded : callable
        A level to its bytes.
    """

    number: int
    unit: int
    size: int
    description: bytes
    encoded: Callable[[Array], bytes]


def write_ktx2(
    path: str | Path,
    texture: Texture,
    notes: Mapping[str, str],
    force: bool = False,
    texels: Texels = Texels.FITTING,
) -> None:
    """Write a texture; alpha is 1 where levels have three channels and the file four.

    Parameters
    ----------
    path : str or Path
        Usually NAME.ktx2.
    texture : Texture
    notes : mapping of str to str
        Notes for readers, by their keys.
    force : bool
        Whether an existing file is replaced.
    texels : Texels

    Raises
    ------
    OutputFileError
        See `written_aside`.
    """
    match texels:
        case Texels.BC6H:
            stored = _blocks(texture)
        case Texels.HALF:
            stored = _floats(half=True)
        case Texels.FITTING:
            stored = _floats(texture.is_half)
    pixels = [stored.encoded(level) for level in texture.levels]
    layers, height, width = texture.levels[0].shape[:3]
    orientation = "rd" if texture.is_cube else "ru"
    described = stored.description
    noted = _key_values({"KTXorientation": orientation, **notes})
    described_at = _HEADER.size + len(pixels) * _LEVEL.size
    noted_at = described_at + len(described)
    head = _HEADER.pack(
        IDENTIFIER,
        *(stored.number, stored.unit),
        *(width, height, 0),
        *((0, 6) if texture.is_cube else (layers, 1)),
        *(len(pixels), 0),
        *(described_at, len(described), noted_at, len(noted)),
        *(0, 0),
    )
    # The smallest mip comes first, so that a reader can show something early
    places, end = [0] * len(pixels), noted_at + len(noted)
    for level in reversed(range(len(pixels))):
        places[level] = -(-end // stored.size) * stored.size
        end = places[level] + len(pixels[level])
    index = b"".join(
        _LEVEL.pack(place, len(level), len(level)) for place, level in zip(places, pixels, strict=True)
    )
    with written_aside(path, force) as aside, aside.open("wb") as file:
        file.write(head + index + described + noted)
        for place, mip in sorted(zip(places, pixels, strict=True)):
            file.write(bytes(place - file.tell()))
            file.write(mip)


def _floats(half: bool) -> _Stored:
    bits, red_green_blue_alpha = 16 if half else 32, (0, 1, 2, 15)
    samples = [
        (position * bits, bits, channel, True) for position, channel in enumerate(red_green_blue_alpha)
    ]

    def encoded(level: Array) -> bytes:
        texels = np.ones((*level.shape[:-1], 4), dtype="<f2" if half else "<f4")
        texels[..., : level.shape[-1]] = level
        return texels.tobytes()

    described = _description(_RGBSDA, (0, 0), bits // 2, samples)
    return _Stored(HALF if half else FLOAT, bits // 8, bits // 2, described, encoded)


def _blocks(texture: Texture) -> _Stored:
    signed = any(bool((level < 0.0).any()) for level in texture.levels)
    described = _description(_BC6H, (3, 3), 16, [(0, 128, 0, signed)])

    def encoded(level: Array) -> bytes:
        return b"".join(bc6h_blocks(layer, signed).tobytes() for layer in level)

    return _Stored(BC6H_SFLOAT if signed else BC6H_UFLOAT, 1, 16, described, encoded)


def _description(
    model: int, block: tuple[int, int], size: int, samples: Sequence[tuple[int, int, int, bool]]
) -> bytes:
    """The data format descriptor: one basic block (Khronos Data Format 1.3, section 5).

    A sample has its first bit, its number of bits, its channel, and whether it has a sign.
    """
    linear_rec709 = bytes((model, 1, 1, 0))
    described = linear_rec709 + bytes((*block, 0, 0)) + bytes((size, 0, 0, 0, 0, 0, 0, 0))
    for start, bits, channel, signed in samples:
        is_float = 0x80 | (0x40 if signed else 0)
        described += struct.pack(
            "<HBBIff", start, bits - 1, channel | is_float, 0, -1.0 if signed else 0.0, 1.0
        )
    return struct.pack("<IIHH", 12 + len(described), 0, 2, 8 + len(described)) + described


def _key_values(notes: Mapping[str, str]) -> bytes:
    packed = b""
    for key, value in sorted(notes.items()):
        pair = f"{key}\0{value}\0".encode()
        packed += struct.pack("<I", len(pair)) + pair + bytes(-len(pair) % 4)
    return packed
