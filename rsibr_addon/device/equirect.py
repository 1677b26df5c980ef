"""Latitude-longitude maps on the GPU: interpolated across seam and poles, or summed."""

from dataclasses import dataclass

import numpy as np

from ..core.antialiased.averaging import Averaging
from ..core.antialiased.summed_area import summed_area_table
from ..core.conventions import Array
from ..core.maps.representation import representation
from ..core.resample import bordered
from . import buffers
from .summed_area import summed_area_texture
from .textures import GpuTexture

EQUIRECT = representation("equirect")


@dataclass(frozen=True)
class Sums:
    """A map for antialiased lookup.

    Attributes
    ----------
    texture : GpuTexture
        See `summed_area_texture`.
    unit : ndarray, shape (3,)
        Unit of its sums.
    """

    texture: GpuTexture
    unit: Array


def averaging_number(averaging: Averaging) -> float:
    """What gpu_shaders/lib/averaging_lib.glsl calls a way to average."""
    return float(list(Averaging).index(averaging))


def no_map() -> GpuTexture:
    """A stand-in for a map that is not looked up."""
    return GpuTexture("stand-in", np.zeros((1, 1, 4)))


def no_sums() -> Sums:
    """A stand-in for sums that are not looked up."""
    return Sums(GpuTexture("stand-in", np.zeros((3, 2, 2, 4))), np.ones(3))


def map_sums(image: Array) -> Sums:
    """Sum a map.

    Parameters
    ----------
    image : ndarray, shape (height, 2 * height, 3)
        Radiance.

    Returns
    -------
    Sums
        Three times the memory of `map_texture`.
    """
    table = summed_area_table(image)
    return Sums(summed_area_texture(table), table.unit)


def map_texture(name: str, image: Array) -> GpuTexture:
    """A map to be interpolated, as gpu_shaders/lib/equirect_lib.glsl reads it.

    Parameters
    ----------
    name : str
        For messages.
    image : ndarray, shape (height, 2 * height, 3)
        Radiance.

    Returns
    -------
    GpuTexture, RGBA32F
    """
    return GpuTexture(name, buffers.with_alpha(bordered(image[None], EQUIRECT)[0]))
