"""What lies behind all objects of a view: the background, holes, and the floors that catch shadows."""

from concurrent.futures import Executor
from typing import Any

from ...device.preview_stage import Sight
from ...host.visible_surfaces import View
from .backgrounds import Backgrounds
from .contents import Contents
from .faults import Faults
from .floors import Floors
from .frame import Frame, placed
from .map_sets import ViewportMapSet


class BehindObjects:
    """Makes the part of frames that lies behind objects, once where Blender asks for it twice.

    Parameters
    ----------
    worker : Executor
        See `Backgrounds`.

    Attributes
    ----------
    floors : Floors
    backgrounds : Backgrounds
    """

    def __init__(self, worker: Executor) -> None:
        self.floors, self.backgrounds = Floors(), Backgrounds(worker)
        self._drawn: tuple[Any, Contents, Frame] | None = None

    def first(
        self, contents: Contents, view: View, sight: Sight, world: ViewportMapSet | None, faults: Faults
    ) -> Frame:
        """For what is drawn before the objects of a viewport; `of` takes the same for the objects.

        Parameters
        ----------
        contents : Contents
        view : View
            Of a viewport that shades all objects.
        sight : Sight
        world : ViewportMapSet or None
            The world's, once it is there.
        faults : Faults
        """
        frame = self.of(contents, view, sight, world, faults)
        self._drawn = view.space, contents, frame
        return frame

    def of(
        self, contents: Contents, view: View, sight: Sight, world: ViewportMapSet | None, faults: Faults
    ) -> Frame:
        """A frame without objects: see `first`; of a view that does not shade all objects, it is empty."""
        drawn, self._drawn = self._drawn, None
        if not view.shades_all:
            return Frame([], [], [], [], None, 1.0, faults)
        if drawn and drawn[0] == view.space and drawn[1] is contents:
            return drawn[2].seen_by(sight)
        light = world.backdrop.environment if world and world.backdrop else None
        floors = [
            (mesh, draw, shadow)
            for each, shadow in self.floors.caught(contents, view, light, sight.eye)
            for mesh, draw in placed([each.drawable], view, sight)
        ]
        behind, exposure = self.backgrounds.of(view.depsgraph.scene_eval, world.backdrop if world else None)
        return Frame([], [], placed(contents.holes, view, sight), floors, behind, exposure, faults)
