"""The shadows that floors catch, each made once until what casts it, the floor or the light changes."""

from collections import ChainMap
from collections.abc import MutableMapping, Sequence
from typing import Any

import numpy as np

from ...core.conventions import Array
from ...core.environment import Environment
from ...core.light.median_cut import Lamps, lamps_above
from ...core.pictures.matte import floor_area, floor_from_world
from ...device.drawing import GpuMesh
from ...device.floor_shadow import FloorArea, floor_shadow
from ...device.matte_layer import CaughtShadow
from ...host.visible_surfaces import View
from ..matte import LAMPS
from .contents import Catcher, Contents, Drawable

SIZE = 1024
"""Width of a floor's map in texels."""

KEPT = 4
"""Viewports whose shadows are kept, all that each shows: those that were drawn last."""

KEPT_LAMPS = 64
"""Floors' lamps that are kept, some 12 kB each."""

Cast = tuple[GpuMesh, Array]
"""A mesh, and its place in the world."""

Shadows = dict[tuple[Any, ...], CaughtShadow | None]
"""All that shadows depend on -> the shadow; None where nothing is above the floor."""


class Floors:
    """Shadows on floors.

    Attributes
    ----------
    messages : list of str
        What of the catchers that were shown last catches nothing, and why.
    """

    def __init__(self) -> None:
        self.messages: list[str] = []
        self._shadows: dict[int, Shadows] = {}  # by the number of the viewport
        self._lamps: dict[tuple[str, bytes], Lamps] = {}

    def caught(
        self, contents: Contents, view: View, light: Environment | None, eye: Array
    ) -> list[tuple[Catcher, CaughtShadow | None]]:
        """What the catchers of a view layer show.

        Parameters
        ----------
        contents : Contents
        view : View
        light : Environment or None
            The world's; without, nothing is caught.
        eye : ndarray, shape (4,)
            Homogeneous position of the eye in the world.

        Returns
        -------
        list of (Catcher, CaughtShadow or None)
        """
        self.messages = [
            f"{each.drawable.surface.item.name} catches no shadows, as it is not flat: make it a plane."
            for each in contents.catchers
            if each.plane is None
        ]
        if not contents.catchers:
            return []
        shown: Shadows = {}
        known = ChainMap(shown, self._shadows.pop(view.number, {}), *self._shadows.values())
        casters, turn = contents.casters(view), contents.light.turn
        caught = [(each, self._of(known, each, casters, light, turn, eye)) for each in contents.catchers]
        self._shadows[view.number] = shown  # the newest last
        if len(self._shadows) > KEPT:
            del self._shadows[next(iter(self._shadows))]
        return caught

    def _of(
        self,
        known: MutableMapping[tuple[Any, ...], CaughtShadow | None],
        catcher: Catcher,
        casters: Sequence[Drawable],
        light: Environment | None,
        turn: Array,
        eye: Array,
    ) -> CaughtShadow | None:
        if catcher.plane is None or light is None:
            return None
        floor = floor_from_world(catcher.drawable.surface.matrix, catcher.plane, eye)
        if floor is None:
            return None
        cast = ((each.mesh.batch, each.surface.matrix.tobytes()) for each in casters)
        key = light.sha256, turn.tobytes(), floor.tobytes(), *cast
        shadow = known[key] = known[key] if key in known else self._made(casters, light, turn, floor)
        return shadow

    def _made(
        self, casters: Sequence[Drawable], light: Environment, turn: Array, floor: Array
    ) -> CaughtShadow | None:
        """None where nothing is above the floor."""
        placed = [(each, floor @ each.surface.matrix) for each in casters]
        bounds = {each: _moved(model, each.corners) for each, model in placed if each.corners is not None}
        above = [(each, model) for each, model in placed if bounds[each][:, 2].max() > 0.0]
        if not above:
            return None
        area = FloorArea(*floor_area(np.concatenate([bounds[each] for each, _ in above])))
        models: list[Cast] = [(each.mesh, model) for each, model in above]
        lamps = self._lamps_above(light, turn @ floor[2, :3])
        turned = Lamps(lamps.directions @ turn @ floor[:3, :3].T, lamps.irradiance)
        shadow = floor_shadow(models, turned, area, SIZE)
        return CaughtShadow(floor, area, shadow, lamps.irradiance.sum(axis=0))

    def _lamps_above(self, light: Environment, up: Array) -> Lamps:
        key = light.sha256, np.round(up, 6).tobytes()
        lamps = self._lamps.pop(key, None) or lamps_above(light.radiance, LAMPS, up)
        self._lamps[key] = lamps  # the newest last
        if len(self._lamps) > KEPT_LAMPS:
            del self._lamps[next(iter(self._lamps))]
        return lamps


def _moved(matrix: Array, points: Array) -> Array:
    moved: Array = points @ matrix[:3, :3].T + matrix[:3, 3]
    return moved
