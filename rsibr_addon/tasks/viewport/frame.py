"""What one frame shows, with all that it is drawn with."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from typing import Any

from ...device.backdrop import Behind
from ...device.drawing import Draw, GpuMesh
from ...device.matte_layer import CaughtShadow, draw_hole, lay_matte
from ...device.own_materials import OwnMaterials
from ...device.preview_stage import Sight, Stage, draw_occluder
from ...host.visible_surfaces import View
from ...host.world_light import AS_IT_IS
from .contents import Drawable
from .faults import Faults
from .map_sets import ViewportMapSet


@dataclass(frozen=True, eq=False)
class Shown:
    """All that an object's preview in one frame is drawn with.

    Attributes
    ----------
    drawable : Drawable
    map_set : ViewportMapSet
    placed : Draw
    looks : dict
        Whether it is the other look -> the look; None for one that is not there yet.
    """

    drawable: Drawable
    map_set: ViewportMapSet
    placed: Draw
    looks: dict[bool, Any]

    def draw(self, other: bool) -> None:
        """Draw it in its first or its other look, if that is there."""
        if (look := self.looks[other]) is not None:
            self.map_set.gpu_map_set.draw(self.drawable.mesh, self.placed, look)

    def is_opaque(self, other: bool) -> bool:
        """Whether it hides all that is behind it; what does not is drawn over that."""
        look = self.looks[other]
        return not isinstance(look, OwnMaterials) or look.is_opaque


@dataclass(frozen=True, eq=False)
class Frame:
    """What one frame shows.

    Attributes
    ----------
    shown : list of Shown
    hiding : list of (GpuMesh, Draw)
        What may hide it, where the frame buffer does not have its depths.
    holes : list of (GpuMesh, Draw)
        What makes holes in the picture.
    floors : list of (GpuMesh, Draw, CaughtShadow or None)
        What shows the shadows on it alone.
    backdrop : Behind or None
        What lies behind all that, where all objects are shaded.
    exposure : float
        Factor of its radiance.
    faults : Faults
        Takes what goes wrong with an object.
    """

    shown: list[Shown]
    hiding: list[tuple[GpuMesh, Draw]]
    holes: list[tuple[GpuMesh, Draw]]
    floors: list[tuple[GpuMesh, Draw, CaughtShadow | None]]
    backdrop: Behind | None
    exposure: float
    faults: Faults

    @property
    def strengths(self) -> list[float]:
        """Those of the light of its objects: what is drawn together has the same."""
        return list(dict.fromkeys(each.placed.strength for each in self.shown))

    def layers(self, view: View) -> "list[tuple[Frame, bool]]":
        """What is drawn one after the other, and whether among the surfaces that Blender has drawn.

        Objects that are *In Front* come last, where Blender draws them over all others.
        """
        if not view.draws_in_front:
            return [(self, view.has_depth)]
        parts: tuple[list[Shown], list[Shown]] = ([], [])
        for each in self.shown:
            parts[each.drawable.surface.item.show_in_front].append(each)
        others, in_front = parts
        last = replace(self, shown=in_front, hiding=[], holes=[], floors=[])
        return [(replace(self, shown=others), view.has_depth), (last, False)]

    def seen_by(self, sight: Sight) -> "Frame":
        """The same in another view."""

        def placed(draw: Draw) -> Draw:
            return replace(draw, view=sight.view, projection=sight.projection, eye=sight.eye)

        return replace(
            self,
            shown=[replace(each, placed=placed(each.placed)) for each in self.shown],
            hiding=[(mesh, placed(draw)) for mesh, draw in self.hiding],
            holes=[(mesh, placed(draw)) for mesh, draw in self.holes],
            floors=[(mesh, placed(draw), shadow) for mesh, draw, shadow in self.floors],
        )

    def draw_behind(self, stage: Stage, view: View, sight: Sight) -> None:
        """Fill the active frame buffer, which is empty, with the radiance of what lies behind all objects."""
        is_transparent = self.backdrop is None or view.scene.render.film_transparent
        if self.backdrop is not None and not is_transparent:
            light = view.world_light
            self.backdrop.draw(sight, light.turn, light.strength, view.picture_frame, self.exposure)
        if self.holes or self.floors:
            with stage.drawing():
                for mesh, draw in self.holes:
                    draw_hole(mesh, draw)
                for mesh, draw, shadow in self.floors:
                    if shadow is None:
                        draw_occluder(mesh, draw)
                    else:
                        shadow.draw(mesh, draw)
            lay_matte(stage.radiance, is_transparent)

    def set(
        self, stage: Stage, strength: float, hidden: bool, draw: Callable[[Shown], None], other: bool = False
    ) -> None:
        """Draw the objects in light of one strength onto a stage.

        Parameters
        ----------
        stage : Stage
        strength : float
            One of `strengths`.
        hidden : bool
            Whether what hides them is drawn as well, and not left to the frame buffer's depths.
        draw : callable
            Draws one.
        other : bool
            Whether in their other look.
        """
        group = [each for each in self.shown if each.placed.strength == strength]
        others = [each for each in self.shown if each.placed.strength != strength]
        floors = [(mesh, draw) for mesh, draw, _ in self.floors]
        hiding = [*self.hiding, *self.holes, *floors, *((each.drawable.mesh, each.placed) for each in others)]
        with stage.drawing():
            for mesh, placed in hiding if hidden else ():
                draw_occluder(mesh, placed)
            for each in sorted(group, key=lambda each: not each.is_opaque(other)):
                try:
                    draw(each)
                except Exception as error:
                    self.faults.note(each.drawable.surface.item, error)


def placed(drawables: Iterable[Drawable], view: View, sight: Sight) -> list[tuple[GpuMesh, Draw]]:
    """Those that a view shows, with their places."""
    return [
        (each.mesh, sight.on(each.surface.matrix, AS_IT_IS.turn)) for each in drawables if each.is_seen(view)
    ]
