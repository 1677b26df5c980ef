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
        object.__setattr__(self, "sha256", hashlib.sha256(pixels.tobytes()).hexdigest())


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
        With negative radiance, which no light has, set to 0.

    Raises
    ------
    InputFileError
        The map is not twice as wide as high, or holds NaN or infinite values.

    Warns
    -----
    RsibrWarning
        Negative values were set to 0; says how many.
    """
    height, width = pixels.shape[:2]
    if width != 2 * height or height < 1:
        raise InputFileError(
            f"{name} is {width}x{height}, but an environment is a latitude-longitude map, "
            f"twice as wide as high: resize or convert it."
        )
    return Environment(usable_radiance(pixels, name), name)


def usable_radiance(pixels: Array, name: str) -> Array:
    """Check that `pixels` can be radiance.

    Parameters
    ----------
    pixels : ndarray, any shape
    name : str
        Named in messages: the file, or the world.

    Returns
    -------
    ndarray, shape of `pixels`, float32
        With negative radiance, which no light has, set to 0.

    Raises
    ------
    InputFileError
        It holds NaN or infinite values.

    Warns
    -----
    RsibrWarning
        Negative values were set to 0; says how many.
    """
    unusable = int(np.count_nonzero(~np.isfinite(pixels)))
    if unusable:
        raise InputFileError(
            f"{name} holds {unusable} values that are NaN or infinite: repair it in an image editor."
        )
    radiance = pixels.astype(np.float32)
    negative = int(np.count_nonzero(radiance < 0.0))
    if negative:
        warnings.warn(
            f"{name} holds {negative} negative values; they are taken as 0.",
            RsibrWarning,
            stacklevel=2,
        )
        radiance = np.maximum(radiance, np.float32(0.0))
    return radiance
