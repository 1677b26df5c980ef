"""Lobe stacks against their BRDF itself, integrated over the environment."""

from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from ...core.environment import Environment
from ...core.kinds.lobe_stack.shading import StackLook
from ...core.kinds.lobe_stack.stack import LobeStack
from ...core.progress import Steps
from ...device.kinds.lobe_stack import GpuLobeStack
from ...host.meshes import load_mesh
from ...settings.lobe_stack import StackComparison
from ..reflectance.brdfs import check_told_brdf, load_brdf
from . import model_or_cycles
from .comparison import cameras_of
from .exact import LEAST_RINGS, exact_pictures, picture, telling
from .truth import Drawn, Truth


@dataclass(frozen=True)
class StackWay:
    """The way to draw a lobe stack: there is one.

    Attributes
    ----------
    lobes, elevations, taps : int
        How many there are.
    """

    lobes: int
    elevations: int
    taps: int

    @property
    def slug(self) -> str:
        """A name for files and reports: 3-lobes."""
        return f"{self.lobes}-lobes"

    @property
    def name(self) -> str:
        """A name for people."""
        return f"lobes: {self.lobes}, elevations: {self.elevations}, taps: {self.taps}"


def draw(
    map_set: Path,
    stack: LobeStack,
    environment: Environment,
    material: dict[str, Any],
    settings: StackComparison,
) -> Steps[Drawn]:
    """Integrate a sphere's reflection exactly; draw a mesh from that and from the stack: see `Truth.draw`.

    Notes
    -----
    Texels of a stack lie so close that linear lookups are good to some 0.3 %; cubics between rings twice as
    far apart are good to a tenth of that.
    """
    spec = settings.brdf or material["brdf"]
    if settings.brdf is None:
        check_told_brdf(spec)
    model = yield from load_brdf(spec)
    mesh, cameras = load_mesh(settings.mesh), cameras_of(settings)
    rings = settings.rings or max(LEAST_RINGS, stack.size // 2)
    references = yield from exact_pictures(model, environment, cameras, mesh, settings.size, rings)
    ours = GpuLobeStack(stack)
    drawn = [picture(ours, StackLook(), mesh, camera, settings.size) for camera in cameras]
    way = StackWay(len(stack.maps), len(stack.mu), stack.taps.shape[2])
    truth = model_or_cycles.ByModel(references)
    return model_or_cycles.beside(truth, {way: drawn}, spec, stack.size, replace(settings, rings=rings))


TRUTH = Truth(
    way=StackWay,
    draw=draw,
    telling=telling,
)
