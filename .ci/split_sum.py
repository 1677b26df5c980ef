"""The split sum of today's engines [Karis2013], without its usual approximations: a peer to measure.

Light is filtered with GGX at normal = view = mirror direction, exactly, and looked up by the mirror
direction; the BRDF's integral is its directional albedo, exactly. What is left is what the split costs.
"""

import numpy as np
from rsibr.rsibr_addon.core.brdf.albedo import directional_albedo
from rsibr.rsibr_addon.core.brdf.lambert import Lambert
from rsibr.rsibr_addon.core.brdf.model import Brdf
from rsibr.rsibr_addon.core.conventions import Array
from rsibr.rsibr_addon.core.filtering.harmonics.analysis import analyse_environment
from rsibr.rsibr_addon.core.filtering.irradiance import irradiance_exact
from rsibr.rsibr_addon.core.filtering.prefilter import analysis_degree, prefilter
from rsibr.rsibr_addon.core.filtering.radial_lobes import ggx_n_dot_l_lobe
from rsibr.rsibr_addon.core.filtering.zonal import expand
from rsibr.rsibr_addon.core.geometry.directions import dot, reflect

ELEVATIONS = np.linspace(0.005, 1.0, 200)
TOLERANCE = 1e-4


def split_sum(brdf: Brdf, radiance: Array, normal: Array, view_dir: Array) -> Array:
    """Radiance of surface points, layer by layer.

    Parameters
    ----------
    brdf : Brdf
        Its layers are Lambertian, or have a width `alpha`.
    radiance : ndarray, shape (height, 2 * height, 3)
        Latitude-longitude map.
    normal, view_dir : ndarray, shape (N, 3)

    Returns
    -------
    ndarray, shape (N, 3)
    """
    mu = np.clip(dot(normal, view_dir), ELEVATIONS[0], 1.0)
    total = np.zeros(normal.shape)
    for layer in brdf.layers:
        albedo = directional_albedo(layer, ELEVATIONS)
        factor = np.stack([np.interp(mu, ELEVATIONS, channel) for channel in albedo.T], axis=-1)
        if isinstance(layer, Lambert):
            total += factor * irradiance_exact(radiance, normal) / np.pi
        else:
            series = [expand(ggx_n_dot_l_lobe(layer.alpha), TOLERANCE)]
            harmonics = analyse_environment(radiance, analysis_degree(series))
            total += factor * prefilter(harmonics, series, reflect(view_dir, normal)).radiance[0]
    return total
