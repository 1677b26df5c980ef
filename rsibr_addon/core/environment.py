"""The environment: incoming radiance from every direction, as a latitude-longitude map."""

import hashlib
from dataclasses import dataclass, field

import numpy as np

from .conventions import Array
from .errors import InputFileError
from .warned import warn

NEGLIGIBLE = 1e-6
"""Sum of negative values, relative to that of the others, up to which they are nothing but a picture's
compression: Blender's own environments have up to 2.5e-7, and a map in half floats errs by 5e-4."""

LARGEST = 1e30
"""Greatest radiance that is kept, and greatest clamp: sums of light over the sphere stay finite in 32-bit
floats."""


@dataclass(frozen=True)
class Environment:
    """Incoming radiance over the sphere in Cycles' own equirectangular layout.

    Attributes
    ----------
    radiance : ndarray, shape (height, 2 * height, 3), float32
        Scene-linear Rec. 709 radiance, finite and not negative; row 0 looks down (-Z).
    name : str
        Its name for reports: that of a file, or of a world.
    sha256 : str
        Hash of the radiance as little-endian float32 in the order above.
    clamp : float or None
        Value that replaced brighter radiance; None where all was kept.
    """

    radiance: Array
    name: str
    sha256: str = field(init=False)
    clamp: float | None = None

    def __post_init__(self) -> None:
        pixels = np.ascontiguousarray(self.radiance, dtype="<f4")
        object.__setattr__(self, "sha256", hashlib.sha256(pixels.data).hexdigest())


def environment_from_pixels(pixels: Array, name: str, clamp: float | None = None) -> Environment:
    """Check that `pixels` can light a scene, and make it an `Environment`.

    Parameters
    ----------
    pixels : ndarray, shape (height, width, 3)
        Radiance, row 0 at the bottom.
    name : str
        Named in messages: the file, or the world.
    clamp : float, optional
        See `usable_radiance`.

    Returns
    -------
    Environment
        With the radiance of `usable_radiance`.

    Raises
    ------
    InputFileError
        The map is not twice as wide as high, or holds no finite value.

    Warns
    -----
    RsibrWarning
        See `usable_radiance`.
    """
    height, width = pixels.shape[:2]
    if width != 2 * height or height < 1:
        raise InputFileError(
            f"{name} is {width}x{height}, but an environment is a latitude-longitude map, "
            f"twice as wide as high: convert it, by rsibr convert or in the panel."
        )
    return Environment(usable_radiance(pixels, name, clamp), name, clamp)


def usable_radiance(pixels: Array, name: str, clamp: float | None = None) -> Array:
    """Make a picture's values usable as radiance.

    Parameters
    ----------
    pixels : ndarray, any shape
    name : str
        Named in messages: the file, or the world.
    clamp : float, optional
        The greatest radiance that is kept, above 0.

    Returns
    -------
    ndarray, shape of `pixels`, float32
        From 0 to `LARGEST`; `pixels` itself, where it already is. Values above `clamp` become `clamp`.
        Without it infinite values, such as a sun that half floats cannot hold, become the greatest finite
        value. NaN and negative values, which no light has, become 0; negative ones without a word where they
        are `NEGLIGIBLE`.

    Raises
    ------
    InputFileError
        It holds no finite value.

    Warns
    -----
    RsibrWarning
        Values were changed; says how many, and to what.
    """
    with np.errstate(over="ignore"):
        radiance = pixels.astype(np.float32, copy=False)
    most = np.float32(LARGEST if clamp is None else clamp)
    if np.min(radiance) >= 0.0 and np.max(radiance) <= most:
        return radiance
    finite = np.isfinite(radiance)
    if not finite.any():
        raise InputFileError(f"{name} holds no finite value: make it again.")
    if clamp is None:
        most = min(most, np.max(radiance, where=finite, initial=0.0))
    is_limited = clamp is not None or most == np.float32(LARGEST)
    changes = (
        (f"values above {most:g}" if is_limited else "infinite values", radiance > most, most),
        ("undefined (NaN) values", np.isnan(radiance), np.float32(0.0)),
        ("negative values", radiance < 0.0, np.float32(0.0)),
    )
    is_told = not _has_negligible_negatives(radiance)
    radiance = radiance.copy()
    for kind, where, instead in changes:
        if not (count := np.count_nonzero(where)):
            continue
        radiance[where] = instead
        if is_told or kind != "negative values":
            warn(f"{name} holds {count} {kind}; they are taken as {instead:g}.")
    return radiance


def _has_negligible_negatives(radiance: Array) -> bool:
    with np.errstate(invalid="ignore"):  # a signalling NaN is heard where it is not summed, too
        negative = -np.sum(radiance, where=radiance < 0.0, dtype=np.float64)
        others = np.sum(radiance, where=(radiance > 0.0) & np.isfinite(radiance), dtype=np.float64)
    return bool(negative <= NEGLIGIBLE * others)
