"""Lobe stacks against their BRDF itself, integrated over the environment."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from ...core.conventions import Array
from ...core.environment import Environment
from ...core.geometry.camera import Camera
from ...core.geometry.lit_sphere import lit_spheres
from ...core.kinds.lobe_stack.shading import StackLook
from ...core.kinds.lobe_stack.stack import LobeStack
from ...core.metrics import relative_rmse, unpremultiplied
from ...core.progress import Steps
from ...device.drawing import GpuMapSet
from ...device.kinds.lobe_stack import GpuLobeStack
from ...device.lit_sphere import GpuLitSphere
from ...device.preview import PreviewRenderer
from ...host.meshes import TriangleMesh, load_mesh
from ...settings.lobe_stack import StackComparison
from ..reflectance.brdfs import check_told_brdf, load_brdf
from .comparison import Comparison, cameras_of, way_error
from .truth import Drawn, Truth

LEAST_RINGS = 32
"""Fewest rings of a reference, where no number is asked for."""


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
    Seen from afar, radiance depends on the normal alone, and so a sphere's is any mesh's: what
    [Kautz2000] section 6 calls filtering with the true BRDF on a per-pixel basis. Both pictures take the
    same samples of the same mesh. Texels of a stack lie so close that linear lookups are good to some 0.3 %;
    cubics between rings twice as far apart are good to a tenth of that.
    """
    spec = settings.brdf or material["brdf"]
    if settings.brdf is None:
        check_told_brdf(spec)
    model = yield from load_brdf(spec)
    mesh, cameras = load_mesh(settings.mesh), cameras_of(settings)
    rings = settings.rings or max(LEAST_RINGS, stack.size // 2)
    view_dirs = [camera.view_dir for camera in cameras]
    spheres = yield from lit_spheres(model, environment.radiance, view_dirs, rings)
    references = [
        _picture(GpuLitSphere(sphere), None, mesh, camera, settings.size)
        for sphere, camera in zip(spheres, cameras, strict=True)
    ]
    ours = GpuLobeStack(stack)
    drawn = [_picture(ours, StackLook(), mesh, camera, settings.size) for camera in cameras]
    way = StackWay(len(stack.maps), len(stack.mu), stack.taps.shape[2])
    pictures, true = np.stack(drawn), np.stack(references)
    compared = unpremultiplied(pictures), unpremultiplied(true), true[..., 3]
    return Drawn(
        material=spec,
        map_size=stack.size,
        settings=replace(settings, rings=rings),
        references=references,
        drawn={way: drawn},
        errors=(way_error(way, relative_rmse, *compared),),
    )


def _picture(
    content: GpuMapSet, look: StackLook | None, mesh: TriangleMesh, camera: Camera, size: int
) -> Array:
    surface = mesh.positions, mesh.normals, mesh.triangles
    return PreviewRenderer(content).draw(*surface, camera, size, look)


def stack_table(comparisons: Sequence[Comparison]) -> str:
    """Errors of several comparisons as a table in Markdown.

    Returns
    -------
    str
        A row for each.
    """
    head = ["BRDF", "environment", "lobes", "size", "all views", "median view", "worst view"]
    rows = [head, ["---"] * 2 + ["---:"] * 5]
    for comparison in comparisons:
        (error,) = comparison.errors
        numbers = [f"{number:.4f}" for number in (error.pooled, error.median, error.worst)]
        maps = [str(error.way.lobes), str(comparison.map_size)]
        rows.append([comparison.material, comparison.environment, *maps, *numbers])
    return "".join(f"| {' | '.join(row)} |\n" for row in rows)


TRUTH = Truth(
    way=StackWay,
    draw=draw,
    name="the model itself",
    made="integrated exactly",
    notes=lambda comparison: (
        "The reference is the sum over all texels of the environment of radiance times BRDF times cosine, "
        "without noise; in neither picture does the mesh hide its surroundings from itself."
    ),
    quality=lambda settings: f"{settings.rings} rings of surface points",
    table=stack_table,
)
