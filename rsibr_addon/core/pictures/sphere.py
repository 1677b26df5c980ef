"""A sphere seen from afar, as a picture's pixels see it."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..conventions import Array
from ..geometry.directions import camera_frame, normalize

_RIM = 0.999
"""Radius up to which normals are taken: beyond it the view only grazes the sphere."""


@dataclass(frozen=True, eq=False)
class SpherePixels:
    """The pixels of a square picture that a sphere touches.

    Attributes
    ----------
    inside : ndarray of bool, shape (size, size)
        Which pixels these are; row 0 at the bottom.
    coverage : ndarray, shape (N,)
        How much of each is covered, in (0, 1].
    normal : ndarray, shape (N, 3)
        Unit vectors in world coordinates.
    corner_normals : ndarray, shape (N, 4, 3)
        Those at the corners of each, counterclockwise from the left one at the bottom.
    """

    inside: NDArray[np.bool_]
    coverage: Array
    normal: Array
    corner_normals: Array

    def picture(self, colour: Array) -> Array:
        """Colours of these pixels as a picture.

        Parameters
        ----------
        colour : ndarray, shape (N, 3)

        Returns
        -------
        ndarray, shape (size, size, 4), float64
            Not premultiplied; coverage in alpha.
        """
        found = np.zeros((*self.inside.shape, 4))
        found[self.inside] = np.concatenate([colour, self.coverage[:, None]], axis=1)
        return found


def sphere_pixels(size: int, view_dir: tuple[float, float, float]) -> SpherePixels:
    """A sphere that fills a picture.

    Parameters
    ----------
    size : int
        Width and height of the picture.
    view_dir : tuple of 3 floats
        From the sphere to the eye, of any positive length.
    """
    place = 2.0 * (np.arange(size) + 0.5) / size - 1.0
    middles = np.stack(np.meshgrid(place, place), axis=-1)
    coverage = np.clip(0.5 * size * (1.0 - np.hypot(*np.moveaxis(middles, -1, 0))) + 0.5, 0.0, 1.0)
    inside, frame = coverage > 0.0, camera_frame(normalize(view_dir))
    corners = middles[inside][:, None] + np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)]) / size
    normals, corner_normals = (_seen_normals(each) @ frame.T for each in (middles[inside], corners))
    return SpherePixels(inside, coverage[inside], normals, corner_normals)


def _seen_normals(places: Array) -> Array:
    """Normals in camera axes at places of the picture, shape (..., 3); at the rim for those beyond it."""
    x, y = np.moveaxis(places, -1, 0)
    within = _RIM / np.maximum(np.hypot(x, y), _RIM)
    across, up = within * x, within * y
    return np.stack([across, up, np.sqrt(1.0 - across**2 - up**2)], axis=-1)
