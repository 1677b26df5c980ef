"""What the toy kind is compared with: the colours that it was made of, or a brighter one's."""

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from rsibr.rsibr_addon.core.environment import Environment
from rsibr.rsibr_addon.core.metrics import relative_rmse, unpremultiplied
from rsibr.rsibr_addon.core.progress import Progress, Steps
from rsibr.rsibr_addon.device.preview import PreviewRenderer
from rsibr.rsibr_addon.host.meshes import load_mesh
from rsibr.rsibr_addon.tasks.compare.comparison import cameras_of, way_error
from rsibr.rsibr_addon.tasks.compare.truth import Drawn, Telling, Truth
from rsibr.tests.toys.disk_core import Disk, DiskLook
from rsibr.tests.toys.disk_device import GpuDisk
from rsibr.tests.toys.disk_settings import DiskComparison


@dataclass(frozen=True)
class DiskWay:
    """The only way to draw it."""

    slug: str = "disk"
    name: str = "as it is"


def draw(
    map_set: Path, disk: Disk, environment: Environment, material: dict[str, Any], settings: DiskComparison
) -> Steps[Drawn]:
    yield Progress(1, 2, "drawing")
    mesh, renderer = load_mesh(settings.mesh), PreviewRenderer(GpuDisk(disk))
    surface = mesh.positions, mesh.normals, mesh.triangles
    drawn, true = (
        [renderer.draw(*surface, camera, settings.size, DiskLook(gain)) for camera in cameras_of(settings)]
        for gain in (1.0, settings.brighter)
    )
    stacked = np.stack(true)
    way = DiskWay()
    error = way_error(
        way, relative_rmse, unpremultiplied(np.stack(drawn)), unpremultiplied(stacked), stacked[..., 3]
    )
    return Drawn("paper", 2, settings, true, {way: drawn}, (error,))


TRUTH = Truth(
    way=DiskWay,
    draw=draw,
    telling=lambda settings: Telling(
        name="a brighter disk",
        made="drawn brighter",
        quality=f"{settings.brighter} times",
        notes=lambda comparison: "",
    ),
)
