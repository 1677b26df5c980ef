"""Ideal diffuse reflection, alone and under other models."""

from abc import abstractmethod
from dataclasses import dataclass, replace
from typing import Annotated, Any, ClassVar

import numpy as np

from ..conventions import Array
from .model import Brdf, Geometry
from .parameters import Color, Range


@dataclass(frozen=True, kw_only=True)
class Lambert(Brdf):
    """The same radiance in every direction: kd / pi, whose albedo is kd."""

    model: ClassVar[str] = "lambert"
    kd: Annotated[Color, Range(0.0, 1.0)]

    def above_horizon(self, geometry: Geometry) -> Array:
        """See `Brdf`."""
        return np.broadcast_to(np.divide(self.kd, np.pi), geometry.light_dir.shape)


class GlossyOverLambert(Brdf):
    """Base of models that add a diffuse part of their own: dataclasses with a field `kd`."""

    kd: Any

    def above_horizon(self, geometry: Geometry) -> Array:
        """See `Brdf`."""
        brdf: Array = self.glossy(geometry) + np.asarray(self.kd) / np.pi
        return brdf

    @abstractmethod
    def glossy(self, geometry: Geometry) -> Array:
        """The model without its diffuse part [1/sr], shape (N, 3) or (N, 1)."""

    @property
    def layers(self) -> tuple[Brdf, ...]:
        """The glossy part and, where there is one, the diffuse part."""
        if not np.any(self.kd):
            return (self,)
        return (replace(self, kd=0.0), Lambert(kd=self.kd))  # type: ignore[type-var]  # its subclasses are dataclasses
