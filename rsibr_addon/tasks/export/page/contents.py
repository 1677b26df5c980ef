"""Textures and displays as a page unpacks them."""

from functools import cache
from typing import Any

import numpy as np

from ....core.companded import companded
from ....core.conventions import Array, Indices
from ....core.half_floats import half_holds
from ....core.pictures.display import table_radiance
from ....core.warned import warn
from ....device.textures import GpuTexture
from ....files.packed_arrays import packed_floats, packed_integers
from ....host.display import displayed_colours
from ....host.scenes import temporary_scene

EXACT = 2**14
"""Textures of at most so many numbers are not rounded, nor those whose alpha is not 1, which are no maps."""

WIDEST = 8192
"""Texels along a texture that most devices take."""


def packed_texture(texture: GpuTexture, exact_from: int | None = None) -> tuple[dict[str, Any], float]:
    """A texture that is not on the GPU yet.

    Parameters
    ----------
    texture : GpuTexture
    exact_from : int, optional
        Row from which on a texture of two dimensions is not rounded, if half floats hold it.

    Returns
    -------
    packed : dict
        "size", its width, height and layers, 0 for a texture of two dimensions; "half", whether half floats
        are enough for it; and either "floats", or "parts", rows after rows: each with "codes", a plane for
        each of three channels and each layer, from which green is taken if it is "relative"; and "unit", see
        `Companded`, or None where codes are the bits of half floats.
    error : float
        Root mean square of what rounding changed, relative to that of the values.

    Warns
    -----
    RsibrWarning
        It is wider or higher than `WIDEST`.
    """
    values = texture.values
    layers = values.shape[0] if values.ndim == 4 else 0
    height, width, _ = values.shape[-3:]
    size = [width, height, layers]
    if max(width, height) > WIDEST:
        warn(
            f"The page has a texture of {width} x {height} texels, and many devices take {WIDEST} at most: "
            f"bake smaller maps, or make the environment smaller by rsibr convert."
        )
    if values.size <= EXACT or not np.all(values[..., 3] == 1.0):
        return {"size": size, "half": False, "floats": packed_floats(values)}, 0.0
    is_half = half_holds([values])
    end = exact_from if is_half else None
    parts, error = [], 0.0
    if end != 0:
        colours = values[:end, ..., :3].astype(np.float64)
        rounded = companded(colours)
        error = float(np.sqrt(np.mean((rounded.values() - colours) ** 2) / np.mean(colours**2)))
        parts.append({"unit": rounded.unit, **_smaller(rounded.codes)})
    if end is not None:
        bits = np.ascontiguousarray(values[end:, :, :3], np.float16).view(np.int16)
        parts.append({"unit": None, **_smaller(bits.astype(np.int32))})
    return {"size": size, "half": is_half, "parts": parts}, error


def _smaller(codes: Indices) -> dict[str, Any]:
    """The codes, or those relative to green if these take less room."""
    red, green, blue = np.moveaxis(codes, -1, 0)
    ways = {False: np.stack([red, green, blue]), True: np.stack([red - green, green, blue - green])}
    packed = {
        relative: packed_integers(planes.reshape(-1, *planes.shape[-2:]), 16, along=(1, 2))
        for relative, planes in ways.items()
    }
    best = min(packed, key=lambda relative: len(packed[relative]["data"]))
    return {"codes": packed[best], "relative": best}


@cache
def packed_display(view_transform: str) -> dict[str, Any]:
    """A view transform's table for sRGB displays: see `core.pictures.display`.

    Returns
    -------
    dict
        Whole numbers to 255, for each channel at each node of blue, green and red.
    """
    with temporary_scene() as scene:
        scene.display_settings.display_device = "sRGB"
        scene.view_settings.view_transform = view_transform
        colours: Array = displayed_colours(scene, table_radiance())
    numbers = np.moveaxis(np.rint(255.0 * colours), -1, 0).astype(np.int32)
    ways = [packed_integers(numbers, 8, along) for along in ((1,), (1, 2), (2, 3))]
    return min(ways, key=lambda packed: len(packed["data"]))
