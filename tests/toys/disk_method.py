"""How the toy kind is baked, and its rows. As a module of `tasks/methods`."""

from typing import Any

import numpy as np
from rsibr.rsibr_addon.core.progress import Steps
from rsibr.rsibr_addon.files.map_set_header import Recipe
from rsibr.rsibr_addon.job import BakeJob
from rsibr.rsibr_addon.tasks.methods.kind import Kind
from rsibr.rsibr_addon.tasks.methods.method import Baked, Cost, Method, read_light, written
from rsibr.tests.toys.disk_core import Disk
from rsibr.tests.toys.disk_device import GpuDisk
from rsibr.tests.toys.disk_files import to_map_set
from rsibr.tests.toys.disk_settings import DiskSettings
from rsibr.tests.toys.disk_truth import TRUTH


def bake(job: BakeJob[Any], recipe: Recipe) -> Steps[Baked]:
    """The middle has the light's mean colour, the rim a share of it."""
    light, settings = (yield from read_light(job)), job.settings
    mean = light.radiance.mean(axis=(0, 1), dtype=np.float64)
    path = yield from written(
        job, recipe, to_map_set(Disk(mean, settings.shine * mean), light, settings.shine)
    )
    return Baked(path, "two colours")


def cost(settings: DiskSettings) -> Cost:
    """Nothing, as good as."""
    return Cost(1.0, 1.0, 1.0)


METHOD = Method(bake, cost)
KIND = Kind(GpuDisk, TRUTH)
