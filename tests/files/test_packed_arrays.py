"""Packed arrays, unpacked as a browser does."""

import json
import zlib
from typing import Any

import numpy as np
import pytest
from rsibr.rsibr_addon.files.packed_arrays import packed_bytes, packed_floats, packed_integers

DIGITS = "".join(letter for letter in map(chr, range(33, 127)) if letter not in '"<' + chr(92))


def stored_bytes(text: str) -> bytes:
    """What was packed: 13 bits in each two letters, or 5 in a last one; what is left fills no byte."""
    digits = [DIGITS.index(letter) for letter in text]
    pairs = zip(digits[::2], digits[1::2], strict=False)
    found = "".join(f"{91 * high + low:013b}" for high, low in pairs)
    found += f"{digits[-1]:05b}" if len(digits) % 2 else ""
    inflate = zlib.decompressobj()
    stored = inflate.decompress(bytes(int(found[at : at + 8], 2) for at in range(0, len(found) // 8 * 8, 8)))
    assert inflate.eof
    assert not inflate.unused_data  # which browsers refuse
    return stored


def unpacked(packed: dict[str, Any], signed: bool) -> np.ndarray:
    """Bytes by significance, the sign in the lowest bit, sums along the axes in turn, modulo 2^bits."""
    stored = np.frombuffer(stored_bytes(packed["data"]), np.uint8)
    planes = stored.reshape(packed["bits"] // 8, -1).astype(np.int64)
    folded = sum(plane << 8 * place for place, plane in enumerate(planes))
    numbers = np.where(folded % 2, -(folded + 1) // 2, folded // 2).reshape(packed["shape"])
    for axis in packed["along"]:
        numbers = np.cumsum(numbers, axis=axis)
    modulus = 2 ** packed["bits"]
    return (numbers + modulus // 2) % modulus - modulus // 2 if signed else numbers % modulus


@pytest.mark.parametrize("bits", [8, 16, 32])
@pytest.mark.parametrize("along", [(), (0,), (1, 2), (2, 0)])
def test_whole_numbers_come_back(bits: int, along: tuple[int, ...]) -> None:
    rng = np.random.default_rng(bits)
    values = rng.integers(0, 2**bits, (3, 5, 7))
    values[0, 0, :2] = 0, 2**bits - 1
    assert np.array_equal(unpacked(packed_integers(values, bits, along), signed=False), values)
    signed = values - 2 ** (bits - 1)
    assert np.array_equal(unpacked(packed_integers(signed, bits, along), signed=True), signed)


def test_a_slope_takes_hardly_any_room() -> None:
    slope = 3 * np.arange(200)[:, None] + 5 * np.arange(300)
    assert len(packed_integers(slope, 16, (0, 1))["data"]) < 1000


def test_floats_come_back_exactly() -> None:
    values = np.random.default_rng(2).standard_normal((4, 5)).astype(np.float32)
    packed = packed_floats(values)
    assert packed["shape"] == [4, 5]
    stored = np.frombuffer(stored_bytes(packed["data"]), "<f4")
    assert np.array_equal(stored.reshape(4, 5), values)


def test_bytes_of_any_number_come_back_and_need_no_escape() -> None:
    rng = np.random.default_rng(3)
    for count in range(40):  # with each number of bits at the end
        stored = rng.bytes(count)
        text = packed_bytes(stored)
        assert stored_bytes(text) == stored
        assert json.dumps(text) == f'"{text}"'
        assert "<" not in text
    assert len(packed_bytes(rng.bytes(10_000))) < 10_000 * 8 * 2 / 13 + 40
