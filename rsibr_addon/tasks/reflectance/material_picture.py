"""A material as a picture of a sphere: by the shading of previews, or by the model itself."""

from functools import cache

import numpy as np

from ...core.brdf.principled import Principled, Surface
from ...core.conventions import Array
from ...core.geometry.directions import camera_frame, normalize
from ...core.geometry.lit_sphere import environment_about, lit_spheres
from ...core.kinds.kernel_pyramid.bake import bake_pyramid
from ...core.kinds.kernel_pyramid.pyramid import Pyramid
from ...core.kinds.kernel_pyramid.shading import principled_radiance
from ...core.light.transfer_curve import srgb_from_linear
from ...core.maps.representation import representation
from ...core.pictures.sphere import sphere_pixels
from ...core.progress import Steps, drain
from ...core.resample import resample
from ...files.brdfs import brdf_from_spec
from ...files.kinds.kernel_pyramid import shipped_families
from ..light.environments import load_environment

ENVIRONMENT = "interior"
"""The light of materials' pictures: windows make highlights that tell how rough a material is."""

STRENGTH = 0.4
"""Of that light: white then comes out white, and no brighter."""

VIEW_DIR = (0.3, -1.0, 0.35)

SIZE, MAPS = 96, 256
"""Width of a picture in pixels, and of the sharpest maps of its light in texels."""

WIDTH, RINGS = 128, 48
"""Texels around the light of a model that is not Principled, and rings of its sphere."""


def material_picture(spec: str) -> Array:
    """Draw a sphere of a reflectance model, in a second at most.

    Parameters
    ----------
    spec : str
        The model's text.

    Returns
    -------
    ndarray, shape (SIZE, SIZE, 4), float64
        sRGB in [0, 1], not premultiplied, with coverage in alpha; row 0 at the bottom.

    Raises
    ------
    RsibrError
        See `files.brdfs.brdf_from_spec`; or Blender's environment is not there.
    """
    brdf = brdf_from_spec(spec)
    if isinstance(brdf, Principled):
        shown = principled_sphere(_pyramid(), brdf.surface, SIZE)
    else:
        (sphere,) = drain(lit_spheres(brdf, _light(), [(0.0, 0.0, 1.0)], RINGS))
        seen = sphere_pixels(SIZE, VIEW_DIR)
        shown = seen.picture(STRENGTH * sphere.at(seen.normal @ _frame()))
    shown[..., :3] = srgb_from_linear(np.clip(shown[..., :3], 0.0, 1.0))
    return shown


def principled_sphere(pyramid: Pyramid, surface: Surface, size: int) -> Array:
    """A sphere of one Principled material, as previews are shaded.

    Parameters
    ----------
    pyramid : Pyramid
        See `lit_pyramid`.
    surface : Surface
    size : int
        Width of the picture in pixels.

    Returns
    -------
    ndarray, shape (size, size, 4), float64
        Radiance, not premultiplied, and coverage; row 0 at the bottom.
    """
    seen = sphere_pixels(size, VIEW_DIR)
    view_dir = np.broadcast_to(normalize(VIEW_DIR), seen.normal.shape)
    radiance = principled_radiance(pyramid, shipped_families(), surface, seen.normal, view_dir)
    return seen.picture(STRENGTH * radiance)


def lit_pyramid(size: int) -> Steps[Pyramid]:
    """The light of materials' pictures.

    Parameters
    ----------
    size : int
        Width of its sharpest maps in texels.

    Raises
    ------
    InputFileError
        Blender's environment is not there.
    """
    return (yield from bake_pyramid(load_environment(ENVIRONMENT).radiance, size)).pyramid


@cache
def _pyramid() -> Pyramid:
    return drain(lit_pyramid(MAPS))


@cache
def _light() -> Array:
    """The light in the camera's axes: turned later, its few texels would lose their lamps."""
    equirect = representation("equirect")
    about = environment_about(load_environment(ENVIRONMENT).radiance, _frame())
    light: Array = resample(about[None], equirect, equirect, WIDTH)[0]
    return light


def _frame() -> Array:
    return camera_frame(normalize(VIEW_DIR))
