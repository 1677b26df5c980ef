"""A picture of one frame: the previews that a camera sees, drawn sample by sample."""

from collections.abc import Collection
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np

from ...core.conventions import Array
from ...core.geometry.pixel_samples import pixel_samples
from ...device.drawing import Emissive, GpuMapSet
from ...device.film import Film
from ...device.normals import Normals
from ...device.own_materials import OwnMaterials
from ...device.preview_stage import Sight, Stage, draw_occluder
from ...device.textured_mesh import GpuTexturedMesh
from ...host.render_views import CameraView
from ...host.working_space import working_from_rec709
from ...host.world_light import AS_IT_IS
from ..viewport.frame import Frame, Shown

COMBINED, DEPTH, NORMAL, EMISSION = "Combined", "Depth", "Normal", "Emission"

CHANNELS = {COMBINED: "RGBA", DEPTH: "Z", NORMAL: "XYZ", EMISSION: "RGB"}
"""Name of a pass -> its channels, as Blender has them."""


class Picture:
    """The passes of a picture, as far as they are drawn; in the graphics context that it is made in.

    Parameters
    ----------
    frame : Frame
        What the view shows.
    view : CameraView
    passes : collection of str
        Of `CHANNELS`.
    darkness : GpuMapSet
        No light, in which own materials show what they emit.
    """

    def __init__(self, frame: Frame, view: CameraView, passes: Collection[str], darkness: GpuMapSet) -> None:
        self._frame, self._view, self._darkness = frame, view, darkness
        self._stage = Stage()
        self._films = {name: Film(*view.size) for name in _DRAWN if name in passes}
        self._normals = Normals()
        self._wants_depth = DEPTH in passes
        self._depths: Array = np.ones(view.size[::-1], np.float32)
        self._places = pixel_samples()
        self._is_first = True

    @property
    def items(self) -> list[Any]:
        """The objects that it shows, each once."""
        surfaces = [each.drawable.surface for each in self._frame.shown]
        return [*{surface.number: surface.item for surface in surfaces}.values()]

    def add_sample(self) -> None:
        """Draw the picture once more, a part of a pixel aside; the first time at the pixels' centres."""
        sight = Sight.by(*self._view.moved(next(self._places)).matrices)
        frame = self._frame.seen_by(sight)
        for name, film in self._films.items():
            with film.sample():
                if name == COMBINED:
                    frame.draw_behind(self._stage, self._view, sight)
                for strength in frame.strengths or (1.0,):  # what hides has depths by itself, too
                    frame.set(self._stage, strength, True, partial(_DRAWN[name], self))
                    film.lay(self._stage.radiance, 1.0 if name == NORMAL else strength)
                if self._is_first and self._wants_depth:
                    self._depths = self._first_depths(frame)
                self._is_first = False

    def read(self) -> dict[str, Array]:
        """The passes so far.

        Returns
        -------
        dict of str to ndarray, shape (height, width, channels), float32
            Pass -> pixels, row 0 at the bottom. Combined is premultiplied; colours are in the working space.
        """
        read = {name: film.read() for name, film in self._films.items()}
        for name in read.keys() - {NORMAL}:
            read[name][..., :3] = working_from_rec709(read[name][..., :3])
        found = {name: pixels[..., : len(CHANNELS[name])] for name, pixels in read.items()}
        if self._wants_depth:
            found[DEPTH] = self._view.distances(self._depths)[..., None]
        return found

    def _first_depths(self, frame: Frame) -> Array:
        """Depths of what was drawn last, where all is that hides; 1 where a hole is in front."""
        depths = self._stage.depths()
        if frame.holes:
            with self._stage.drawing():
                for mesh, placed in frame.holes:
                    draw_occluder(mesh, placed)
            depths[depths == self._stage.depths()] = 1.0
        return depths

    def _draw_combined(self, shown: Shown) -> None:
        shown.draw(other=False)

    def _draw_normal(self, shown: Shown) -> None:
        mesh, look = shown.drawable.mesh, shown.looks[False]
        placed = replace(shown.placed, turn=AS_IT_IS.turn)
        if isinstance(look, OwnMaterials) and isinstance(mesh, GpuTexturedMesh):
            self._normals.draw_shading(mesh, placed, look)
        else:
            self._normals.draw(mesh, placed)

    def _draw_emission(self, shown: Shown) -> None:
        """What does not tell what of its light is its own emits none."""
        mesh, placed, look = shown.drawable.mesh, shown.placed, shown.looks[False]
        map_set = shown.map_set.gpu_map_set
        if isinstance(look, OwnMaterials):
            self._darkness.draw(mesh, placed, look)
        elif isinstance(map_set, Emissive) and look is not None:
            map_set.draw_emission(mesh, placed, look)
        else:
            draw_occluder(mesh, placed)


_DRAWN = {
    COMBINED: Picture._draw_combined,
    NORMAL: Picture._draw_normal,
    EMISSION: Picture._draw_emission,
}
"""Pass that is drawn -> how an object is."""
