"""The object over its own light or a camera's picture, on a floor that takes its shadow."""

from pathlib import Path

import numpy as np

from ..core.conventions import Array, Indices
from ..core.environment import Environment
from ..core.errors import MapSetError
from ..core.geometry.camera import Camera
from ..core.geometry.coarser_mesh import coarser_mesh
from ..core.light.blur import blurred
from ..core.light.median_cut import Lamps, lamps_above
from ..core.maps.representation import representation
from ..core.pictures.matte import EXTENT, backdrop_directions, fitted, floor_share, over
from ..core.resample import lookup
from ..device.context import ensure_context
from ..device.drawing import GpuMesh
from ..device.floor_shadow import FloorArea, floor_map, floor_shadow
from ..settings.matte import LIGHT, MatteOptions
from .light.light_pictures import read_light

LAMPS = 256
"""Lamps that the floor's light is made of: a step of a shadow is 0.4 % of it."""

SHADOW_SIZE = 512
"""Width of the floor's map in texels: 64 to the object's radius."""

TEXEL = 2.0 * EXTENT / SHADOW_SIZE
"""Width of a texel of the floor's map in radii of the object."""

BACKDROP_SAMPLES = 2
"""Lookups along each side of a pixel of the background."""

_EQUIRECT = representation("equirect")


class Matte:
    """What is behind an object, made once for all pictures of it.

    Parameters
    ----------
    options : MatteOptions
    environment : Environment or None
        The map set's light.
    positions : ndarray, shape (V, 3)
        The object's vertices in world coordinates.
    triangles : ndarray of int, shape (F, 3)

    Raises
    ------
    MapSetError
        Light is asked for, and the map set does not hold it.
    InputFileError
        The background's picture cannot be read.
    RangeError
        The blur is narrower than the light resolves.
    """

    def __init__(
        self, options: MatteOptions, environment: Environment | None, positions: Array, triangles: Indices
    ) -> None:
        self._options = options
        self._seen = light_behind(options, environment)
        self._floor: _Floor | None = None
        if options.floor:
            self._floor = _Floor(known_light(environment), positions, triangles)

    def under(self, picture: Array, camera: Camera, object_turn: Array, light_turn: Array) -> Array:
        """Put what is behind an object under its picture.

        Parameters
        ----------
        picture : ndarray, shape (size, size, 4)
            Radiance times coverage, and coverage; row 0 at the bottom.
        camera : Camera
            The one that it was drawn with.
        object_turn, light_turn : ndarray, shape (3, 3)
            Rotations of object and light from where they were made.

        Returns
        -------
        ndarray, shape (size, size, 4), float32
            Opaque where there is a background; else with the floor's shadow in its coverage.
        """
        behind = self._background(camera, len(picture), light_turn)
        share: Array | float = 1.0
        if self._floor is not None:
            share = self._floor.share(camera, len(picture), object_turn, light_turn)
        if behind is not None:
            return over(picture, behind * share)
        if self._floor is None:
            return picture
        shaded = picture.copy()
        shaded[..., 3] += (1.0 - picture[..., 3]) * (1.0 - np.mean(share, axis=-1))
        return shaded

    def _background(self, camera: Camera, size: int, light_turn: Array) -> Array | None:
        seen = self._seen
        if seen is not None and self._options.background == LIGHT:
            directions = backdrop_directions(camera, BACKDROP_SAMPLES * size) @ light_turn
            seen = lookup(seen[None], directions, _EQUIRECT)
        return None if seen is None else fitted(2.0**self._options.background_exposure * seen, size)


class _Floor:
    """The floor below an object, and the shadow that it had last."""

    def __init__(self, light: Array, positions: Array, triangles: Indices) -> None:
        ensure_context()
        # Which is drawn for each lamp
        coarse, few = coarser_mesh(positions, triangles, TEXEL)
        self._mesh = GpuMesh(coarse, np.zeros_like(coarse), few)
        self._lamps = lamps_above(light, LAMPS)
        self._height = float(positions[:, 2].min())
        self._shadow: tuple[bytes, Array] | None = None

    def share(self, camera: Camera, size: int, object_turn: Array, light_turn: Array) -> Array:
        """Of its light that each pixel's point of the floor gets, shape (size, size, 3)."""
        turns = object_turn.tobytes() + light_turn.tobytes()
        if self._shadow is None or self._shadow[0] != turns:
            lamps = Lamps(self._lamps.directions @ light_turn.T, self._lamps.irradiance)
            model: Array = np.eye(4)
            model[:3, :3], model[2, 3] = object_turn, -self._height
            area = FloorArea(np.zeros(2), EXTENT)
            made = floor_map(floor_shadow([(self._mesh, model)], lamps, area, SHADOW_SIZE))
            self._shadow = turns, made
        irradiance = self._lamps.irradiance.sum(axis=0)
        return floor_share(camera, self._height, self._shadow[1], irradiance, size)


def light_behind(options: MatteOptions, environment: Environment | None) -> Array | None:
    """What the background shows, without its exposure; parameters and errors are those of `Matte`.

    Returns
    -------
    ndarray, shape (height, width, 3), or None
        A latitude-longitude map where the background is light; else a picture, row 0 at the bottom.
    """
    if options.background is None:
        return None
    if options.background == LIGHT:
        return blurred(known_light(environment), options.background_blur)
    return read_light(Path(options.background))


def known_light(environment: Environment | None) -> Array:
    """The radiance of a map set's light, shape (height, 2 * height, 3).

    Raises
    ------
    MapSetError
        The map set does not hold it.
    """
    if environment is None:
        raise MapSetError(
            "The map set does not hold its light: choose a picture as the background, and no floor."
        )
    return environment.radiance
