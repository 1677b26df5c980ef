"""What is shown of a material where it cannot be read, or is not there."""

from collections.abc import Callable
from dataclasses import fields, replace
from functools import partial
from typing import Any

from .principled import Baked, Bump, Input, NormalMap, PrincipledInputs, constant

PLAIN = PrincipledInputs(
    base_color=constant((0.8, 0.8, 0.8)),
    metallic=constant((0.0,)),
    roughness=constant((0.5,)),
    ior=constant((1.5,)),
    specular_level=constant((0.5,)),
    specular_tint=constant((1.0, 1.0, 1.0)),
    diffuse_roughness=constant((0.0,)),
    coat_weight=constant((0.0,)),
    coat_roughness=constant((0.03,)),
    coat_ior=constant((1.5,)),
    coat_tint=constant((1.0, 1.0, 1.0)),
    sheen_weight=constant((0.0,)),
    sheen_roughness=constant((0.5,)),
    sheen_tint=constant((1.0, 1.0, 1.0)),
    emission_color=constant((1.0, 1.0, 1.0)),
    emission_strength=constant((0.0,)),
    alpha=constant((1.0,)),
    normal=None,
    coat_normal=None,
)
"""A Principled BSDF as Blender adds it."""

UNASSIGNED = replace(PLAIN, specular_level=constant((0.0,)))
"""What Cycles shows where a slot, or an object, has no material: diffuse reflection of .8."""

BLACK = replace(UNASSIGNED, base_color=constant((0.0, 0.0, 0.0)))
"""What Cycles shows of a material without a surface."""

NO_IMAGE = (1.0, 0.0, 1.0, 1.0)
"""The texel that Cycles shows for an image that is not there."""


def without_image(value: Input) -> Input:
    """An input whose image is not there."""
    return constant([sum(a * b for a, b in zip(row, (*NO_IMAGE, 1.0), strict=True)) for row in value.rows])


def readable(
    inputs: PrincipledInputs, read: Callable[[str, Input | Baked], Input | None]
) -> PrincipledInputs:
    """Inputs, with stand-ins for what cannot be read.

    Parameters
    ----------
    inputs : PrincipledInputs
    read : callable
        Gives for each input, by the name of its field, what is shown of it: None for Blender's default. What
        a normal map or a bump is made of has the name of the field that it lies in.

    Returns
    -------
    PrincipledInputs
        Without `Baked`.
    """
    shown: dict[str, Any] = {}
    for field in fields(inputs):
        value = getattr(inputs, field.name)
        if isinstance(value, Input | Baked):
            shown[field.name] = read(field.name, value) or getattr(PLAIN, field.name)
        elif isinstance(value, NormalMap | Bump):
            shown[field.name] = _readable_normal(value, partial(read, field.name))
    return replace(inputs, **shown)


def _readable_normal(
    normal: NormalMap | Bump, read: Callable[[Input], Input | None]
) -> NormalMap | Bump | None:
    """A normal whose parts can all be read; None where one cannot."""
    parts = {field.name: getattr(normal, field.name) for field in fields(normal)}
    shown: dict[str, Any] = {name: read(part) for name, part in parts.items() if isinstance(part, Input)}
    if isinstance(normal, Bump) and normal.normal is not None:
        shown["normal"] = _readable_normal(normal.normal, read)
    if None in shown.values():
        return None
    changed: NormalMap | Bump = replace(normal, **shown)
    return changed
