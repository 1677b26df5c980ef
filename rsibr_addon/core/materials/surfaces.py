"""Principled materials at surface points: what their inputs are there, from the texels of images."""

from collections.abc import Mapping

import numpy as np

from ..brdf.principled import Surface
from ..conventions import Array
from ..errors import ShapeError
from .principled import Input, PrincipledInputs, Shading, Texture
from .sampling import evaluate

TINTS = ("base_color", "specular_tint", "coat_tint", "sheen_tint")
SHARES = ("roughness", "diffuse_roughness", "coat_roughness")
"""Values that are kept within 0 and 1, as Cycles does."""
VALUES = (
    "metallic",
    "ior",
    "alpha",
    "specular_level",
    "coat_weight",
    "coat_ior",
    "sheen_weight",
    "sheen_roughness",
)


def surface_at(inputs: PrincipledInputs, texels: Mapping[Texture, Array], uv: Mapping[str, Array]) -> Surface:
    """A material at surface points.

    Parameters
    ----------
    inputs : PrincipledInputs
    texels : mapping of Texture to ndarray, shape (height, width, 4)
        In scene-linear colours, row 0 at the bottom.
    uv : mapping of str to ndarray, shape (..., 2)
        UV maps at the points, that which the mesh renders with under the empty name.

    Raises
    ------
    ShapeError
        An input is still to be baked.

    Notes
    -----
    GLSL twin: gpu_shaders/principled_textured_frag.glsl.
    """

    def color(value: Shading) -> Array:
        return value_at(value, texels, uv)

    def number(value: Shading) -> Array:
        found: Array = color(value)[..., 0]
        return found

    return Surface(
        **{name: color(getattr(inputs, name)) for name in TINTS},
        **{name: number(getattr(inputs, name)) for name in VALUES},
        **{name: np.clip(number(getattr(inputs, name)), 0.0, 1.0) for name in SHARES},
        emission=color(inputs.emission_color) * color(inputs.emission_strength),
    )


def value_at(value: Shading, texels: Mapping[Texture, Array], uv: Mapping[str, Array]) -> Array:
    """An input at surface points.

    Parameters
    ----------
    value : Input
        Of n numbers.
    texels, uv : mapping
        See `surface_at`.

    Returns
    -------
    ndarray, shape (..., n)

    Raises
    ------
    ShapeError
        The input is still to be baked.
    """
    if not isinstance(value, Input):
        raise ShapeError(f"An input of the material is still to be baked ({value.reason}): bake it first.")
    texture = value.texture
    if texture is None:
        return evaluate(value, None, uv[""])
    return evaluate(value, texels[texture], uv.get(texture.uv_map, np.zeros_like(uv[""])))
