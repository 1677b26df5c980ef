"""A painting of light, for docs/figures.sh: painting.py OUT.exr DEGREES, turned about Z by so much."""

import sys
from pathlib import Path

import numpy as np
from rsibr.rsibr_addon.core.conventions import texel_centres
from rsibr.rsibr_addon.core.geometry.directions import turn_about_z
from rsibr.rsibr_addon.core.maps import equirect
from rsibr.rsibr_addon.files.radiance_pictures import write_radiance

HEIGHT = 256
COLOURS = {
    "left": (0.1, 0.25, 0.5),
    "right": (0.9, 0.4, 0.12),
    "dark": (0.02, 0.02, 0.05),
    "window": (1.5, 1.4, 1.1),
}


def main() -> None:
    """Paint flat colours: blue left of who looks along +Y, orange right of that, and a window behind."""
    path, degrees = sys.argv[1:]
    directions = equirect.direction_from_uv(texel_centres(2 * HEIGHT, HEIGHT))
    x, y, z = np.moveaxis(directions @ turn_about_z(np.radians(float(degrees))), -1, 0)
    places = {"left": x < 0.0, "right": x >= 0.0, "dark": z < -0.25}
    # Behind who looks; its bars are dark
    inside = (y < -0.4) & (z > 0.25) & (z < 0.75) & (np.abs(x + 0.3) < 0.35)
    places |= {"window": inside & (np.abs(z - 0.5) > 0.03) & (np.abs(x + 0.3) > 0.03)}
    painting = np.zeros((HEIGHT, 2 * HEIGHT, 3), np.float32)
    for name, place in places.items():
        painting[place] = COLOURS[name]
    write_radiance(Path(path), painting)


if __name__ == "__main__":
    main()
