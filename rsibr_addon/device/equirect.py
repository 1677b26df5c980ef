"""Latitude-longitude maps on the GPU: interpolated across seam and poles, or summed."""

from dataclasses import dataclass

import gpu
import numpy as np

from ..core.antialiased.summed_area import summed_area_table
from ..core.conventions import Array
from ..core.errors import DeviceError
from ..core.maps import equirect
from . import buffers
from .summed_area import summed_area_texture


@dataclass(frozen=True)
class Sums:
    """A map for antialiased lookup.

    Attributes
    ----------
    texture : GPUTexture
        See `summed_area_texture`.
    unit : ndarray, shape (3,)
        Unit of its sums.
    """

    texture: gpu.types.GPUTexture
    unit: Array


def no_map() -> gpu.types.GPUTexture:
    """A stand-in for a map that is not looked up."""
    return buffers.texture(np.zeros((1, 1, 4)))


def no_sums() -> Sums:
    """A stand-in for sums that are not looked up."""
    return Sums(buffers.texture_array(np.zeros((3, 2, 2, 4))), np.ones(3))


def map_sums(image: Array) -> Sums:
    """Sum a map and upload it.

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


def map_texture(name: str, image: Array) -> gpu.types.GPUTexture:
    """Upload a map to be interpolated, as gpu_shaders/lib/equirect_lib.glsl reads it.

    Parameters
    ----------
    name : str
        For messages.
    image : ndarray, shape (height, 2 * height, 3)
        Radiance.

    Returns
    -------
    GPUTexture, RGBA32F

    Raises
    ------
    DeviceError
        It is larger than the device takes.
    """
    width, largest = image.shape[1] + 2, gpu.capabilities.max_texture_size_get()
    if width > largest:
        raise DeviceError(
            f"The {name} takes a texture {width} wide, and this device has {largest} at most: "
            f"make a smaller one."
        )
    return buffers.texture(buffers.with_alpha(bordered(image)))


def bordered(image: Array) -> Array:
    """A latitude-longitude map with a border of the texels across its seam and poles.

    Parameters
    ----------
    image : ndarray, shape (height, width, channels)

    Returns
    -------
    ndarray, shape (height + 2, width + 2, channels)
    """
    height, width = image.shape[:2]
    columns, rows = np.meshgrid(np.arange(-1, width + 1), np.arange(-1, height + 1))
    columns, rows = equirect.wrap(columns, rows, width, height)
    return image[rows, columns]
