"""How bright light is made, and of which colour, where its photographs do not tell."""

import numpy as np

from ..conventions import Array, ArrayLike
from ..errors import RangeError
from ..filtering.irradiance import irradiance_exact
from ..geometry.geodesic import geodesic_sphere
from ..maps import equirect
from .luminance import luminance

CARDS = 162
"""Ways that a card is turned. Neighbours are some 15 degrees apart: irradiance is within 2 % of the most."""

LIT_SHARE = 0.95
"""Share of the directions in a photograph that show no lamps."""


def white_card(radiance: Array) -> float:
    """What a white card shows that is turned to the most light of an environment.

    Parameters
    ----------
    radiance : ndarray, shape (height, 2 * height, 3)
        Latitude-longitude map.

    Returns
    -------
    float
        Luminance: the greatest irradiance, over pi. In light divided by it, a grey card that is turned so is
        middle grey, 0.18, and nothing matte is above white: what is must be a lamp, or near one.
    """
    brightness = luminance(radiance)[..., None]
    return float(irradiance_exact(brightness, geodesic_sphere(CARDS).vertices).max()) / np.pi


def brightest_lit(radiance: Array) -> float:
    """The luminance that a share of all directions, `LIT_SHARE`, is not above.

    Parameters
    ----------
    radiance : ndarray, shape (height, 2 * height, 3)
        Latitude-longitude map.
    """
    height, width = radiance.shape[:2]
    brightness = luminance(radiance)
    order = np.argsort(brightness, axis=None, kind="stable")
    share = np.broadcast_to(equirect.texel_solid_angle(width, height), brightness.shape).ravel()[order]
    lit = brightness.ravel()[order[np.cumsum(share) <= LIT_SHARE * share.sum()]]
    return float(lit[-1]) if len(lit) else 0.0


def balancing(colour: ArrayLike) -> Array:
    """Factors that make a colour grey and keep its luminance.

    Parameters
    ----------
    colour : array_like, shape (3,)
        Linear Rec. 709, above 0.

    Returns
    -------
    ndarray, shape (3,)
    """
    colour = np.asarray(colour, np.float64)
    factors: Array = luminance(colour) / colour
    return factors


def colour_within(picture: Array, x: float, y: float, radius: float) -> Array:
    """The mean colour of a circle in a picture.

    Parameters
    ----------
    picture : ndarray, shape (height, width, 3)
        Row 0 at the bottom.
    x, y, radius : float
        Middle and radius in pixels, from the top left corner.

    Returns
    -------
    ndarray, shape (3,)
        Of the pixels whose middles are within it.

    Raises
    ------
    RangeError
        There is none, or one of the colours is black.
    """
    height, width = picture.shape[:2]
    columns, rows = np.arange(width) + 0.5, height - np.arange(height)[:, None] - 0.5
    within = np.hypot(columns - x, rows - y) <= radius
    where = f"The circle {x:g},{y:g},{radius:g} of the card"
    if not np.any(within):
        raise RangeError(f"{where} holds no pixel of the picture's {width}x{height}: give another.")
    colour: Array = np.asarray(picture[within], np.float64).mean(axis=0)
    if not np.all(colour > 0.0):
        raise RangeError(f"{where} is black: give one that light falls on.")
    return colour
