"""Models upon models: a coat over a base, and plain sums."""

from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar

import numpy as np

from ..conventions import Array
from ..errors import RangeError
from .albedo import directional_albedo
from .lambert import Lambert
from .model import Brdf, Geometry

COAT_ELEVATIONS = np.linspace(0.0, 1.0, 33) ** 2
"""Cosines between which a coat's albedo is interpolated; closer at grazing, where it changes most."""


@dataclass(frozen=True, kw_only=True)
class Sum(Brdf):
    """The sum of several models."""

    model: ClassVar[str] = "sum"
    parts: tuple[Brdf, ...]

    def __post_init__(self) -> None:
        if not self.parts:
            raise RangeError("A sum needs at least one part, such as (lambert:kd=0.5).")

    def above_horizon(self, geometry: Geometry) -> Array:
        """See `Brdf`."""
        total = np.zeros(geometry.light_dir.shape)
        for part in self.parts:
            total += part.above_horizon(geometry)
        return total

    @property
    def layers(self) -> tuple[Brdf, ...]:
        """The layers of every part."""
        return tuple(layer for part in self.parts for layer in part.layers)


@dataclass(frozen=True)
class Beneath(Brdf):
    """A base seen through a coat, without the coat's own reflection.

    The coat takes its directional albedo E from the light on the way in and again on the way out:
    base (1 - E(n.l)) (1 - E(n.v)). This is reciprocal, and with the coat it never gains energy.
    """

    coat: Brdf
    base: Brdf

    def above_horizon(self, geometry: Geometry) -> Array:
        """See `Brdf`."""
        through = self._transmittance(geometry.n_dot_l) * self._transmittance(geometry.n_dot_v)
        return through * self.base.above_horizon(geometry)

    @cached_property
    def _table(self) -> Array:
        """Share of light that the coat transmits at `COAT_ELEVATIONS`, shape (33, 3)."""
        # No view lies on the horizon; just above it every coat reflects most
        transmittance: Array = 1.0 - directional_albedo(self.coat, np.maximum(COAT_ELEVATIONS, 1e-4))
        return np.maximum(transmittance, 0.0)

    def _transmittance(self, cosine: Array) -> Array:
        channels = [np.interp(cosine, COAT_ELEVATIONS, channel) for channel in self._table.T]
        return np.stack(channels, axis=-1)


@dataclass(frozen=True, kw_only=True)
class Layered(Brdf):
    """A coat over a base, as varnish on wood or lacquer on a car.

    Light that goes back and forth between base and coat is left out, so that a white diffuse base under a
    dielectric coat loses about a tenth. The coat does not refract.
    """

    model: ClassVar[str] = "layered"
    coat: Brdf
    base: Brdf

    def above_horizon(self, geometry: Geometry) -> Array:
        """See `Brdf`."""
        return self.coat.above_horizon(geometry) + self._beneath.above_horizon(geometry)

    @cached_property
    def _beneath(self) -> Beneath:
        return Beneath(self.coat, self.base)

    @property
    def layers(self) -> tuple[Brdf, ...]:
        """The coat's layers, then the base's, seen through the coat."""
        return (*self.coat.layers, *(Beneath(self.coat, layer) for layer in self.base.layers))


def is_diffuse(layer: Brdf) -> bool:
    """Whether a layer, beneath all its coats, is a Lambert surface."""
    return isinstance(uncoated(layer), Lambert)


def uncoated(layer: Brdf) -> Brdf:
    """A layer's own model, beneath its coats."""
    while isinstance(layer, Beneath):
        layer = layer.base
    return layer
