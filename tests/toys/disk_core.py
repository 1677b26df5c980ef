"""A toy kind of map sets, a colour at the middle of an object and one at its rim: as in `core/kinds`."""

from dataclasses import dataclass

import numpy as np
from rsibr.rsibr_addon.core.conventions import Array
from rsibr.rsibr_addon.core.geometry.directions import dot
from rsibr.rsibr_addon.core.options import Options, option


@dataclass(frozen=True)
class Disk:
    """Radiance where the surface faces the eye, and where it is seen from aside; each of shape (3,)."""

    middle: Array
    rim: Array


@dataclass(frozen=True)
class DiskLook(Options):
    """How it is shaded."""

    gain: float = option(1.0, label="Gain", help="Factor of the radiance", least=0.0)


def disk_radiance(disk: Disk, normal: Array, view_dir: Array, look: DiskLook) -> Array:
    """Linear in the cosine between normal and view, shape (..., 3). GLSL twin: disk_frag.glsl."""
    cosine = np.clip(dot(normal, view_dir), 0.0, 1.0)[..., None]
    shaded: Array = look.gain * (cosine * disk.middle + (1.0 - cosine) * disk.rim)
    return shaded
