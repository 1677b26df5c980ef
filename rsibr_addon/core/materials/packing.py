"""Baked inputs, and the pictures that hold them: a colour or normal fills one, three values share one."""

from collections.abc import Iterable
from dataclasses import fields, replace
from typing import Any

from .principled import Baked, Input, NormalMap, PrincipledInputs, Row, Texture, constant

COLORS = ("base_color", "specular_tint", "coat_tint", "sheen_tint", "emission_color")
NORMALS = ("normal", "coat_normal")

Picture = tuple[str, ...]
"""What a picture holds: a colour's or a normal's field of `PrincipledInputs`, or up to three values'."""

CHANNELS: tuple[Row, ...] = (
    (1.0, 0.0, 0.0, 0.0, 0.0),
    (0.0, 1.0, 0.0, 0.0, 0.0),
    (0.0, 0.0, 1.0, 0.0, 0.0),
)
"""A picture's red, green and blue as they are."""


def bytes_needed(pictures: int, size: int) -> float:
    """Memory for baking pictures of `size` by `size` texels, as measured.

    Returns
    -------
    float
        Bytes: what Cycles needs, and the pictures until they are written.
    """
    return 60.0 * pictures * size**2


def pictures_of(inputs: PrincipledInputs) -> tuple[Picture, ...]:
    """The pictures that hold all inputs that are `Baked`."""
    found = {field.name: getattr(inputs, field.name) for field in fields(inputs)}
    baked = {name: value for name, value in found.items() if isinstance(value, Baked)}
    alone = [(name,) for name, value in baked.items() if value.apart or name in COLORS + NORMALS]
    values = [name for name in baked if (name,) not in alone]
    return (*alone, *(tuple(values[first : first + 3]) for first in range(0, len(values), 3)))


def with_pictures(inputs: PrincipledInputs, textures: Iterable[tuple[Picture, Texture]]) -> PrincipledInputs:
    """Inputs with pictures in the place of what is `Baked`.

    Parameters
    ----------
    inputs : PrincipledInputs
    textures : iterable of (Picture, Texture)
        What there is. Of inputs that are no longer `Baked` it may tell too: they stay as they are.

    Returns
    -------
    PrincipledInputs
        What no picture holds stays `Baked`.
    """
    found: dict[str, Any] = {}
    for picture, texture in textures:
        for number, name in enumerate(picture):
            if name in NORMALS:
                found[name] = NormalMap(Input(CHANNELS, texture), constant((1.0,)), texture.uv_map)
            elif name in COLORS:
                found[name] = Input(CHANNELS, texture)
            else:
                found[name] = Input((CHANNELS[number],), texture)
    known = {name: value for name, value in found.items() if isinstance(getattr(inputs, name), Baked)}
    return replace(inputs, **known)
