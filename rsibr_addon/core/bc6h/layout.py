"""Where a block has its bits: the modes, the partitions and the weights of the format."""

import re
from dataclasses import dataclass

import numpy as np

from ..conventions import Indices


@dataclass(frozen=True)
class Mode:
    """A way to divide a block's bits.

    Attributes
    ----------
    bits : tuple of int
        The mode's own bits, the lowest first.
    regions : int
        Number of lines, 1 or 2.
    precision : int
        Bits of an end.
    delta : tuple of three int, or None
        Bits of the differences of the other ends from the first, for red, green and blue; None where these
        are stored as they are.
    places : tuple of (int, int, int)
        After the mode: end, channel and bit of each stored bit, up to the partition or the indices.
    """

    bits: tuple[int, ...]
    regions: int
    precision: int
    delta: tuple[int, int, int] | None
    places: tuple[tuple[int, int, int], ...]


def _mode(number: str, regions: int, precision: int, delta: tuple[int, int, int] | None, layout: str) -> Mode:
    """A mode of a row of the specification: rw is red of the first end, [9:0] ten bits from the lowest."""
    places = []
    for channel, end, high, low in re.findall(r"([rgb])([wxyz])\[(\d+)(?::(\d+))?\]", layout):
        first, last = int(low or high), int(high)
        bits = range(first, last + 1) if first <= last else range(first, last - 1, -1)
        places += [("wxyz".index(end), "rgb".index(channel), bit) for bit in bits]
    return Mode(tuple(int(bit) for bit in reversed(number)), regions, precision, delta, tuple(places))


_TENS = "rw[9:0]gw[9:0]bw[9:0]"

MODES = (
    _mode(
        "00", 2, 10, (5, 5, 5),
        "gy[4]by[4]bz[4]" + _TENS + "rx[4:0]gz[4]gy[3:0]gx[4:0]bz[0]gz[3:0]bx[4:0]bz[1]by[3:0]ry[4:0]"
        "bz[2]rz[4:0]bz[3]",
    ),
    _mode(
        "01", 2, 7, (6, 6, 6),
        "gy[5]gz[4]gz[5]rw[6:0]bz[0]bz[1]by[4]gw[6:0]by[5]bz[2]gy[4]bw[6:0]bz[3]bz[5]bz[4]rx[5:0]gy[3:0]gx[5:0]"
        "gz[3:0]bx[5:0]by[3:0]ry[5:0]rz[5:0]",
    ),
    _mode(
        "00010", 2, 11, (5, 4, 4),
        _TENS + "rx[4:0]rw[10]gy[3:0]gx[3:0]gw[10]bz[0]gz[3:0]bx[3:0]bw[10]bz[1]by[3:0]ry[4:0]"
        "bz[2]rz[4:0]bz[3]",
    ),
    _mode(
        "00110", 2, 11, (4, 5, 4),
        _TENS + "rx[3:0]rw[10]gz[4]gy[3:0]gx[4:0]gw[10]gz[3:0]bx[3:0]bw[10]bz[1]by[3:0]ry[3:0]bz[0]"
        "bz[2]rz[3:0]gy[4]bz[3]",
    ),
    _mode(
        "01010", 2, 11, (4, 4, 5),
        _TENS + "rx[3:0]rw[10]by[4]gy[3:0]gx[3:0]gw[10]bz[0]gz[3:0]bx[4:0]bw[10]by[3:0]ry[3:0]bz[1]"
        "bz[2]rz[3:0]bz[4]bz[3]",
    ),
    _mode(
        "01110", 2, 9, (5, 5, 5),
        "rw[8:0]by[4]gw[8:0]gy[4]bw[8:0]bz[4]rx[4:0]gz[4]gy[3:0]gx[4:0]bz[0]gz[3:0]bx[4:0]bz[1]by[3:0]ry[4:0]"
        "bz[2]rz[4:0]bz[3]",
    ),
    _mode(
        "10010", 2, 8, (6, 5, 5),
        "rw[7:0]gz[4]by[4]gw[7:0]bz[2]gy[4]bw[7:0]bz[3]bz[4]rx[5:0]gy[3:0]gx[4:0]bz[0]gz[3:0]bx[4:0]bz[1]"
        "by[3:0]ry[5:0]rz[5:0]",
    ),
    _mode(
        "10110", 2, 8, (5, 6, 5),
        "rw[7:0]bz[0]by[4]gw[7:0]gy[5]gy[4]bw[7:0]gz[5]bz[4]rx[4:0]gz[4]gy[3:0]gx[5:0]gz[3:0]bx[4:0]bz[1]"
        "by[3:0]ry[4:0]bz[2]rz[4:0]bz[3]",
    ),
    _mode(
        "11010", 2, 8, (5, 5, 6),
        "rw[7:0]bz[1]by[4]gw[7:0]by[5]gy[4]bw[7:0]bz[5]bz[4]rx[4:0]gz[4]gy[3:0]gx[4:0]bz[0]gz[3:0]bx[5:0]"
        "by[3:0]ry[4:0]bz[2]rz[4:0]bz[3]",
    ),
    _mode(
        "11110", 2, 6, None,
        "rw[5:0]gz[4]bz[0]bz[1]by[4]gw[5:0]gy[5]by[5]bz[2]gy[4]bw[5:0]gz[5]bz[3]bz[5]bz[4]rx[5:0]gy[3:0]gx[5:0]"
        "gz[3:0]bx[5:0]by[3:0]ry[5:0]rz[5:0]",
    ),
    _mode("00011", 1, 10, None, _TENS + "rx[9:0]gx[9:0]bx[9:0]"),
    _mode("00111", 1, 11, (9, 9, 9), _TENS + "rx[8:0]rw[10]gx[8:0]gw[10]bx[8:0]bw[10]"),
    _mode("01011", 1, 12, (8, 8, 8), _TENS + "rx[7:0]rw[10:11]gx[7:0]gw[10:11]bx[7:0]bw[10:11]"),
    _mode("01111", 1, 16, (4, 4, 4), _TENS + "rx[3:0]rw[10:15]gx[3:0]gw[10:15]bx[3:0]bw[10:15]"),
)  # fmt: skip
"""The 14 modes, in the order of the specification."""

