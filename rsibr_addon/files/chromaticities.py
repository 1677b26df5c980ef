"""Linear Rec. 709 from other primaries, which files state as CIE 1931 chromaticities."""

import numpy as np

from ..core.conventions import Array, ArrayLike

REC_709 = (0.6400, 0.3300, 0.3000, 0.6000, 0.1500, 0.0600, 0.3127, 0.3290)
"""x and y of red, green, blue and white, the order that OpenEXR and Radiance share."""

XYZ = (1.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1 / 3, 1 / 3)
"""CIE XYZ itself as primaries, with the equal-energy white that Radiance gives them."""

BRADFORD = np.array([[0.8951, 0.2664, -0.1614], [-0.7502, 1.7135, 0.0367], [0.0389, -0.0685, 1.0296]])
"""Cone responses from XYZ, for chromatic adaptation [Lam1985]."""

ROUNDING = 1e-3
"""Difference from the identity up to which a matrix comes from rounded chromaticities of Rec. 709 itself."""


def rec709_from(chromaticities: ArrayLike) -> Array:
    """The matrix to linear Rec. 709 from linear RGB of other primaries.

    Parameters
    ----------
    chromaticities : array_like, shape (8,)
        x and y of red, green, blue and white.

    Returns
    -------
    ndarray, shape (3, 3), float64
        For column vectors. Grey stays grey: the white points are matched by Bradford's adaptation
        [Lam1985], as Blender's own colour spaces are. Exactly the identity within `ROUNDING` of it.

    Raises
    ------
    ValueError
        The primaries lie on a line, the white has no luminance, or a number is NaN.
    """
    with np.errstate(over="ignore", invalid="ignore"):
        matrix = _rec709_from(chromaticities)
    if not np.all(np.isfinite(matrix)):
        raise ValueError("its chromaticities span no colours")
    return np.eye(3) if np.max(np.abs(matrix - np.eye(3))) < ROUNDING else matrix


def luminance_weights(chromaticities: ArrayLike) -> Array:
    """Share of each primary in a colour's luminance.

    Parameters
    ----------
    chromaticities : array_like, shape (8,)
        As `rec709_from` takes them.

    Returns
    -------
    ndarray, shape (3,), float64
        They add up to 1.

    Raises
    ------
    ValueError
        As `rec709_from` does.
    """
    weights: Array = _xyz_from_rgb(chromaticities)[0][1]
    return weights


def _rec709_from(chromaticities: ArrayLike) -> Array:
    source, source_white = _xyz_from_rgb(chromaticities)
    target, target_white = _xyz_from_rgb(REC_709)
    gains = (BRADFORD @ target_white) / (BRADFORD @ source_white)
    adapted = np.linalg.solve(BRADFORD, gains[:, None] * (BRADFORD @ source))
    matrix: Array = np.linalg.solve(target, adapted)
    return matrix


def _xyz_from_rgb(chromaticities: ArrayLike) -> tuple[Array, Array]:
    """The matrix whose columns are the primaries' XYZ, and the white's XYZ at Y = 1."""
    x, y = np.asarray(chromaticities, dtype=np.float64).reshape(4, 2).T
    xyz = np.stack([x, y, 1.0 - x - y])
    # The determinant is twice the area of the primaries' triangle
    if not np.all(np.isfinite(xyz)) or abs(np.linalg.det(xyz[:, :3])) < 1e-6 or y[3] <= 0.0:
        raise ValueError("its chromaticities span no colours")
    white = xyz[:, 3] / y[3]
    return xyz[:, :3] * np.linalg.solve(xyz[:, :3], white), white
