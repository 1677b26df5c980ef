"""The encoding of pictures with 8 or 16 bits: a curve and primaries, by name or by ICC profile."""

import struct
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from ..core.conventions import Array, ArrayLike
from ..core.light.transfer_curve import linear_from_srgb
from .chromaticities import REC_709, rec709_from

Curve = Callable[[ArrayLike], Array]
"""Light from a number in [0, 1]."""

D50 = (0.9642, 1.0, 0.8249)
"""XYZ of white in all ICC profiles."""

PRIMARIES = {
    "rec709": REC_709,
    "p3d65": (0.680, 0.320, 0.265, 0.690, 0.150, 0.060, 0.3127, 0.3290),
    "rec2020": (0.708, 0.292, 0.170, 0.797, 0.131, 0.046, 0.3127, 0.3290),
    "adobergb": (0.64, 0.33, 0.21, 0.71, 0.15, 0.06, 0.3127, 0.3290),
}

STRAIGHT = 1e-4
"""Distance from the diagonal up to which a curve counts as linear."""


@dataclass(frozen=True, eq=False)
class Encoding:
    """The way from a picture's numbers to light.

    Attributes
    ----------
    curves : tuple of 3 functions, or None
        Curves of red, green and blue; None where the numbers are linear.
    to_rec709 : ndarray, shape (3, 3)
        Matrix to linear Rec. 709 from the picture's linear light.
    name : str
        Name of the colour space, for people.
    """

    curves: tuple[Curve, Curve, Curve] | None
    to_rec709: Array
    name: str


def power_curve(exponent: float) -> Curve:
    """The curve that raises encoded values, of any shape and not negative, to a power."""
    return lambda encoded: np.asarray(encoded, dtype=np.float64) ** exponent


TRANSFERS: dict[str, Curve | None] = {
    "lin": None,
    "srgb": linear_from_srgb,
    # PNG states sRGB as 2.2 to programs that know only powers
    "g22": linear_from_srgb,
    "g18": power_curve(1.8),
    "g24": power_curve(2.4),
    "g26": power_curve(2.6),
}


def named_encoding(name: str) -> Encoding:
    """The encoding of a colour space by its name.

    Parameters
    ----------
    name : str
        TRANSFER_PRIMARIES and perhaps more, as in srgb_p3d65_scene: the Color Interop Forum's names.

    Raises
    ------
    KeyError
        It is unknown.
    """
    transfer, primaries = name.split("_")[:2] if "_" in name else (name, "")
    curve = power_curve(2.2) if (transfer, primaries) == ("g22", "adobergb") else TRANSFERS[transfer]
    return Encoding(curve and (curve, curve, curve), rec709_from(PRIMARIES[primaries]), name)


def profile_encoding(profile: bytes) -> Encoding:
    """The encoding that an ICC profile describes.

    Raises
    ------
    ValueError
        It is damaged, or neither of grey nor of primaries with curves, from black to finite light.
    """
    try:
        tags = _tags(profile)
        if profile[16:20] == b"GRAY":
            curves, chromaticities = [_curve(tags[b"kTRC"])] * 3, [*REC_709]
        else:
            curves = [_curve(tags[name]) for name in (b"rTRC", b"gTRC", b"bTRC")]
            xyz = [*(_xyz(tags[name]) for name in (b"rXYZ", b"gXYZ", b"bXYZ")), D50]
            chromaticities = [part / sum(each) for each in xyz for part in each[:2]]
        to_rec709 = rec709_from(chromaticities)
    except (KeyError, IndexError, struct.error, ZeroDivisionError) as error:
        raise ValueError("it has no primaries with curves") from error
    levels = np.linspace(0.0, 1.0, 256)
    light = np.array([curve(levels) for curve in curves])
    if not np.isfinite(light).all():
        raise ValueError("its curves are too steep")
    straight = np.abs(light - levels).max() < STRAIGHT
    told = None if straight else (curves[0], curves[1], curves[2])
    return Encoding(told, to_rec709, "linear, by its profile" if straight else "by its profile")


def _tags(profile: bytes) -> dict[bytes, bytes]:
    (count,) = struct.unpack_from(">I", profile, 128)
    tags = {}
    for i in range(min(count, 100)):
        name, start, size = struct.unpack_from(">4sII", profile, 132 + 12 * i)
        tags[name] = profile[start : start + size]
    return tags


def _xyz(tag: bytes) -> tuple[float, ...]:
    return tuple(part / 65536.0 for part in struct.unpack_from(">3i", tag, 8))


def _curve(tag: bytes) -> Curve:
    """A tag of type curv or para (ICC.1:2022, 10.6 and 10.18)."""
    if tag[:4] == b"curv":
        (count,) = struct.unpack_from(">I", tag, 8)
        values = np.array(struct.unpack_from(f">{count}H", tag, 12), dtype=np.float64)
        if count == 0:
            return power_curve(1.0)
        if count == 1:
            return power_curve(_exponent(values[0] / 256.0))
        levels = np.linspace(0.0, 1.0, count)
        return lambda encoded: np.interp(np.asarray(encoded, np.float64), levels, values / 65535.0)
    if tag[:4] != b"para":
        raise KeyError("no curve")
    (kind,) = struct.unpack_from(">H", tag, 8)
    numbers = [each / 65536.0 for each in struct.unpack_from(f">{(1, 3, 4, 5, 7)[kind]}i", tag, 12)]
    # The last kind is the most general; the shorter ones leave parts out
    g, a, b = numbers[:3] if kind else (numbers[0], 1.0, 0.0)
    _exponent(g)
    c, d, e, f = 0.0, -b / a, 0.0, 0.0
    if kind == 2:
        e = f = numbers[3]
    elif kind > 2:
        c, d, e, f = (*numbers[3:], 0.0, 0.0)[:4]

    def curve(encoded: ArrayLike) -> Array:
        encoded = np.asarray(encoded, dtype=np.float64)
        with np.errstate(over="ignore"):  # it may, where it does not count
            light: Array = np.where(encoded >= d, np.maximum(a * encoded + b, 0.0) ** g + e, c * encoded + f)
        return light

    return curve


def _exponent(exponent: float) -> float:
    if exponent <= 0.0:
        raise KeyError("no curve that begins in black")
    return exponent
