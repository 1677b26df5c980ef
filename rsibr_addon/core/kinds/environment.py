"""Shading from an environment itself: a mirror, exact to the texel, and the reference of all other kinds."""

from dataclasses import dataclass

import numpy as np

from ..antialiased.footprint import footprint_or_point
from ..antialiased.summed_area import footprint_mean
from ..brdf.fresnel import fresnel_schlick
from ..conventions import Array, ArrayLike
from ..environment import Environment
from ..geometry.directions import dot, reflect
from ..maps import equirect
from ..options import Options, option
from ..resample import bilinear


@dataclass(frozen=True)
class EnvironmentLook(Options):
    """How a mirror in an environment is shaded."""

    f_lambda: tuple[float, float, float] = option(
        (1.0, 1.0, 1.0),
        label="Reflectance",
        help="Reflectance of the mirror at normal incidence; 1 is a perfect mirror",
        least=0.0,
        most=1.0,
        subtype="COLOR",
        metavar="F|R,G,B",
    )
    antialiased: bool = option(
        True,
        label="Antialiased",
        help="Average the light over what each pixel reflects, so that small lamps do not shimmer",
    )


def mirrored_environment(
    environment: Environment,
    normal: ArrayLike,
    view_dir: ArrayLike,
    look: EnvironmentLook,
    mirror_footprint: ArrayLike | None = None,
) -> Array:
    """Radiance of a mirror's points.

    Parameters
    ----------
    environment : Environment
    normal, view_dir : array_like, shape (..., 3)
        Unit vectors in world coordinates.
    look : EnvironmentLook
    mirror_footprint : array_like, shape (..., 4, 3), optional
        Mirrored view directions at the corners of each point's pixel, over which an antialiased look
        averages: see `core.antialiased`. None for points, which reflect one direction each.

    Returns
    -------
    ndarray, shape (..., 3), float64
        The environment's radiance by the mirror direction, times Schlick's F.

    Notes
    -----
    Texels are interpolated as in Cycles, and averaged over pixels that reflect more than a texel as in
    [Miller1984] section 8.3. GLSL twin: gpu_shaders/environment_frag.glsl.
    """
    normal, view_dir = np.broadcast_arrays(np.asarray(normal, np.float64), np.asarray(view_dir, np.float64))
    cosine = np.clip(dot(normal, view_dir), 0.0, 1.0)
    mirror_dir, radiance = reflect(view_dir, normal), environment.radiance
    if look.antialiased:
        light = footprint_mean(radiance, mirror_dir, footprint_or_point(mirror_footprint, mirror_dir))
    else:
        light = bilinear(radiance, equirect.uv_from_direction(mirror_dir), equirect.wrap)
    shaded: Array = fresnel_schlick(cosine[..., None], look.f_lambda) * light
    return shaded
