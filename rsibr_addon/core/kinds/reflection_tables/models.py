"""Models of tables and of their weights: small, with checked parameters."""

from dataclasses import dataclass
from typing import Annotated, ClassVar

import numpy as np

from ...brdf.fresnel import Fresnel
from ...brdf.model import Brdf
from ...brdf.parameters import Checked, Color, Range
from ...conventions import Array
from ...curves import curve_points, on_curve
from ...errors import RangeError


class _Diffuse:
    """A table that scales light with kd."""

    kd: Color

    @property
    def gain(self) -> Array:
        """Radiance in even light of radiance 1, shape (3,)."""
        return np.array(self.kd)


class _Glossy:
    """A table that scales light with ks."""

    ks: Color

    @property
    def gain(self) -> Array:
        """As `_Diffuse.gain`."""
        return np.array(self.ks)


@dataclass(frozen=True, kw_only=True)
class LambertTable(_Diffuse, Checked):
    """Light from the hemisphere about the normal by its cosine: kd irradiance / pi, so kd in even light.

    Notes
    -----
    [Miller1984] section 6.1, first example, whose sum over 4 pi makes it a quarter as bright.
    """

    model: ClassVar[str] = "lambert"
    kd: Annotated[Color, Range(0.0, 1.0)]


@dataclass(frozen=True, kw_only=True)
class LuminousTable(_Diffuse, Checked):
    """The same for every normal: kd times the mean radiance of the environment.

    Notes
    -----
    [Miller1984] section 6.1, second example, to the scale: its sum over 4 pi is a mean.
    """

    model: ClassVar[str] = "luminous"
    kd: Annotated[Color, Range(0.0, 1.0)]


@dataclass(frozen=True, kw_only=True)
class MirrorTable(_Glossy, Checked):
    """The environment itself, times ks.

    Notes
    -----
    [Miller1984] section 6.2, first example.
    """

    model: ClassVar[str] = "mirror"
    ks: Annotated[Color, Range(0.0, 1.0)] = 1.0


@dataclass(frozen=True, kw_only=True)
class PhongTable(_Glossy, Checked):
    """Light about the table's direction by the n-th power of the cosine, scaled to give ks in even light.

    Notes
    -----
    [Miller1984] section 6.2, second example, which makes it 2 (n + 1) times darker.
    """

    model: ClassVar[str] = "phong"
    n: Annotated[float, Range(1.0, 1e6)]
    ks: Annotated[Color, Range(0.0, 1.0)]


@dataclass(frozen=True, kw_only=True)
class ClearTable(Checked):
    """The environment itself, seen through a smooth surface of a material with index eta.

    Notes
    -----
    [Miller1984] section 9, last example.
    """

    model: ClassVar[str] = "clear"
    eta: Annotated[float, Range(0.1, 10.0)]
    tint: Annotated[Color, Range(0.0, 1.0)] = 1.0


@dataclass(frozen=True, kw_only=True)
class ConstantReflectance(Checked):
    """The same share of light at every angle."""

    model: ClassVar[str] = "constant"
    k: Annotated[Color, Range(0.0, 1.0)]


@dataclass(frozen=True, kw_only=True)
class Curves:
    """Wd and Ws of [Miller1984] section 7 as curves over the cosine, straight between points.

    Attributes
    ----------
    wd, ws : str
        See `curve_points`; a curve goes on as it ends.
    """

    model: ClassVar[str] = "curve"
    CURVES: ClassVar[tuple[str, ...]] = ("wd", "ws")
    wd: str = "0:1"
    ws: str = "0:1"

    def __post_init__(self) -> None:
        for name in self.CURVES:
            try:
                curve_points(getattr(self, name))
            except RangeError as error:
                raise RangeError(f"{name}: {error}") from error

    def diffuse(self, cosine: Array) -> Array:
        """Wd, shape (N, 1), at cosines n.v in [0, 1], shape (N,)."""
        return on_curve(self.wd, cosine)[:, None]

    def specular(self, cosine: Array) -> Array:
        """Ws, shape (N, 1), at cosines n.v in [0, 1], shape (N,)."""
        return on_curve(self.ws, cosine)[:, None]


@dataclass(frozen=True, kw_only=True)
class FresnelReflectance:
    """The share of light that a smooth boundary reflects."""

    model: ClassVar[str] = "fresnel"
    fresnel: Fresnel


@dataclass(frozen=True, kw_only=True)
class AlbedoReflectance:
    """The share of light that each kind of lobe of a BRDF reflects."""

    model: ClassVar[str] = "albedo"
    brdf: Brdf


DiffuseModel = LambertTable | LuminousTable
LobeModel = MirrorTable | PhongTable
CoatModel = ConstantReflectance | FresnelReflectance
WeightModel = ConstantReflectance | FresnelReflectance | Curves | AlbedoReflectance
