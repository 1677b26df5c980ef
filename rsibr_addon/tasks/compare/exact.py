"""Pictures of a reflectance model itself, integrated over an environment."""

from collections.abc import Sequence
from math import ceil
from typing import Any

import numpy as np

from ...core.brdf.model import BrdfFunction
from ...core.conventions import Array
from ...core.environment import Environment
from ...core.geometry.camera import Camera
from ...core.geometry.lit_sphere import lit_spheres
from ...core.metrics import relative_rmse, unpremultiplied
from ...core.progress import Steps
from ...device.drawing import GpuMapSet
from ...device.lit_sphere import GpuLitSphere
from ...device.preview import PreviewRenderer
from ...host.meshes import TriangleMesh
from .comparison import Comparison, Way, WayError, way_error
from .truth import Telling

LEAST_RINGS, MOST_RINGS = 32, 256
"""Fewest and most rings of a reference, where no number is asked for."""

RINGS_BY_WIDTH = 19.0
"""Rings times a lobe's width in radians."""


def rings_of(width: float) -> int:
    """Rings for a lobe of a width in radians."""
    return min(max(LEAST_RINGS, ceil(RINGS_BY_WIDTH / width)), MOST_RINGS)


def exact_pictures(
    model: BrdfFunction,
    environment: Environment,
    cameras: Sequence[Camera],
    mesh: TriangleMesh,
    size: int,
    rings: int,
) -> Steps[list[Array]]:
    """A mesh as each camera sees it: see `Drawn.references`.

    Notes
    -----
    Seen from afar, radiance depends on the normal alone, and so a sphere's is any mesh's: what
    [Kautz2000] section 6 calls filtering with the true BRDF on a per-pixel basis. Pictures of all contents
    take the same samples of the same mesh.
    """
    view_dirs = [camera.view_dir for camera in cameras]
    spheres = yield from lit_spheres(model, environment.radiance, view_dirs, rings)
    return [
        picture(GpuLitSphere(sphere), None, mesh, camera, size)
        for sphere, camera in zip(spheres, cameras, strict=True)
    ]


def picture(content: GpuMapSet, look: Any, mesh: TriangleMesh, camera: Camera, size: int) -> Array:
    """A mesh shaded from a map set, shape (size, size, 4): see `Drawn`."""
    surface = mesh.positions, mesh.normals, mesh.triangles
    return PreviewRenderer(content).draw(*surface, camera, size, look)


def error_of(way: Way, drawn: Sequence[Array], references: Sequence[Array]) -> WayError:
    """Error of a way to draw, where the references have no noise; pictures are those of `Drawn`."""
    pictures, true = np.stack(drawn), np.stack(references)
    return way_error(way, relative_rmse, unpremultiplied(pictures), unpremultiplied(true), true[..., 3])


def _notes(comparison: Comparison) -> str:
    return (
        "The reference is the sum over all texels of the environment of radiance times BRDF times cosine, "
        "without noise; in neither picture does the mesh hide its surroundings from itself."
    )


def telling(settings: Any) -> Telling:
    """What is told of pictures of the model itself, whose rings settings number."""
    return telling_with(f"{settings.rings} rings of surface points")


def telling_with(quality: str) -> Telling:
    """What is told of pictures of the model itself: see `Telling.quality`."""
    return Telling("the model itself", "integrated exactly", quality, _notes)
