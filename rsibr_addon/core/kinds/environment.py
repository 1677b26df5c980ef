"""Shading from an environment itself: a mirror, exact to the texel, and the reference of all other kinds."""

from dataclasses import dataclass

import numpy as np

from ..antialiased.averaging import Averaging, footprint_mean
from ..antialiased.footprint import footprint_or_point
from ..brdf.fresnel import fresnel_schlick
from ..conventions import Array, ArrayLike
from ..environment import Environment
from ..geometry.directions import dot, reflect
from ..geometry.sides import seen_surface
from ..maps import equirect
from ..options import Options
from ..resample import bilinear
from .look_options import antialiased_option, averaging_option, colour_option


@dataclass(frozen=True)
class EnvironmentLook(Options):
    """How a mirror in an environment is shaded."""

    f0: tuple[float, float, float] = colour_option(
        1.0, "Reflectance", "Reflectance of the mirror at normal incidence; 1 is a perfect mirror", "f_lambda"
    )
    antialiased: bool = antialiased_option("the light")
    averaging: Averaging = averaging_option()


def mirrored_environment(
    environment: Environment,
    normal: ArrayLike,
    view_dir: ArrayLike,
    look: EnvironmentLook,
    mirror_footprint: ArrayLike | None = None,
    facet: ArrayLike | None = None,
) -> Array:
    """Radiance of a mirror's points: the environment's by the mirror direction, times Schlick's F.

    Parameters and result are those of every kind's shading: see `core.kinds`.

    Notes
    -----
    Texels are interpolated as in Cycles, and averaged over pixels that reflect more than a texel as in
    [Miller1984] section 8. GLSL twin: gpu_shaders/environment_frag.glsl.
    """
    normal, view_dir = np.broadcast_arrays(np.asarray(normal, np.float64), np.asarray(view_dir, np.float64))
    normal = seen_surface(normal, view_dir, facet).mirror_normal
    cosine = np.clip(dot(normal, view_dir), 0.0, 1.0)
    mirror_dir, radiance = reflect(view_dir, normal), environment.radiance
    if look.antialiased:
        corners = footprint_or_point(mirror_footprint, mirror_dir)
        light = footprint_mean(radiance, mirror_dir, corners, look.averaging)
    else:
        light = bilinear(radiance, equirect.uv_from_direction(mirror_dir), equirect.wrap)
    shaded: Array = fresnel_schlick(cosine[..., None], look.f0) * light
    return shaded
