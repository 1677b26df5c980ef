"""Arrays in JSON for browsers, which unpack them by `DecompressionStream`: packed.js has the way back."""

import zlib
from typing import Any

import numpy as np

from ..core.conventions import Array, Indices

LETTERS = np.array([code for code in range(33, 127) if chr(code) not in '"<\\'], np.uint8)
"""Codes of the 91 letters of packed data: those that neither JSON nor HTML must escape."""


def packed_integers(values: Indices, bits: int, along: tuple[int, ...]) -> dict[str, Any]:
    """Whole numbers, small where neighbours are alike.

    Parameters
    ----------
    values : ndarray of int, any shape
        Of `bits` bits, with a sign or without.
    bits : {8, 16, 32}
    along : tuple of int
        Axes along which neighbours are alike.

    Returns
    -------
    dict
        "shape", "bits", "along"; and "data", see `packed_bytes`: first the lowest bytes of all numbers, then
        the next. The numbers are differences along one axis after the other, modulo 2^bits, with the sign in
        the lowest bit.
    """
    modulus = 1 << bits
    differences = values.astype(np.int64)
    for axis in along:
        differences = np.diff(differences, axis=axis, prepend=0)
    wrapped = (differences + modulus // 2) % modulus - modulus // 2
    folded = np.where(wrapped < 0, -2 * wrapped - 1, 2 * wrapped)
    stored = b"".join((folded >> shift & 0xFF).astype(np.uint8).tobytes() for shift in range(0, bits, 8))
    return {"shape": list(values.shape), "bits": bits, "along": list(along), "data": packed_bytes(stored)}


def packed_floats(values: Array) -> dict[str, Any]:
    """Numbers in single precision, exactly.

    Parameters
    ----------
    values : ndarray, any shape

    Returns
    -------
    dict
        "shape" and "data": little-endian floats, see `packed_bytes`.
    """
    return {"shape": list(values.shape), "data": packed_bytes(values.astype("<f4").tobytes())}


def packed_bytes(stored: bytes) -> str:
    """Bytes, deflated, as `LETTERS`: 13 bits in two of them, up to 5 bits at the end in one."""
    bits = np.unpackbits(np.frombuffer(zlib.compress(stored, 9), np.uint8))
    short = len(bits) % 13 if len(bits) % 13 <= 5 else 0
    end = np.packbits(bits[len(bits) - short :]) >> 3
    paired = bits[: len(bits) - short]
    pairs = np.pad(paired, (0, -len(paired) % 13)).reshape(-1, 13)
    numbers = np.packbits(np.pad(pairs, ((0, 0), (3, 0))), axis=1).view(">u2")
    places = np.concatenate([*np.divmod(numbers, 91)], axis=1).ravel()
    return bytes(LETTERS[np.concatenate([places, end])]).decode("ascii")
