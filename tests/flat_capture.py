"""A map set whose surfaces have one radiance everywhere."""

from pathlib import Path

import numpy as np
from rsibr.rsibr_addon.files.map_set import write_map_set
from rsibr.tests.mirror_capture import mirror_map_set


def write_flat_capture(path: Path, radiance: tuple[float, float, float]) -> Path:
    """Write it, as radiance views, and return its path."""
    map_set = mirror_map_set(size=8)
    for name, pixels in map_set.maps.items():
        if name != "environment":
            pixels[:] = np.array(radiance) if name.endswith("glossy") else 0.0
    write_map_set(path, map_set, force=True)
    return path
