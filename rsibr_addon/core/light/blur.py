"""Blurred environments, to be seen behind objects."""

import numpy as np

from ..conventions import Array
from ..filtering.harmonics.analysis import analyse_environment
from ..filtering.prefilter import analysis_degree, prefilter
from ..filtering.radial_lobes import von_mises_fisher_lobe
from ..filtering.zonal import expand
from ..maps.representation import representation

ROWS = 256
"""Height of a blurred map; a blur of a degree is wider than its texels."""


def blurred(radiance: Array, degrees: float) -> Array:
    """Light filtered with a spherical Gaussian.

    Parameters
    ----------
    radiance : ndarray, shape (height, 2 * height, 3)
    degrees : float
        Its standard deviation each way.

    Returns
    -------
    ndarray, shape (n, 2 * n, 3)
        Of `ROWS`; the light itself where the blur is 0.

    Raises
    ------
    RangeError
        The blur is narrower than the light resolves.
    """
    if not degrees:
        return radiance
    lobe = expand(von_mises_fisher_lobe(1.0 / np.radians(degrees) ** 2), 1e-4)
    harmonics = analyse_environment(radiance, analysis_degree([lobe]))
    texels = representation("equirect").texel_directions(2 * ROWS)[0]
    filtered: Array = prefilter(harmonics, [lobe], texels).radiance[0]
    return filtered
