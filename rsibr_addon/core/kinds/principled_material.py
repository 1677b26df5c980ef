"""One Principled material that is the same all over, as options of looks."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from ..brdf.principled import Principled, Surface
from ..options import Options, declared_options, option


def _share(default: float, label: str, help: str, **more: Any) -> Any:
    return option(default, label=label, help=help, least=0.0, most=1.0, metavar="F", **more)


def _colour(default: float, label: str, help: str, **more: Any) -> Any:
    limits = {"least": 0.0, "most": 1.0}
    return option(
        (default,) * 3, label=label, help=help, subtype="COLOR", metavar="F|R,G,B", **limits, **more
    )


@dataclass(frozen=True)
class PrincipledMaterial(Options):
    """A Principled material that is the same all over; its defaults are Blender's."""

    base_color: tuple[float, float, float] = _colour(
        0.8, "Base Color", "Color of a metal, or of what is below gloss"
    )
    metallic: float = _share(0.0, "Metallic", "From a dielectric to a metal")
    roughness: float = _share(0.5, "Roughness", "How far highlights spread; 0 is a mirror")
    ior: float = option(
        1.5,
        label="IOR",
        help="Index of refraction of a dielectric",
        least=1.0,
        most=100.0,
        soft_most=2.5,
        advanced=True,
        metavar="N",
    )
    diffuse_roughness: float = _share(
        0.0, "Diffuse Roughness", "Roughness of the diffuse part, as of clay", advanced=True
    )
    specular_level: float = option(
        0.5,
        label="Specular Level",
        help="Gloss of a dielectric; 0.5 is what its index of refraction says",
        least=0.0,
        most=10.0,
        soft_most=1.0,
        advanced=True,
        metavar="F",
    )
    specular_tint: tuple[float, float, float] = _colour(
        1.0, "Specular Tint", "Color of a dielectric's gloss, and of a metal's edges", advanced=True
    )
    coat_weight: float = _share(0.0, "Coat Weight", "How much of the surface a clear coat covers")
    coat_roughness: float = _share(0.03, "Coat Roughness", "Roughness of the coat")
    coat_ior: float = option(
        1.5,
        label="Coat IOR",
        help="Index of refraction of the coat",
        least=1.0,
        most=4.0,
        advanced=True,
        metavar="N",
    )
    coat_tint: tuple[float, float, float] = _colour(
        1.0, "Coat Tint", "Color of what is seen through the coat", advanced=True
    )
    sheen_weight: float = _share(0.0, "Sheen Weight", "How much light fibres reflect, as of cloth or dust")
    sheen_roughness: float = _share(
        0.5, "Sheen Roughness", "How far from the edges sheen reaches", advanced=True
    )
    sheen_tint: tuple[float, float, float] = _colour(1.0, "Sheen Tint", "Color of the sheen", advanced=True)

    @property
    def spec(self) -> str:
        """Text of the model that is shown."""
        return self.text

    @property
    def surface(self) -> Surface:
        """The material as arrays."""
        return Surface(**{name: np.array(getattr(self, name)) for name in _INPUTS})

    @property
    def text(self) -> str:
        """The material as the text of a reflectance model, without what has Blender's defaults."""
        values = {name: getattr(self, name) for name in _INPUTS}
        words = [f"{name}={_text(value)}" for name, value in values.items() if value != _INPUTS[name]]
        return f"{Principled.model}:{','.join(words)}" if words else Principled.model


def _text(value: float | tuple[float, ...]) -> str:
    return "/".join(map(str, value)) if isinstance(value, tuple) else str(value)


_INPUTS = {each.name: each.default for each in declared_options(PrincipledMaterial)}
"""Name of each input -> its default."""