_PARTITIONS = """
    0011001100110011 0001000100010001 0111011101110111 0001001100110111 0000000100010011 0011011101111111
    0001001101111111 0000000100110111 0000000000010011 0011011111111111 0000000101111111 0000000000010111
    0001011111111111 0000000011111111 0000111111111111 0000000000001111 0000100011101111 0111000100000000
    0000000010001110 0111001100010000 0011000100000000 0000100011001110 0000000010001100 0111001100110001
    0011000100010000 0000100010001100 0110011001100110 0011011001101100 0001011111101000 0000111111110000
    0111000110001110 0011100110011100
"""

PARTITIONS = np.array([[int(region) for region in row] for row in _PARTITIONS.split()])
"""Which of two lines each of the 16 texels is on, row by row: shape (32, 16)."""

ANCHORS = np.array([15] * 17 + [2, 8, 2, 2, 8, 8, 15, 2, 8, 2, 2, 8, 8, 2, 2])
"""For each partition the texel of the second line whose index has a bit less; of the first it is texel 0."""

WEIGHTS = {
    1: np.array([0, 4, 9, 13, 17, 21, 26, 30, 34, 38, 43, 47, 51, 55, 60, 64]),
    2: np.array([0, 9, 18, 27, 37, 46, 55, 64]),
}
"""Number of lines -> share of the second end, in 64ths, of each index."""


def packed(mode: Mode, ends: Indices, partition: Indices, index: Indices) -> Indices:
    """Blocks of one mode as bytes.

    Parameters
    ----------
    mode : Mode
    ends : ndarray, shape (n, 4, 3)
        Stored ends, differences where the mode has them; of one line the first two count.
    partition : ndarray, shape (n,)
    index : ndarray, shape (n, 16)
        The highest bit of the anchors' is 0.

    Returns
    -------
    ndarray, shape (n, 16), uint8
    """
    bits = np.zeros((len(ends), 128), np.uint8)
    bits[:, : len(mode.bits)] = mode.bits
    at = len(mode.bits)
    for end, channel, bit in mode.places:
        bits[:, at] = ends[:, end, channel] >> bit & 1
        at += 1
    width = len(WEIGHTS[mode.regions]).bit_length() - 1
    if mode.regions == 1:
        bits[:, at : at + width - 1] = _bits(index[:, :1], width - 1)
        bits[:, at + width - 1 :] = _bits(index[:, 1:], width)
        return np.packbits(bits, axis=1, bitorder="little")
    bits[:, at : at + 5] = _bits(partition[:, None], 5)
    at += 5
    anchor = ANCHORS[partition]
    for texel in range(16):
        # Which bits a texel has depends on where the anchors are
        place = at + width * texel - (texel > 0) - (texel > anchor)
        short = (texel == anchor) | (texel == 0)
        for bit in range(width):
            rows = np.flatnonzero(~short) if bit == width - 1 else np.arange(len(ends))
            bits[rows, place[rows] + bit] = index[rows, texel] >> bit & 1
    return np.packbits(bits, axis=1, bitorder="little")


def _bits(numbers: Indices, width: int) -> Indices:
    """The lowest bits of numbers of shape (n, m) from the lowest on, shape (n, m * width)."""
    found: Indices = (numbers[..., None] >> np.arange(width) & 1).reshape(
        len(numbers), width * numbers.shape[1]
    )
    return found
