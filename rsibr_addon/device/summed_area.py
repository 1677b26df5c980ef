"""A summed table on the GPU, in whole numbers that single precision can hold."""

import numpy as np

from ..core.antialiased.summed_area import SummedAreaTable
from ..core.errors import ShapeError
from .textures import GpuTexture

DIGITS = 3
DIGIT_BITS = 21
"""Bits of a digit. Sums have 62 bits; the sum of four digits, one of them in a second turn, fits into 24."""


def summed_area_texture(table: SummedAreaTable) -> GpuTexture:
    """A table as gpu_shaders/lib/summed_area_lib.glsl reads it.

    Parameters
    ----------
    table : SummedAreaTable
        Table of three channels.

    Returns
    -------
    GpuTexture
        RGBA32F, a layer for each digit from the lowest up; one texel wider and higher than the table was.

    Raises
    ------
    ShapeError
        The table does not have three channels.
    """
    if table.sums.shape[-1] != 3:
        raise ShapeError(f"A table for the GPU has red, green and blue, not {table.sums.shape[-1]} channels.")
    layers = np.zeros((DIGITS, *table.sums.shape[:2], 4), dtype=np.float32)
    for digit, layer in enumerate(layers):
        layer[..., :3] = (table.sums >> (DIGIT_BITS * digit)) & (2**DIGIT_BITS - 1)
    return GpuTexture("summed table", layers)
