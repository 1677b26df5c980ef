"""Reflection tables [Miller1984]: reflected light as maps over one direction each."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import StrEnum

import numpy as np

from ...conventions import Array
from ...errors import RangeError, ShapeError


class Role(StrEnum):
    """The content of a table, and with it the direction of its lookup.

    DIFFUSE, the paper's D, is looked up by the normal; SPECULAR, its S, by the mirrored view direction, and
    so is COAT, the mirror image in a clear varnish; RETRO, light reflected back to its source, by the view
    direction; REFRACTION by the refracted view direction.
    """

    DIFFUSE = "diffuse"
    SPECULAR = "specular"
    COAT = "coat"
    RETRO = "retro"
    REFRACTION = "refraction"


@dataclass(frozen=True)
class ReflectionTables:
    """Tables of one material in one environment, and the weight of each by angle.

    Attributes
    ----------
    maps : dict of Role to ndarray, shape (height, 2 * height, 3), float32
        Radiance over directions as latitude-longitude maps of any sizes: texels hold the values at their
        centres, and lookups between them are bilinear. A material has at least one.
    weights : ndarray, shape (len(Role), M, 3), float32
        One row for each `Role`, in its order; column k is for n.v = (k + 0.5) / M. The paper's Wd, Ws.
    eta : float
        Index of refraction behind the surface over that in front of it, greater than 0.
    parts : mapping of str to str
        The material that they were made of: see `material.material_from_texts`. Empty where it is not known.
    gains : dict of Role to ndarray, shape (3,)
        Factors of tables, 1 where there is none.
    added : ndarray, shape (3,)
        Radiance that is added to the diffuse table, after its gain.

    Raises
    ------
    ShapeError
        There is no table, a map is not twice as wide as high, or the weights do not have a row for each role.
    RangeError
        `eta` is not positive.
    """

    maps: dict[Role, Array]
    weights: Array
    eta: float = 1.0
    parts: Mapping[str, str] = field(default_factory=dict)
    gains: Mapping[Role, Array] = field(default_factory=dict)
    added: Array = field(default_factory=lambda: np.zeros(3))

    def __post_init__(self) -> None:
        if not self.maps:
            raise ShapeError("Reflection tables need at least one map: give a diffuse one, for example.")
        for role, image in self.maps.items():
            if image.ndim != 3 or image.shape[1:] != (2 * image.shape[0], 3):
                raise ShapeError(
                    f"The {role} table must have the shape (height, 2 height, 3), not {image.shape}."
                )
        if self.weights.ndim != 3 or self.weights.shape[::2] != (len(Role), 3):
            raise ShapeError(f"Weights have the shape ({len(Role)}, M, 3), not {self.weights.shape}.")
        if not self.eta > 0.0:
            raise RangeError(f"An index of refraction cannot be {self.eta}: choose one above 0.")
