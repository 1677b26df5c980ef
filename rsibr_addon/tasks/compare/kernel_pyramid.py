"""One Principled material, shaded from a kernel pyramid, against its reflectance model."""

from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from ...core.environment import Environment
from ...core.kinds.kernel_pyramid.look import PrincipledLook
from ...core.kinds.kernel_pyramid.pyramid import Pyramid
from ...core.kinds.principled_material import PrincipledMaterial
from ...core.options import declared_options
from ...core.progress import Steps
from ...device.kinds.kernel_pyramid import GpuPyramid
from ...files.kinds.kernel_pyramid import shipped_families
from ...host.meshes import load_mesh
from ...settings.kernel_pyramid import PyramidComparison
from ..reflectance.brdfs import load_brdf
from . import model_or_cycles
from .comparison import cameras_of
from .exact import exact_pictures, picture, rings_of, telling
from .truth import Drawn, Truth


@dataclass(frozen=True)
class PyramidWay:
    """The way to draw a pyramid: there is one.

    Attributes
    ----------
    material : str
        The material that was drawn, as `PrincipledMaterial.text` says it.
    """

    material: str

    @property
    def slug(self) -> str:
        """A name for files and reports."""
        return "pyramid"

    @property
    def name(self) -> str:
        """A name for people."""
        return "from the pyramid"


def draw(
    map_set: Path,
    pyramid: Pyramid,
    environment: Environment,
    material: dict[str, Any],
    settings: PyramidComparison,
) -> Steps[Drawn]:
    """Integrate a sphere's reflection exactly; draw a mesh from that and from the pyramid: see `Truth.draw`.

    Raises
    ------
    RangeError
        The material is a mirror, or its coat, which have no reflectance to be integrated.
    """
    model = yield from load_brdf(settings.text)
    mesh, cameras = load_mesh(settings.mesh), cameras_of(settings)
    rings = settings.rings or _rings(settings)
    references = yield from exact_pictures(model, environment, cameras, mesh, settings.size, rings)
    inputs = {each.name: getattr(settings, each.name) for each in declared_options(PrincipledMaterial)}
    ours, look = GpuPyramid(pyramid, shipped_families()), PrincipledLook(own=False, **inputs)
    drawn = [picture(ours, look, mesh, camera, settings.size) for camera in cameras]
    way = PyramidWay(settings.text)
    truth = model_or_cycles.ByModel(references)
    return model_or_cycles.beside(
        truth, {way: drawn}, settings.text, pyramid.mirror.shape[1], replace(settings, rings=rings)
    )


def _rings(settings: PyramidComparison) -> int:
    """As many as the narrowest lobe needs."""
    narrowest = settings.roughness
    if settings.coat_weight > 0.0:
        narrowest = min(narrowest, settings.coat_roughness)
    return rings_of(narrowest**2)


def _is_look(way: PyramidWay, look: PrincipledLook) -> bool:
    return not look.own and look.antialiased and way.material == look.text


TRUTH = Truth(
    way=PyramidWay,
    draw=draw,
    telling=telling,
    is_look=_is_look,
)
