"""The previews of a running Blender: what shades which object, uploaded once and drawn every frame."""

from collections.abc import Collection
from concurrent.futures import Executor
from dataclasses import dataclass
from itertools import product
from typing import Any

from ...device.drawing import Draw, GpuMesh
from ...device.own_materials import OwnMaterials
from ...device.preview_stage import Difference, Stage, current_sight, draw_occluder, draw_scale_numbers
from ...host.bake_settings import bakes_inputs_by_itself
from ...host.live_light import is_readable, shows_surroundings
from ...host.visible_surfaces import Layer, Side, Surface, View, map_set_of, objects_numbered
from ...host.world_light import AS_IT_IS
from ..methods.kinds import KINDS
from ..methods.live_materials import LiveFits
from .baked_inputs import InputBakes
from .blender_pictures import BlenderPictures
from .contents import Contents, Drawable, LayerContents
from .displays import Displays
from .faults import Faults
from .looks import Looks, own_look, wants_own
from .map_sets import MapSets, ViewportMapSet


@dataclass(frozen=True, eq=False)
class _Shown:
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


class Previews:
    """All that viewports need between frames. Nothing is on the GPU before the first preview is drawn.

    Objects say what shades them in `properties.RSIBR_PG_preview`. One whose preview fails is left to
    Blender until its settings change.

    Parameters
    ----------
    fits : LiveFits
        Makes looks of kinds that are live.
    reader : Executor
        Reads map sets.

    Attributes
    ----------
    inputs : InputBakes
        What was baked of materials.
    faults : Faults
        What went wrong. Call `draw`, `render_surroundings` and `add_display` within its `guarded`.
    """

    def __init__(self, fits: LiveFits, reader: Executor) -> None:
        self._fits, self._reader = fits, reader
        self._map_sets = MapSets(fits, reader)
        self.release()

    def release(self) -> None:
        """Let go of everything: the file is closed, or the extension leaves."""
        self._stage, self._other_stage = Stage(), Stage()
        self.inputs = InputBakes(self._reader)
        self._layers = LayerContents(self._shows_own, self.inputs)
        self._displays = Displays()
        self._blender_pictures = BlenderPictures()
        self.reload()

    def reload(self) -> None:
        """Read the map sets' files anew, and try again what failed."""
        self._map_sets.keep([])
        self._map_sets = MapSets(self._fits, self._reader)
        self._looks, self.faults = Looks(), Faults()

    def scene_changed(self, materials: bool = True) -> None:
        """Look at each scene anew when it is drawn next; what is the same stays uploaded.

        Parameters
        ----------
        materials : bool
            Whether materials, or what they are made of, may have changed too.
        """
        self._layers.scene_changed(materials)
        self._blender_pictures.scene_changed()
        for light in self._map_sets.lights.values():
            light.scene_changed()

    def data_replaced(self) -> None:
        """Forget Blender's data: after an undo, they are others."""
        self.scene_changed()
        self._layers.layers.clear()
        self.inputs.is_unasked = True

    def kind(self, item: Any) -> str | None:
        """The kind of map set that shades an object; None before it is drawn."""
        map_set = self._map_sets.used.get(map_set_of(item))
        return map_set.kind if map_set else None

    @property
    def is_busy(self) -> bool:
        """Whether a map set is on its way, so that `take_news` is to be asked."""
        return self._map_sets.is_busy or self.inputs.is_busy

    def take_news(self) -> bool:
        """Whether a redraw would show more than the last one."""
        return any([self._map_sets.take_news(), self.inputs.take_news()])

    def is_loading(self, item: Any) -> bool:
        """Whether an object's map set is on its way."""
        return self._map_sets.is_coming(map_set_of(item))

    def messages(self, item: Any) -> list[str]:
        """What an artist should know of an object's preview: what went wrong, and warnings."""
        map_set = self._map_sets.used.get(map_set_of(item))
        fault = self.faults.message(item)
        warnings = [*map_set.warnings, *self._looks.warnings(item, map_set)] if map_set and not fault else []
        shown = next(
            (each for each in self._layers.previewed() if each.surface.number == item.session_uid), None
        )
        told = [*filter(None, (fault, self.faults.trouble)), *warnings]
        if shown and shown.materials:
            told += self.inputs.messages(item, bakes_inputs_by_itself()) if shown.materials.has_baked else []
            told += shown.materials.messages
        return told

    def with_baked_inputs(self, layers: Collection[Layer] | None = None) -> list[Any]:
        """The objects whose materials have inputs that have to be baked.

        Parameters
        ----------
        layers : collection of Layer, optional
            Those that show them; all of them by default.
        """
        return objects_numbered(self._numbers_with_baked_inputs(layers))

    @property
    def has_baked_inputs(self) -> bool:
        """Whether there may be any such object, though it was deleted since."""
        return bool(self._numbers_with_baked_inputs())

    def draw(self, view: View) -> bool:
        """Draw the previews of a view into the active frame buffer.

        Parameters
        ----------
        view : View
            The one that Blender is drawing.

        Returns
        -------
        bool
            False where there is something to draw, and `add_display` has to be called for it.
        """
        if self.faults.trouble or not view.shaded:
            return True
        has_depth, sides = view.has_depth, view.sides
        if self.inputs.upload():
            self._layers.scene_changed(materials=False)
        contents = self._layers.layers.get(view.layer)
        if contents is None or not contents.serves(not has_depth):
            contents = self._collected(view)
        self._map_sets.begin_frame()
        seen = self._seen(contents, view)
        lacking = [each.surface for each, map_set in seen if KINDS[map_set.kind].own and not each.materials]
        if any(map(self._shows_own, lacking)):
            contents = self._collected(view)  # a map set has come that wants its objects' materials
            seen = self._seen(contents, view)
        if not seen:
            return True
        display, scale = self._displays.of(view.scene)
        if display is None:
            return False
        wanted = {side.other for side in sides} | {
            not side.other for side in sides if side.difference and not side.from_blender
        }
        looked = [
            (each, map_set, looks)
            for each, map_set in seen
            if (looks := self._looks_of(each, map_set, wanted))
        ]
        lights = view.lights_of(each.surface.item for each, *_ in looked)
        sight = current_sight()
        hiding = [
            (each.mesh, sight.on(each.surface.matrix, AS_IT_IS.turn))
            for each in contents.others or ()
            if each.is_seen(view)
        ]
        shown = [
            _Shown(each, map_set, sight.on(each.surface.matrix, light.turn, light.strength), looks)
            for (each, map_set, looks), light in zip(looked, lights, strict=True)
        ]
        for side, strength in product(sides, dict.fromkeys(each.placed.strength for each in shown)):
            group = [each for each in shown if each.placed.strength == strength]
            others = [(each.drawable.mesh, each.placed) for each in shown if each.placed.strength != strength]
            behind = [] if has_depth else hiding + others
            self._set(self._stage, behind, group, side.other)
            if side.difference and not side.from_blender:
                self._set(self._other_stage, behind, group, not side.other)
            difference = self._difference(view, side, strength * scale, scale)
            if side.from_blender and difference is None:  # Blender's own shading stays in sight
                continue
            self._stage.show(display, strength * scale, (side.left, side.right), has_depth, difference)
        return True

    def render_surroundings(self, view: View) -> bool:
        """Render the light around objects that are in live light, as far as the scene has changed.

        Parameters
        ----------
        view : View
            The one whose pixels Blender is drawing.

        Returns
        -------
        bool
            Whether any light has changed, and what shows it has to be drawn again.
        """
        lights, contents = self._map_sets.lights, self._layers.layers.get(view.layer)
        if self.faults.trouble or not (lights and contents and shows_surroundings(view.space, view.layer)):
            return False
        first: dict[str, Surface] = {}  # instances share the light of their object
        for each in contents.previews:
            if each.surface.path in lights and each.is_seen(view):
                first.setdefault(each.surface.path, each.surface)
        changed = False
        for name, surface in first.items():
            try:
                changed |= lights[name].render(view, surface)
            except Exception as error:
                self.faults.note(surface.item, error)
        return changed

    def render_compared(self, view: View) -> bool:
        """Render Blender's own shading of a view, if a difference from it is shown; and the scale's numbers.

        Parameters
        ----------
        view : View
            The one whose pixels Blender is drawing.

        Returns
        -------
        bool
            Whether the view has to be drawn again.
        """
        changed = False
        for side in view.sides if view.shaded and not self.faults.trouble else ():
            if not side.difference or (side.from_blender and not is_readable(view.space)):
                continue
            if side.from_blender:
                changed |= self._blender_pictures.render(view)
            draw_scale_numbers(side.left, side.difference)
        return changed

    def add_display(self, scene: Any) -> None:
        """Learn how a scene shows radiance; not while a view is being drawn, as data come and go for it.

        Parameters
        ----------
        scene : bpy.types.Scene
        """
        self._displays.learn(scene)

    def _numbers_with_baked_inputs(self, layers: Collection[Layer] | None = None) -> set[int]:
        previewed = self._layers.previewed(layers)
        return {each.surface.number for each in previewed if each.materials and each.materials.has_baked}

    def _collected(self, view: View) -> Contents:
        """What a view layer shows, looked at anew; what is used no more is let go."""
        contents = self._layers.collect(view, not view.has_depth, self.faults)
        surfaces = [each.surface for each in self._layers.previewed()]
        self.inputs.keep({each.number for each in surfaces})
        self._looks.keep({each.path for each in surfaces})
        self._map_sets.keep(surfaces)
        return contents

    def _seen(self, contents: Contents, view: View) -> list[tuple[Drawable, ViewportMapSet]]:
        """What a view shows with a preview, and what it is shaded from."""
        return [
            (each, map_set)
            for each in contents.previews
            if each.is_seen(view) and (map_set := self._shading(each.surface))
        ]

    def _shows_own(self, surface: Surface) -> bool:
        """Whether an object is to be drawn with its own materials, by what shades it now."""
        map_set = self._map_sets.shown(surface.item)
        return map_set is not None and wants_own(surface.item, map_set.kind)

    def _difference(self, view: View, side: Side, scale: float, of_blender: float) -> Difference | None:
        """What a side is compared with, if it shows a difference."""
        if not side.difference:
            return None
        if not side.from_blender:
            return Difference(self._other_stage.radiance, scale, side.difference)
        picture = self._blender_pictures.of(view) if is_readable(view.space) else None
        return None if picture is None else Difference(picture, of_blender, side.difference)

    def _shading(self, surface: Surface) -> ViewportMapSet | None:
        """What an object is shaded from; None where that is not there yet, or something has gone wrong."""
        if self.faults.stands(surface.item):
            return None
        try:
            return self._map_sets.shading(surface)
        except Exception as error:
            self.faults.note(surface.item, error)
            return None

    def _looks_of(self, drawable: Drawable, map_set: ViewportMapSet, wanted: set[bool]) -> dict[bool, Any]:
        """The looks that are wanted of an object, by whether it is the other one; empty after a fault."""
        try:
            return {
                other: own_look(drawable, map_set.kind, other)
                or self._looks.of(drawable.surface, map_set, other)
                for other in wanted
            }
        except Exception as error:
            self.faults.note(drawable.surface.item, error)
            return {}

    def _set(
        self, stage: Stage, behind: list[tuple[GpuMesh, Draw]], group: list[_Shown], other: bool
    ) -> None:
        """Draw previews, in their first or their other look, onto a stage, and what hides them."""
        with stage.drawing():
            for mesh, placed in behind:
                draw_occluder(mesh, placed)
            for each in sorted(group, key=lambda each: not _is_opaque(each.looks[other])):
                surface, look = each.drawable.surface, each.looks[other]
                if look is not None:
                    try:
                        each.map_set.gpu_map_set.draw(each.drawable.mesh, each.placed, look)
                    except Exception as error:
                        self.faults.note(surface.item, error)


def _is_opaque(look: Any) -> bool:
    """Whether it hides all that is behind it; what does not is drawn over that."""
    return not isinstance(look, OwnMaterials) or look.is_opaque
