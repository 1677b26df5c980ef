"""Cycles' sheen as polynomials, in place of its tables, so that a reflectance model has it."""

from collections.abc import Callable

import numpy as np

from ..conventions import Array
from ..progress import Progress, Steps
from .model import Geometry
from .sheen import Sheen, transformed_cosine

LEAST_ROUGHNESS = 0.1
"""Sheen of less is hardly there; it is that of this."""

DEGREE = 7

SAMPLES = 64
"""Roughnesses, and elevations, at which polynomials are fitted: twice as many as in Cycles' tables."""

_GRAZING = 0.05
_LEAST_ALBEDO, _LEAST_COUNT = 1e-4, 1e-3

_ROWS = """
-1.2201 0.66093 0.13878 0.068934 0.024733 0.007356 0.0091515 0.003727
1.0774 -0.69277 -0.28553 -0.12864 -0.023335 -0.0096278 -0.014594 -0.0047304
-0.0091083 0.21048 0.22662 0.074815 -0.0091072 0.00097473 0.0075793 -1.8316e-05
-0.082768 -0.14378 -0.13541 -0.023523 0.017668 0.0021038 -0.00075644 0.0041173
0.038925 0.10354 0.052226 -0.0013211 -0.0089114 -0.0023888 -0.0052603 -0.0056205
-0.033314 -0.053308 -0.0044065 0.0058341 -0.00034772 0.0044277 0.0082495 0.0039343
0.015375 0.026076 -0.0059237 -0.0042697 0.0019116 -0.0049501 -0.0064177 -0.0014096
-0.0054265 -0.0045415 0.0028581 0.0016288 -0.00055419 0.0023015 0.0027237 0.00012419
-0.11726 0.9661 0.14222 0.4208 0.17057 0.069548 0.028895 -0.015296
-0.1597 -1.3784 -0.37435 -0.75118 -0.28299 -0.11696 -0.038133 0.037486
0.48973 0.58543 0.54121 0.51602 0.17694 0.073793 -0.0038494 -0.045223
-0.34794 -0.27532 -0.53128 -0.2399 -0.1006 -0.031948 0.039018 0.039676
0.20316 0.1556 0.32807 0.057649 0.067011 -0.0014647 -0.04994 -0.021307
-0.089401 -0.082764 -0.13366 -0.011035 -0.047059 0.017349 0.034627 0.0020762
0.027225 0.035097 0.035395 0.012291 0.022429 -0.016548 -0.012715 0.0068212
0.00019572 -0.018086 0.0027176 -0.016094 0.00045998 0.0064937 -0.001545 -0.0036096
-2.3653 -2.554 -0.45923 0.21262 0.096134 -0.034611 -0.039999 -0.013064
2.3584 2.6931 0.068177 -0.55407 -0.16827 0.084557 0.076398 0.020107
-0.61278 -0.38922 0.5599 0.48033 0.055119 -0.10944 -0.065517 -0.011863
0.043466 -0.24659 -0.42731 -0.17695 0.083459 0.11771 0.048448 0.0056205
0.040363 0.17232 0.14861 -0.022452 -0.11889 -0.084946 -0.025735 -0.0012674
-0.016434 -0.053131 -0.014546 0.060414 0.076104 0.038739 0.008004 -0.00037767
0.00044942 0.0074867 -0.0091081 -0.031942 -0.028097 -0.010157 -0.0008631 0.00025583
0.00088357 -4.4653e-05 0.0028809 0.0074781 0.0049983 0.00076288 -5.2183e-05 0.00016758
"""

COEFFICIENTS = np.loadtxt(_ROWS.splitlines()).reshape(3, DEGREE + 1, DEGREE + 1)
"""Of the logarithm of a, of b / a, and of the logarithm of the albedo: those of polynomials of Chebyshev.

Of each there is a row for each degree in roughness, with a number for each degree in elevation, see
`_of_roughness` and `_of_elevation`. `.ci/fit_families.py` makes them.
"""


