"""Small pictures of map sets and of baked inputs, for a batch's page."""

from functools import cache
from pathlib import Path

import numpy as np

from ...core.geometry.directions import reflect
from ...core.light.transfer_curve import srgb_from_linear
from ...core.pictures.sphere import SpherePixels, sphere_pixels
from ...files.baked_inputs import read_baked_inputs
from ...files.kinds.registry import STORED
from ...files.map_set import read_map_set
from ...files.png import png_of
from ...settings.baked_inputs import ObjectInputsSettings
from ..report.pictures import BRIGHTEST

SIZE = 64
"""Width of a sphere's picture in pixels."""

VIEW_DIR = (0.0, -1.0, 0.0)
"""From the sphere to the eye."""


def png_of_output(path: Path, kind: str) -> bytes:
    """What a job of a kind has made, as a PNG; raises what reading it does."""
    return inputs_png(path) if kind == ObjectInputsSettings.KIND else map_set_png(path)


def inputs_png(path: Path) -> bytes:
    """The first picture of a file of baked inputs.

    Raises
    ------
    InputFileError
        See `files.baked_inputs.read_baked_inputs`.
    """
    texels = next(iter(read_baked_inputs(path).pictures.values()))[::-1]
    step = max(1, len(texels) // SIZE)
    shown = srgb_from_linear(np.clip(texels[::step, ::step], 0.0, 1.0))
    opaque = np.pad(shown, ((0, 0), (0, 0), (0, 1)), constant_values=1.0)
    return png_of(np.rint(255.0 * opaque).astype(np.uint8))


def map_set_png(path: Path) -> bytes:
    """A sphere that is shaded from a map set, without Blender and a driver, which take longer to start.

    Parameters
    ----------
    path : Path
        A map set.

    Returns
    -------
    bytes
        A PNG of `SIZE` pixels, with coverage in alpha.

    Raises
    ------
    MapSetError
        See `files.map_set.read_map_set`.
    """
    map_set, pixels = read_map_set(path), _pixels()
    mirror_footprint = reflect(VIEW_DIR, pixels.corner_normals)
    shading = STORED[map_set.kind].shading(path, map_set)
    radiance = shading(
        pixels.normal, np.broadcast_to(VIEW_DIR, pixels.normal.shape), mirror_footprint=mirror_footprint
    )
    white = max(1.0, float(np.quantile(radiance.max(axis=-1), 1.0 - BRIGHTEST)))
    shown = pixels.picture(srgb_from_linear(np.clip(radiance / white, 0.0, 1.0)))[::-1]
    return png_of(np.rint(255.0 * shown).astype(np.uint8))


@cache
def _pixels() -> SpherePixels:
    return sphere_pixels(SIZE, VIEW_DIR)
