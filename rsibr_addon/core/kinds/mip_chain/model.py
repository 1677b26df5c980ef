"""The reflectance that a mip chain approximates: Lambert's and a glossy lobe, shared out by Fresnel."""

import numpy as np

from ...brdf.fresnel import Schlick, fresnel_schlick
from ...brdf.ggx import Ggx
from ...brdf.model import BrdfFunction
from ...conventions import Array
from ...errors import RangeError
from ...geometry.directions import dot

Colour = tuple[float, float, float]


def glossy_model(f0: Colour, kd: Colour, roughness: float | None, exponent: float | None) -> BrdfFunction:
    """The reflectance of a look.

    Parameters
    ----------
    f0, kd : (float, float, float)
        See `shading.MipLook`.
    roughness : float or None
        Above 0: the glossy lobe is that of GGX microfacets, with their own Fresnel term and shadowing, which
        a mip does not know.
    exponent : float or None
        Instead of a roughness: the glossy lobe is Phong's, times the Fresnel term of the view's angle.

    Returns
    -------
    callable

    Raises
    ------
    RangeError
        The roughness is 0: a mirror has no reflectance that could be summed.

    Notes
    -----
    [Kautz2004] Eq. 8 and 11. Phong's lobe has no cosine of the light's angle, by which it is divided here.
    """
    if roughness == 0.0:
        raise RangeError("A mirror has no reflectance to compare with: give a roughness above 0.")
    facets = None if roughness is None else Ggx(alpha=roughness**2, fresnel=Schlick(f0=f0))

    def reflectance(light_dir: Array, view_dir: Array) -> Array:
        light_dir, view_dir = np.broadcast_arrays(light_dir, view_dir)
        fresnel = fresnel_schlick(np.clip(view_dir[..., 2:], 0.0, 1.0), f0)
        above = (light_dir[..., 2:] > 0.0) & (view_dir[..., 2:] > 0.0)
        diffuse = np.where(above, (1.0 - fresnel) * np.asarray(kd) / np.pi, 0.0)
        if facets is not None:
            return np.asarray(diffuse + facets(light_dir, view_dir))
        n = exponent or 1.0
        mirrored = dot(view_dir * (-1.0, -1.0, 1.0), light_dir)[..., None]
        lobe = (n + 1.0) / (2.0 * np.pi) * np.maximum(mirrored, 0.0) ** n
        shaped = fresnel * lobe / np.maximum(light_dir[..., 2:], 1e-9)
        return np.asarray(diffuse + np.where(above, shaped, 0.0))

    return reflectance
