"""How narrow a reflectance's lobes are: as its models state it, or from their values where they do not."""

from math import log, pi, sqrt

import numpy as np

from ..ties import first_greatest
from .layered import is_diffuse, uncoated
from .model import Brdf
from .phong import Phong
from .principled import Principled
from .retroreflective import Retroreflective
from .tabulated import directions_from_angles

NARROWEST = 1e-4
"""Least width that is told."""

_HALF_ANGLES = np.geomspace(NARROWEST, 1.0, 200)
_DIFFERENCE_ANGLES = np.radians([5.0, 30.0, 55.0, 75.0])
_OF_A_GAUSSIAN = 1.0 / sqrt(log(2.0))


def narrowest_alpha(brdf: Brdf) -> float:
    """Width of a model's narrowest lobe, in normals.

    Returns
    -------
    float
        From `NARROWEST` to 1, which diffuse reflection has: the models' own alpha; a cosine's power, which is
        of directions, is twice as wide in these; and of models without either, see `measured_alpha`.
    """
    return max(min(_alpha(uncoated(layer)) for layer in brdf.layers), NARROWEST)


def is_resolved(alpha: float, height: int) -> bool:
    """Whether a sum over texels of light is good for a lobe: it is two texels wide at least.

    Parameters
    ----------
    alpha : float
        The lobe's width, as `narrowest_alpha` tells.
    height : int
        Rows of the light, a latitude-longitude picture.
    """
    return alpha >= pi / height


def _alpha(layer: Brdf) -> float:
    if is_diffuse(layer):
        return 1.0
    if isinstance(layer, Principled):
        return min(layer.roughness**2, layer.coat_roughness**2 if np.any(layer.coat_weight) else 1.0)
    if isinstance(layer, Phong | Retroreflective):
        return 0.5 * sqrt(2.0 / (layer.n + 2.0))
    stated: float | None = getattr(layer, "alpha", None)
    return measured_alpha(layer) if stated is None else stated


def measured_alpha(brdf: Brdf) -> float:
    """Width of a lobe from its values: the alpha of Ward's model that falls as fast to half its height.

    Parameters
    ----------
    brdf : Brdf
        A single lobe about the mirror direction, on any base.

    Returns
    -------
    float
        From `NARROWEST` to 1: the least at four difference angles, which are half of those between light and
        view, with half vectors that lean across the plane of both. A lobe that is no brighter than twice its
        base counts as diffuse, and has 1. GGX, which is sharper at its top than its tail tells, has 0.77 of
        its own alpha.
    """
    return min(_alpha_at(brdf, angle) for angle in _DIFFERENCE_ANGLES)


def _alpha_at(brdf: Brdf, difference_angle: float) -> float:
    values = brdf(*directions_from_angles(_HALF_ANGLES, difference_angle, 0.5 * np.pi)).sum(axis=-1)
    base, peak = values[-1], first_greatest(values)
    below = np.flatnonzero(values[peak:] < 0.5 * (base + values[peak]))
    if values[peak] <= 2.0 * base or not len(below):
        return 1.0
    return min(_OF_A_GAUSSIAN * float(np.tan(_HALF_ANGLES[peak + below[0]])), 1.0)
