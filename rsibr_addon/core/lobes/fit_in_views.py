"""A fit, whatever it was made from, beside captured views."""

import numpy as np

from ..conventions import Array
from ..geometry.directions import reflect
from ..kinds.radiance_views.views import RadianceViews
from .captured_light import CapturedLight, in_caches
from .captured_texels import CapturedTexels, captured_texels
from .fit import Fit, lobe_axes

TEXELS = 12000
"""Texels that are compared, those of suns aside."""


def error_in_views(fit: Fit, light: CapturedLight, views: RadianceViews) -> float:
    """Relative root-mean-square error of lobes in captured views, over all texels.

    Parameters
    ----------
    fit : Fit
    light : CapturedLight
        The environment of the captures, filtered with the fit's kernels.
    views : RadianceViews
    """
    texels = captured_texels(views, len(views.diffuse), TEXELS, light.suns.direction)
    captured = texels.diffuse + texels.glossy
    rest = fit_radiance(fit, light, texels) - captured
    return float(np.sqrt(texels.power(rest) / texels.power(captured)))


def fit_radiance(fit: Fit, light: CapturedLight, texels: CapturedTexels) -> Array:
    """Radiance of N texels by a fit, shape (N, 3).

    Parameters
    ----------
    fit : Fit
    light : CapturedLight
        Filtered with the fit's kernels.
    texels : CapturedTexels
    """
    reflect_dir = reflect(texels.view_dir, texels.normal)
    position = np.interp(texels.mu, fit.mu, np.arange(len(fit.mu)))
    below = position.astype(np.intp)
    above = np.minimum(below + 1, len(fit.mu) - 1)
    share = position - below

    def between(table: Array, some: slice = slice(None)) -> Array:
        """A table of elevations at the points."""
        shares = share[some].reshape(-1, *[1] * (table.ndim - 1))
        first, second = (table[np.minimum(each[some], len(table) - 1)] for each in (below, above))
        mixed: Array = first + shares * (second - first)
        return mixed

    radiance = np.zeros(texels.normal.shape)
    for lobe, profile in enumerate(fit.weights):
        offsets, taps = between(fit.offsets[lobe]), between(fit.taps[lobe])
        for tap in range(taps.shape[-1]):
            filtered = light.along(lobe_axes(texels.normal, reflect_dir, offsets[:, tap]))
            for some in in_caches(len(radiance)):
                weights = taps[some, tap, None, None] * between(fit.scale[lobe], some)[:, None]
                weights = weights * between(profile, some)
                by_kernel = filtered[some].reshape(weights.shape)
                radiance[some] += np.einsum("mkc,mkc->mc", weights, by_kernel)
    return texels.means(radiance)
