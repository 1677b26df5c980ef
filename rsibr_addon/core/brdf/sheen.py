"""The sheen of cloth as Cycles has it: fibres above a surface, as a transformed cosine [Zeltner2022].

Its two parameters and its albedo are tables over roughness and elevation, which lie in Cycles' program.
`transform_of` finds them from reflectances, and `sheen_polynomials.sheen_at` has polynomials for them.
"""

from dataclasses import dataclass

import numpy as np

from ..conventions import Array, ArrayLike


@dataclass(frozen=True)
class Sheen:
    """Sheen of one roughness, towards views of S elevations.

    The matrix that takes directions to those of a cosine lobe has the rows (a, 0, b), (0, a, 0), (0, 0, 1).
    Its first axis is along the surface towards the view, its last one the normal.

    Attributes
    ----------
    mu : ndarray, shape (S,)
        n.v, in [0, 1].
    a, b : ndarray, shape (S,)
    albedo : ndarray, shape (S,)
        Directional albedo, in [0, 1].
    """

    mu: Array
    a: Array
    b: Array
    albedo: Array


def transformed_cosine(x: ArrayLike, y: ArrayLike, z: ArrayLike, a: ArrayLike, b: ArrayLike = 0.0) -> Array:
    """A linearly transformed cosine: reflectance times n.l of sheen whose albedo is 1.

    Parameters
    ----------
    x, y, z : array_like, shape (...,)
        Directions to lights in the axes of `Sheen`.
    a, b : array_like, shape (...,)

    Returns
    -------
    ndarray, shape (...,)
        [1/sr]; 0 below the horizon.

    Notes
    -----
    [Zeltner2022] Eq. 3 and 4.
    """
    x, y, z = (np.asarray(each, np.float64) for each in (x, y, z))
    a, b = np.asarray(a, np.float64), np.asarray(b, np.float64)
    above = np.maximum(z, 0.0)
    length_squared = (a * x + b * above) ** 2 + (a * y) ** 2 + above**2
    found: Array = above * a**2 / (np.pi * np.maximum(length_squared, 1e-30) ** 2)
    return found


def transform_of(light_dir: Array, reflectance: Array) -> tuple[float, float, float]:
    """The transform that has given reflectances, in least squares.

    Parameters
    ----------
    light_dir : ndarray, shape (N, 3)
        Unit vectors above the horizon, N of 3 or more, in the axes of `Sheen`.
    reflectance : ndarray, shape (N,)
        [1/sr], above 0.

    Returns
    -------
    a, b, albedo : float
        See `Sheen`.

    Notes
    -----
    Over the cosine, the reflectance is an inverse square of a quadratic form of the direction: of its root
    the unknowns b / a, (1 + b^2) / a^2 and sqrt(albedo) / a are linear.
    """
    x, y, z = light_dir.T
    root = 1.0 / np.sqrt(np.pi * reflectance)
    terms = np.stack([2.0 * x * z, z**2, -root], axis=-1)
    lean, square, scale = np.linalg.lstsq(terms, -(x**2 + y**2), rcond=None)[0].tolist()
    inverse = float(np.sqrt(square - lean**2))
    return 1.0 / inverse, lean / inverse, (scale / inverse) ** 2
