"""Small pictures of map sets, for a batch's page."""

from functools import cache
from pathlib import Path

import numpy as np

from ...core.conventions import Array, Indices
from ...core.errors import DeviceError
from ...core.geometry.camera import Camera
from ...core.light.transfer_curve import srgb_from_linear
from ...core.pictures.thumbnail import thumbnail
from ...files.kinds.registry import look_types
from ...files.png import png_of
from ..report.pictures import BRIGHTEST, map_set_pictures

SIZE = 64
"""Width of a sphere's picture in pixels: so it takes .03 s, a twentieth of the smallest bakes."""

PARALLELS = 24
"""Of the sphere that is drawn: its outline is less than .1 pixels off, and its normals are exact."""

MAP_SIZE = 96
"""Largest width and height of a map's picture in pixels."""

CAMERA = Camera((0.0, -1.0, 0.0))


def map_set_png(path: Path) -> bytes:
    """A sphere that is shaded from a map set; its first map, where there is no Blender or graphics driver.

    Returns
    -------
    bytes
        A PNG of at most `MAP_SIZE` pixels.

    Raises
    ------
    MapSetError
        See `files.map_set.read_map_set`.
    """
    try:
        rgba = _sphere(path)
    except (DeviceError, ModuleNotFoundError):
        rgba = _first_map(path)
    return png_of(np.rint(255.0 * rgba).astype(np.uint8))


def _sphere(path: Path) -> Array:
    """A picture in sRGB, [0, 1], not premultiplied, with coverage in alpha; row 0 at the top."""
    from ...device.preview import PreviewRenderer
    from ..methods.kinds import open_map_set

    opened, (vertices, triangles) = open_map_set(path), _mesh()
    look = look_types()[opened.kind]()
    renderer = PreviewRenderer(opened.drawable())
    drawn = renderer.draw(vertices, vertices, triangles, CAMERA, SIZE, look)[::-1]
    coverage = drawn[..., 3:]
    radiance = np.divide(drawn[..., :3], coverage, out=np.zeros_like(drawn[..., :3]), where=coverage > 0.0)
    white = max(1.0, float(np.quantile(radiance.max(axis=-1)[coverage[..., 0] > 0.0], 1.0 - BRIGHTEST)))
    shown = srgb_from_linear(np.clip(radiance / white, 0.0, 1.0))
    return np.concatenate([shown, np.clip(coverage, 0.0, 1.0)], axis=-1)


def _first_map(path: Path) -> Array:
    small = thumbnail(map_set_pictures(path)[0].pixels[:, :, :3], MAP_SIZE)[::-1]
    return np.concatenate([small, np.ones((*small.shape[:2], 1))], axis=-1)


@cache
def _mesh() -> tuple[Array, Indices]:
    """A sphere's vertices, which are its normals too, and its triangles."""
    around = 2 * PARALLELS
    polar, azimuth = np.linspace(0.0, np.pi, PARALLELS + 1), np.linspace(0.0, 2.0 * np.pi, around + 1)
    sines = np.sin(polar)[:, None]
    level = np.broadcast_to(np.cos(polar)[:, None], (PARALLELS + 1, around + 1))
    vertices = np.stack([sines * np.cos(azimuth), sines * np.sin(azimuth), level], axis=-1).reshape(-1, 3)
    row, column = np.divmod(np.arange(PARALLELS * around), around)
    corner = row * (around + 1) + column
    below = corner + around + 1
    halves = ([corner, below, corner + 1], [corner + 1, below, below + 1])
    return vertices, np.concatenate([np.stack(half, axis=-1) for half in halves])
