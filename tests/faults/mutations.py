"""Damage, by a seed: to JSON with its structure in mind, to any bytes without."""

import copy
import json
import random
from typing import Any

RAW = "raw:"
"""Begins a text that stands in JSON as it is, without its quotes: Python's own writer would not write it."""

NASTY: list[Any] = [
    *(None, True, False, 0, 1, -1, 2, 7, 255, 65536, 2**31, 2**32, 2**53, 2**63, -(2**63), 10**30, 10**400),
    *(0.0, -0.0, 0.5, 1.5, -1.5, 1e-320, 1e30, 1e308, -1e308),
    *(f"{RAW}NaN", f"{RAW}-Infinity", f"{RAW}1e999", f"{RAW}{'9' * 5000}", f'{RAW}"\\ud800"', f"{RAW}{{"),
    *("", "x", "0", "1.5", "a" * 300, "\x00", "\x1b[31m", "../../etc/passwd", "/dev/zero", "%s{0}", "<b>"),
    *("merl:path=/dev/zero", " blend:/no/evil.blend:Evil", "ggx:alpha=1e999,metal=gold", "(" * 5000),
    *("environment", "prefiltered", "diffuse", "lobe_stack", "mip_chain", "octahedral", "equirect"),
    *([], [[]], [None], [0], [1, 1], [0, 0, 0], [1, 1, 1], [1e308] * 3, ["x"] * 3, [{}], [{}] * 3),
    *({}, {"": None}, {"name": []}, {"brdf": {}}, {"path": "/dev/zero"}, [0] * 5000, {"a": [1, {"b": 2}]}),
]

_Place = tuple[Any, Any]
"""A list or an object, and an index or a name in it."""


def damaged_json(plain: Any, rng: random.Random) -> str:
    """The text of JSON values after one to three changes, most of them one."""
    root = [copy.deepcopy(plain)]
    for _ in range(rng.choice((1, 1, 1, 2, 3))):
        _change(root, rng)
    text = json.dumps(root[0])
    for value in NASTY:
        if isinstance(value, str) and value.startswith(RAW):
            text = text.replace(json.dumps(value), value.removeprefix(RAW))
    if rng.random() < 0.1:
        return damaged_bytes(text.encode(), rng).decode(errors="surrogateescape")
    return text


def damaged_bytes(data: bytes, rng: random.Random) -> bytes:
    """Bytes cut off, changed, left out or repeated."""
    start, length = rng.randrange(len(data)), rng.choice((1, 1, 2, 4, 8, 64, 1000))
    match rng.randrange(6):
        case 0:
            return data[:start]
        case 1:
            return data[:start] + data[start + length :]
        case 2:
            return data[: start + length] + data[start:]
        case 3:
            return data[:start] + rng.randbytes(length) + data[start + length :]
        case 4:
            word = rng.choice((b"\x00" * 4, b"\xff" * 4, b"\xff\xff\xff\x7f", b"\x00\x00\x00\x80"))
            return data[:start] + word + data[start + 4 :]
    changed = bytearray(data)
    for _ in range(rng.choice((1, 1, 3, 30))):
        changed[rng.randrange(len(data))] ^= 1 << rng.randrange(8)
    return bytes(changed)


def _change(root: list[Any], rng: random.Random) -> None:
    holder, key = rng.choice(list(_places(root)))
    match rng.randrange(10):
        case 0 | 1 | 2 | 3:
            holder[key] = copy.deepcopy(rng.choice(NASTY))
        case 4 | 5:
            if holder is not root:
                del holder[key]
        case 6:
            other, name = rng.choice(list(_places(root)))
            holder[key] = copy.deepcopy(other[name])
        case 7:
            for _ in range(rng.choice((1, 2, 40, 120))):
                holder[key] = [holder[key]] if rng.random() < 0.5 else {"a": holder[key]}
        case 8:
            value = holder[key]
            if isinstance(value, int | float) and abs(value) < 2**64:
                holder[key] = rng.choice((-value, value + 1, value * 1e30, value * 1000, str(value)))
            elif isinstance(value, list):
                holder[key] = rng.choice((value * 2, value[::-1], value[:1], value * 1000))
        case 9:
            if isinstance(holder, list):
                holder.insert(key, copy.deepcopy(rng.choice(NASTY)))
            else:
                holder[rng.choice(("more", "name", "path", "view", "mip", "lobe", "size"))] = holder[key]


def _places(value: Any) -> list[_Place]:
    """All places, those near the root as likely as whole lists of numbers below."""
    found: list[_Place] = []
    inner = value.items() if isinstance(value, dict) else enumerate(value)
    for key, each in inner:
        found.append((value, key))
        if isinstance(each, dict | list):
            below = _places(each)
            found += below if len(below) < 60 else below[:: len(below) // 60 + 1]
    return found
