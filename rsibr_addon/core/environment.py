"""The environment: incoming radiance from every direction, as a latitude-longitude map."""

import hashlib
import warnings
from dataclasses import dataclass, field

import numpy as np

from .conventions import Array
from .errors import InputFileError, RsibrWarning


@dataclass(frozen=True)
class Environment:
    """Incoming radiance over the sphere in Cycles' own equirectangular layout.

    Attributes
    ----------
    radiance : ndarray, shape (height, 2 * height, 3), float32
        Scene-linear Rec. 709 radiance, finite and not negative; row 0 looks down (-Z).
    name : str
        What a person calls it, for reports: a file's name, or a world's.
    sha256 : str
        Hash of the radiance as little-endian float32 in the order above.
    """

    radiance: Array
    name: str
    sha256: str = field(init=False)

    def __post_init__(self) -> None:
        pixels = np.ascontiguousarray(self.radiance, dtype="<f4")
        object.__setattr__(self, "sha256", hashlib.sha256(pixels.data).hexdigest())


def environment_from_pixels(pixels: Array, name: str) -> Environment:
    """Check that `pixels` can light a scene, and make it an `Environment`.

    Parameters
    ----------
    pixels : ndarray, shape (height, width, 3)
        Radiance, row 0 at the bottom.
    name : str
        Named in messages: the file, or the world.

    Returns
    -------
    Environment
        Of `usable_radiance`.

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
            f"twice as wide as high: resize or convert it."
        )
    return Environment(usable_radiance(pixels, name), name)


def usable_radiance(pixels: Array, name: str) -> Array:
    """Make radiance of what a picture holds.

    Parameters
    ----------
    pixels : ndarray, any shape
    name : str
        Named in messages: the file, or the world.

    Returns
    -------
    ndarray, shape of `pixels`, float32
        At least 0 and finite: `pixels` itself, where it is such; what is infinite, as a sun that half
        floats cannot hold, is the greatest finite value; NaN and what is negative, which no light is, is 0.

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
    if np.min(radiance) >= 0.0 and np.max(radiance) < np.inf:
        return radiance
    finite = np.isfinite(radiance)
    if not finite.any():
        raise InputFileError(f"{name} holds no finite value: make it again.")
    greatest = np.max(radiance, where=finite, initial=0.0)
    changes = (
        ("infinite", radiance == np.inf, greatest),
        ("undefined (NaN)", np.isnan(radiance), np.float32(0.0)),
        ("negative", radiance < 0.0, np.float32(0.0)),
    )
    radiance = radiance.copy()
    for kind, where, instead in changes:
        if count := np.count_nonzero(where):
            radiance[where] = instead
            warnings.warn(
                f"{name} holds {count} {kind} values; they are taken as {instead:g}.",
                RsibrWarning,
                stacklevel=2,
            )
    return radiance
