"""Mip chains against the reflectance that they approximate, integrated, or against Cycles."""

from dataclasses import dataclass, replace
from math import sqrt
from pathlib import Path
from typing import Any

from ...core.environment import Environment
from ...core.kinds.mip_chain.chain import MipChain
from ...core.kinds.mip_chain.model import glossy_model
from ...core.kinds.mip_chain.shading import MipLook
from ...core.progress import Steps
from ...device.kinds.mip_chain import GpuMipChain
from ...host.meshes import load_mesh
from ...settings.mip_chain import MipComparison
from . import model_or_cycles
from .comparison import cameras_of
from .exact import exact_pictures, picture, rings_of
from .truth import Drawn, Truth


@dataclass(frozen=True)
class MipWay:
    """The way to draw a mip chain: there is one.

    Attributes
    ----------
    lobe : str
        The lobe that was drawn, in words.
    """

    lobe: str

    @property
    def slug(self) -> str:
        """A name for files and reports."""
        return "mips"

    @property
    def name(self) -> str:
        """A name for people."""
        return f"from the mips, {self.lobe}"


def draw(
    map_set: Path,
    chain: MipChain,
    environment: Environment,
    material: dict[str, Any],
    settings: MipComparison,
) -> Steps[Drawn]:
    """Draw a mesh from a mip chain, and from the reflectance that it approximates: see `Truth.draw`.

    Raises
    ------
    RangeError
        The roughness is that of a mirror, or the chain does not say how blurred its mips are.
    """
    look = _look(settings)
    look.level(chain.lobes)
    mesh, cameras = load_mesh(settings.mesh), cameras_of(settings)
    if settings.material is None:
        rings = settings.rings or _rings(settings)
        settings = replace(settings, rings=rings)
        model = glossy_model(look.f0, look.kd, look.roughness, look.exponent)
        pictures = yield from exact_pictures(model, environment, cameras, mesh, settings.size, rings)
        truth: model_or_cycles.Pictures = model_or_cycles.ByModel(pictures)
    else:
        truth = yield from model_or_cycles.by_cycles(environment, mesh, cameras, settings)
    ours = GpuMipChain(replace(chain, probes=()))  # in its own light, as the truth is
    drawn = {MipWay(_lobe(look)): [picture(ours, look, mesh, camera, settings.size) for camera in cameras]}
    return model_or_cycles.beside(truth, drawn, _lobe(look), chain.size, settings)


def _look(settings: MipComparison) -> MipLook:
    return MipLook(f0=settings.f0, kd=settings.kd, roughness=settings.roughness, exponent=settings.exponent)


def _rings(settings: MipComparison) -> int:
    """As many as the lobe needs."""
    if settings.exponent is not None:
        return rings_of(sqrt(2.0 / (settings.exponent + 2.0)))
    return rings_of(max((settings.roughness or 0.0) ** 2, 1e-3))


def _lobe(look: MipLook) -> str:
    by_exponent = look.exponent is not None
    lobe = f"exponent {look.exponent:g}" if by_exponent else f"roughness {look.roughness:g}"
    reflectance, diffuse = ("/".join(f"{each:g}" for each in colour) for colour in (look.f0, look.kd))
    return f"{lobe}, reflectance {reflectance}, diffuse {diffuse}"


def _is_look(way: MipWay, look: MipLook) -> bool:
    chosen = look.roughness is not None or look.exponent is not None
    return chosen and look.antialiased and way.lobe == _lobe(look)


TRUTH = Truth(
    way=MipWay,
    draw=draw,
    telling=model_or_cycles.telling,
    is_look=_is_look,
)