def sheen_at(roughness: float, mu: Array) -> Sheen:
    """Sheen of one roughness.

    Parameters
    ----------
    roughness : float
        In [0, 1].
    mu : ndarray, shape (S,)
        n.v, in [0, 1].

    Returns
    -------
    Sheen
        Of a roughness of .2 or more, the albedo is within .003 of Cycles'. Where that is .01 or more, the
        relative root-mean-square error over the hemisphere is 4 % at most.
    """
    by_elevation = np.tensordot(_of_roughness(roughness), COEFFICIENTS, (0, 1))
    log_a, lean, log_albedo = by_elevation @ _of_elevation(mu).T
    a = np.exp(np.minimum(log_a, 0.0))
    return Sheen(mu, a, lean * a, np.exp(log_albedo))


def sheen_brdf(roughness: float, geometry: Geometry) -> Array:
    """White sheen, shape (N,) [1/sr].

    Parameters
    ----------
    roughness : float
        In [0, 1].
    geometry : Geometry
    """
    mu, height = geometry.n_dot_v, geometry.n_dot_l
    sheen = sheen_at(roughness, mu)
    towards = (geometry.l_dot_v - mu * height) / np.sqrt(np.maximum(1.0 - mu**2, 1e-12))
    across = np.sqrt(np.maximum(1.0 - towards**2 - height**2, 0.0))
    found: Array = sheen.albedo * transformed_cosine(towards, across, height, sheen.a, sheen.b) / height
    return found


def fit_polynomials(sheen_of: Callable[[float, Array], Sheen]) -> Steps[Array]:
    """Polynomials of a sheen.

    Parameters
    ----------
    sheen_of : callable
        From a roughness and cosines of views, shape (N,), to the sheen.

    Returns
    -------
    ndarray, shape (3, DEGREE + 1, DEGREE + 1)
        As `COEFFICIENTS`, nearest in least squares: of the transform those matter most whose albedo is
        largest, and where that is less than 1e-4, it is of no account.
    """
    place = (2.0 * np.arange(SAMPLES) + 1.0) / SAMPLES - 1.0
    mu = _GRAZING * ((1.0 + 1.0 / _GRAZING) ** (0.5 * (place + 1.0)) - 1.0)
    of_elevations = _of_elevation(mu)
    terms, found = [], []
    for number, root in enumerate(np.linspace(np.sqrt(LEAST_ROUGHNESS), 1.0, SAMPLES).tolist()):
        yield Progress(number, SAMPLES, f"sheen of roughness {root**2:.2f}")
        terms.append((_of_roughness(root**2)[:, None] * of_elevations[:, None]).reshape(SAMPLES, -1))
        found.append(sheen_of(root**2, mu))
    a, b, albedo = (np.concatenate([getattr(each, name) for each in found]) for name in ("a", "b", "albedo"))
    is_there = albedo > _LEAST_ALBEDO
    counts = np.where(is_there, np.sqrt(albedo), 0.0)
    wanted = (
        (counts, np.log(a)),
        (counts, b / a),
        (np.maximum(albedo, _LEAST_COUNT), np.log(np.maximum(albedo, _LEAST_ALBEDO))),
    )
    rows = np.concatenate(terms)
    fitted = [np.linalg.lstsq(rows * count[:, None], count * value)[0] for count, value in wanted]
    return np.reshape(fitted, (3, DEGREE + 1, DEGREE + 1))


def _of_roughness(roughness: float) -> Array:
    """Polynomials of a roughness, whose square root counts, shape (DEGREE + 1,)."""
    root, least = np.sqrt(np.clip(roughness, LEAST_ROUGHNESS, 1.0)), np.sqrt(LEAST_ROUGHNESS)
    return _polynomials(2.0 * (root - least) / (1.0 - least) - 1.0)


def _of_elevation(mu: Array) -> Array:
    """Polynomials of n.v, shape (S, DEGREE + 1), dense at grazing, where sheen changes most."""
    return _polynomials(2.0 * np.log(mu / _GRAZING + 1.0) / np.log(1.0 / _GRAZING + 1.0) - 1.0)


def _polynomials(place: Array) -> Array:
    """Chebyshev's at places from -1 to 1, shape (..., DEGREE + 1)."""
    angle = np.arccos(np.clip(place, -1.0, 1.0))
    polynomials: Array = np.cos(np.arange(DEGREE + 1) * angle[..., None])
    return polynomials
