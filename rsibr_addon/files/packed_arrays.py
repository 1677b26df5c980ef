"""Arrays in JSON for browsers, which unpack them by `DecompressionStream`: packed.js has the way back."""

import base64
import zlib
from typing import Any

import numpy as np

from ..core.conventions import Array, Indices


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
        "shape", "bits", "along"; and "data", in base64: deflated, first the lowest bytes of all numbers, then
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
    return {"shape": list(values.shape), "bits": bits, "along": list(along), "data": _text(stored)}


def packed_floats(values: Array) -> dict[str, Any]:
    """Numbers in single precision, exactly.

    Parameters
    ----------
    values : ndarray, any shape

    Returns
    -------
    dict
        "shape" and "data": deflated little-endian floats, in base64.
    """
    return {"shape": list(values.shape), "data": _text(values.astype("<f4").tobytes())}


def _text(stored: bytes) -> str:
    return base64.b64encode(zlib.compress(stored, 9)).decode("ascii")
