"""Textures for other programs: uncompressed KTX 2.0, as the Khronos Group specifies it.

A file holds a texture as graphics interfaces take it: a cube or an array of layers, with its mips. Rows come
in the order of v, so that a lookup at our (u, v) finds the texel in every interface.
"""

import struct
from collections.abc import Mapping
from pathlib import Path

import numpy as np

from ..core.conventions import Array
from .atomic import written_aside
from .textures import Texture

IDENTIFIER = b"\xabKTX 20\xbb\r\n\x1a\n"

HALF, FLOAT = 97, 109
"""Vulkan's R16G16B16A16_SFLOAT and R32G32B32A32_SFLOAT: few programs read three channels."""

_HEADER = struct.Struct("<12s9I4I2Q")
_LEVEL = struct.Struct("<3Q")


def write_ktx2(path: str | Path, texture: Texture, notes: Mapping[str, str], force: bool = False) -> None:
    """Write a texture, as 16-bit floats where these can hold it, else as 32-bit floats; alpha is 1.

    Parameters
    ----------
    path : str or Path
        Usually NAME.ktx2.
    texture : Texture
    notes : mapping of str to str
        Notes for readers, by their keys.
    force : bool
        Whether an existing file is replaced.

    Raises
    ------
    OutputFileError
        See `written_aside`.
    """
    half = texture.is_half
    pixels = [_pixels(level, half) for level in texture.levels]
    texel = 8 if half else 16
    layers, height, width = texture.levels[0].shape[:3]
    orientation = "rd" if texture.is_cube else "ru"
    described = _description(half)
    noted = _key_values({"KTXorientation": orientation, **notes})
    described_at = _HEADER.size + len(pixels) * _LEVEL.size
    noted_at = described_at + len(described)
    head = _HEADER.pack(
        IDENTIFIER,
        *(HALF if half else FLOAT, texel // 4),
        *(width, height, 0),
        *((0, 6) if texture.is_cube else (layers, 1)),
        *(len(pixels), 0),
        *(described_at, len(described), noted_at, len(noted)),
        *(0, 0),
    )
    # The smallest mip comes first, so that a reader can show something early
    places, end = [0] * len(pixels), noted_at + len(noted)
    for level in reversed(range(len(pixels))):
        places[level] = -(-end // texel) * texel
        end = places[level] + len(pixels[level])
    index = b"".join(
        _LEVEL.pack(place, len(level), len(level)) for place, level in zip(places, pixels, strict=True)
    )
    with written_aside(path, force) as aside, aside.open("wb") as file:
        file.write(head + index + described + noted)
        for place, mip in sorted(zip(places, pixels, strict=True)):
            file.write(bytes(place - file.tell()))
            file.write(mip)


def _pixels(level: Array, half: bool) -> bytes:
    texels = np.ones((*level.shape[:-1], 4), dtype="<f2" if half else "<f4")
    texels[..., :3] = level
    return texels.tobytes()


def _description(half: bool) -> bytes:
    """The data format descriptor: one basic block (Khronos Data Format 1.3, section 5)."""
    bits, red_green_blue_alpha = 16 if half else 32, (0, 1, 2, 15)
    linear_rec709, signed_float = bytes((1, 1, 1, 0)), 0xC0
    samples = b"".join(
        struct.pack("<HBBIff", position * bits, bits - 1, channel | signed_float, 0, -1.0, 1.0)
        for position, channel in enumerate(red_green_blue_alpha)
    )
    planes = bytes((bits // 2, 0, 0, 0, 0, 0, 0, 0))
    block = linear_rec709 + bytes(4) + planes + samples
    return struct.pack("<IIHH", 12 + len(block), 0, 2, 8 + len(block)) + block


def _key_values(notes: Mapping[str, str]) -> bytes:
    packed = b""
    for key, value in sorted(notes.items()):
        pair = f"{key}\0{value}\0".encode()
        packed += struct.pack("<I", len(pair)) + pair + bytes(-len(pair) % 4)
    return packed
