"""Rough diffuse reflection: Oren and Nayar's, improved by Fujii, with light that bounces between facets."""

import numpy as np

from ..conventions import Array, ArrayLike


def fujii_coefficients(roughness: ArrayLike) -> tuple[Array, Array]:
    """A and B of [Fujii2012]: brdf = A + B `tilt`.

    Parameters
    ----------
    roughness : array_like, shape (...,)
        In [0, 1]; 0 is Lambert's reflection.

    Returns
    -------
    a, b : ndarray, shape (...,)
    """
    roughness = np.asarray(roughness, dtype=np.float64)
    a: Array = 1.0 / (np.pi + roughness * (np.pi / 2.0 - 2.0 / 3.0))
    return a, roughness * a


def tilt(n_dot_l: Array, n_dot_v: Array, l_dot_v: Array) -> Array:
    """What facets that lean towards light or view add: s / t of [Fujii2012].

    Parameters
    ----------
    n_dot_l, n_dot_v, l_dot_v : ndarray, shape (...,)
        Cosines between normal, light and view; the first two in [0, 1].

    Returns
    -------
    ndarray, shape (...,)
        At least -1; negative where light and view lie on opposite sides of the normal.
    """
    s = l_dot_v - n_dot_l * n_dot_v
    leaning: Array = np.where(s > 0.0, s / np.maximum(np.maximum(n_dot_l, n_dot_v), 1e-12), s)
    return leaning


def leaning_albedo(cosine: ArrayLike) -> Array:
    """Integral of `tilt` times the other cosine over the hemisphere.

    Parameters
    ----------
    cosine : array_like, shape (...,)
        Of light or view to the normal, in [0, 1].

    Returns
    -------
    ndarray, shape (...,)
        G of [Portsmouth2025].
    """
    cosine = np.maximum(np.asarray(cosine, dtype=np.float64), 1e-6)
    sine = np.sqrt(np.maximum(1.0 - cosine**2, 0.0))
    angle = np.arccos(np.minimum(cosine, 1.0))
    albedo: Array = sine * (angle - 2.0 / 3.0 - sine * cosine)
    albedo += 2.0 / 3.0 * sine / cosine * (1.0 - sine**3)
    return albedo


def bounces(color: ArrayLike, roughness: ArrayLike, n_dot_v: ArrayLike) -> Array:
    """Light that facets send to each other: brdf = `bounces` (1 - albedo of a single one towards the light).

    Parameters
    ----------
    color : array_like, shape (..., 3)
        Reflectance of the facets, in [0, 1].
    roughness, n_dot_v : array_like, shape (...,)

    Returns
    -------
    ndarray, shape (..., 3)
        Over `color`, as the single bounce is; [Portsmouth2025], as Cycles has it.
    """
    color = np.clip(np.asarray(color, dtype=np.float64), 0.0, 1.0)
    a, b = fujii_coefficients(roughness)
    mean = np.pi * a + (2.0 * np.pi - 5.6) / 3.0 * b
    lost = 1.0 - np.pi * a - b * leaning_albedo(n_dot_v)
    # Smooth surfaces lose nothing, and what they lose has no mean
    share = np.divide(lost * mean, 1.0 - mean, out=np.zeros(np.shape(lost)), where=mean < 1.0 - 1e-9)
    found: Array = color**2 * share[..., None] / np.pi / (1.0 - color * (1.0 - mean)[..., None])
    return found
