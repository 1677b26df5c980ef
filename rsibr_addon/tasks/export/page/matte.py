"""What lies behind a page's objects: their light or a picture, and a floor that takes their shadow."""

from typing import Any

from ....core.conventions import Array
from ....core.environment import Environment
from ....core.light.median_cut import lamps_above
from ....core.pictures.matte import BACKDROP_ANGLE, EXTENT
from ....device.buffers import with_alpha
from ....device.equirect import map_texture
from ....device.textures import GpuTexture
from ....files.packed_arrays import packed_floats
from ....settings.matte import LIGHT, MatteOptions
from ...matte import BACKDROP_SAMPLES, LAMPS, SHADOW_SIZE, known_light, light_behind
from .contents import packed_texture

LARGEST = 2048
"""Texels along each side of a picture in a page, at most; what is larger is made smaller."""


def packed_matte(
    options: MatteOptions, environment: Environment | None, positions: Array
) -> dict[str, Any] | None:
    """What is behind the objects of a page: see `tasks.matte.Matte`, whose errors it raises.

    Parameters
    ----------
    options : MatteOptions
    environment : Environment or None
        The map set's light.
    positions : ndarray, shape (V, 3)
        The objects' vertices in the world.

    Returns
    -------
    dict or None
        "light", a map with a border, or "picture", each a texture as `packed_texture` has it, or None, and
        "angle", at which a parallel projection sees the light; "exposure" in stops; "samples" along each side
        of a pixel; and "floor", None or its "height", "extent" in radii of the frame, the width of its map,
        "size", and its lamps: their "directions" and "irradiance". None where there is nothing.
    """
    if options.background is None and not options.floor:
        return None
    seen = light_behind(options, environment)
    light = map_texture("background", seen) if options.background == LIGHT and seen is not None else None
    picture = GpuTexture("background", with_alpha(_lowered(seen))) if seen is not None and not light else None
    return {
        "light": light and packed_texture(light)[0],
        "picture": picture and packed_texture(picture)[0],
        "angle": BACKDROP_ANGLE,
        "exposure": options.background_exposure,
        "samples": BACKDROP_SAMPLES,
        "floor": _packed_floor(known_light(environment), positions) if options.floor else None,
    }


def _packed_floor(light: Array, positions: Array) -> dict[str, Any]:
    lamps = lamps_above(light, LAMPS)
    return {
        "height": float(positions[:, 2].min()),
        "extent": EXTENT,
        "size": SHADOW_SIZE,
        "directions": packed_floats(lamps.directions),
        "irradiance": packed_floats(lamps.irradiance),
    }


def _lowered(picture: Array) -> Array:
    """A picture, smaller if it is large: each texel is then the mean of a square of others."""
    step = -(-max(picture.shape[:2]) // LARGEST)
    rows, columns = (size // step for size in picture.shape[:2])
    parts = picture[: rows * step, : columns * step].reshape(rows, step, columns, step, 3)
    lowered: Array = parts.mean(axis=(1, 3))
    return lowered
