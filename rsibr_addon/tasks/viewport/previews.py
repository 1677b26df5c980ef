"""The previews of a running Blender: what shades which object, uploaded once and drawn every frame."""

from collections.abc import Collection
from concurrent.futures import Executor
from dataclasses import replace
from itertools import product
from typing import Any

from ...device.preview_stage import (
    Beneath,
    Difference,
    Sight,
    Stage,
    active_target,
    current_sight,
    draw_scale_numbers,
)
from ...host.live_light import is_readable
from ...host.preferences import bakes_inputs_by_itself
from ...host.visible_surfaces import Layer, Side, Surface, View, map_set_of, objects_numbered
from ..methods.kinds import KINDS
from ..methods.live_materials import LiveFits
from .baked_inputs import InputBakes
from .behind import BehindObjects
from .blender_pictures import BlenderPictures
from .contents import Contents, Drawable, LayerContents
from .displays import Displays
from .faults import Faults
from .frame import Frame, Shown, placed
from .looks import Looks, own_look, wants_own
from .map_sets import MapSets, ViewportMapSet
from .own_materials import ShownMaterials
from .worlds import Worlds


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
    worlds : Worlds
        The worlds' own map sets.
    behind : BehindObjects
    faults : Faults
        What went wrong. Call `draw`, `render_surroundings` and `add_display` within its `guarded`.
    is_hiding : bool
        Whether objects are hidden for a moment by `render_surroundings`: what changes then is no edit.
    """

    def __init__(self, fits: LiveFits, reader: Executor) -> None:
        self._fits, self._reader = fits, reader
        self._map_sets = MapSets(fits, reader)
        self.is_hiding = False
        self.release()

    def release(self) -> None:
        """Let go of everything: the file is closed, or the extension leaves."""
        self._stage, self._other_stage = Stage(), Stage()
        self.inputs = InputBakes(self._reader)
        self.worlds = Worlds()
        self.behind = BehindObjects(self._reader)
        self._layers = LayerContents(self._shows_own, self.inputs, self.worlds)
        self._displays = Displays()
        self._surfaces: Any = None
        self._blender_pictures = BlenderPictures()
        self.reload()

    def reload(self) -> None:
        """Read the map sets' files anew, and try again what failed."""
        self._map_sets.keep([])
        self._map_sets = MapSets(self._fits, self._reader)
        self._looks, self.faults = Looks(), Faults()
        self.behind.backgrounds.files_changed()
        self.worlds.changed()
        self._layers.scene_changed(materials=False)

    def scene_changed(self, materials: bool = True) -> None:
        """Look at each scene anew when it is drawn next; what is the same stays uploaded.

        Parameters
        ----------
        materials : bool
            Whether materials, or what they are made of, may have changed too.
        """
        if materials:
            self.worlds.changed()
        self._layers.scene_changed(materials)
        self._looks.scene_changed()
        self._displays.scene_changed()
        self._blender_pictures.scene_changed()
        self.behind.backgrounds.files_changed()
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
        return any(each.is_busy for each in (self._map_sets, self.inputs, self.behind.backgrounds))

    def take_news(self) -> bool:
        """Whether a redraw would show more than the last one."""
        return any([self._map_sets.take_news(), self.inputs.take_news(), self.behind.backgrounds.take_news()])

    def is_loading(self, item: Any) -> bool:
        """Whether an object's map set is on its way."""
        return self._map_sets.is_coming(map_set_of(item))

    def messages(self, item: Any) -> list[str]:
        """What an artist should know of an object's preview: what went wrong, and warnings."""
        map_set = self._map_sets.used.get(map_set_of(item))
        fault = self.faults.message(item)
        warnings = [*map_set.warnings, *self._looks.warnings(item, map_set)] if map_set and not fault else []
        told = [*filter(None, (fault, self.faults.trouble)), *warnings]
        if materials := self.materials_of(item):
            if materials.has_baked:
                told += self.inputs.messages(item.original, bakes_inputs_by_itself())
            told += materials.messages
        return told

    def materials_of(self, item: Any) -> ShownMaterials | None:
        """An object's own materials as its preview shows them; None where it does not."""
        number = item.original.session_uid
        shown = (each.materials for each in self._layers.previewed() if each.surface.number == number)
        return next(shown, None)

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

    def before_surfaces(self) -> None:
        """Note where Blender is going to draw a view's surfaces, for the `draw` of that view."""
        self._surfaces = active_target()

    def draw(self, view: View) -> bool:
        """Draw the previews of a view into the active frame buffer, or beneath Blender's overlays.

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
        sides = view.sides
        wanted = {side.other for side in sides} | {
            not side.other for side in sides if side.difference and not side.from_blender
        }
        frame = self.frame(view, current_sight(), wanted)
        if not frame.shown:
            return True
        display, scale = self._displays.of(view.scene)
        if display is None:
            return False
        for layer, among_others in frame.layers(view):
            for side, strength in product(sides, layer.strengths):
                self._set(self._stage, layer, strength, among_others, side.other)
                if side.difference and not side.from_blender:
                    self._set(self._other_stage, layer, strength, among_others, not side.other)
                difference = self._difference(view, side, strength * scale, scale)
                if side.from_blender and difference is None:  # Blender's own shading stays in sight
                    continue
                span, beneath = (side.left, side.right), self._beneath(view, strength)
                self._stage.show(display, strength * scale, span, among_others, difference, beneath)
        return True

    def frame(self, view: View, sight: Sight, wanted: Collection[bool] = (False,)) -> Frame:
        """What a view shows now, as far as it has been read; a piece more is uploaded.

        Parameters
        ----------
        view : View
        sight : Sight
        wanted : collection of bool
            Which looks: the first, as False, or the other one.
        """
        contents = self._contents(view)
        self._map_sets.begin_frame()
        seen = self._seen(contents, view)
        lacking = [each.surface for each, map_set in seen if KINDS[map_set.kind].own and not each.materials]
        if any(map(self._shows_own, lacking)) or contents.has_faulty(self.faults):
            contents = self._collected(view)  # a map set has come that wants its objects' materials, or none
            seen = self._seen(contents, view)
        looked = [
            (each, map_set, looks)
            for each, map_set in seen
            if (looks := self._looks_of(each, map_set, wanted))
        ]
        shown = [
            Shown(each, map_set, sight.on(each.surface.matrix, light.turn, light.strength), looks)
            for each, map_set, looks in looked
            for light in [contents.light_of(each.surface)]
        ]
        hiding = placed(contents.others or [], view, sight)
        behind = self.behind.of(contents, view, sight, self._world(view), self.faults)
        return replace(behind, shown=shown, hiding=hiding)

    def draw_backdrop(self, view: View) -> None:
        """Fill the active frame buffer with the world, in linear radiance, where all objects are shaded.

        The view's next `frame` has the same behind its objects: Blender asks for both, one after the other.
        """
        if view.shades_all:
            sight, contents = Sight.by(*view.matrices), self._contents(view)
            behind = self.behind.first(contents, view, sight, self._world(view), self.faults)
            behind.draw_behind(self._stage, view, sight)

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
        lights, changed = self._map_sets.lights, False
        if self.faults.trouble or not lights:
            return False
        self.is_hiding = True
        try:
            for name, surface in self._layers.to_be_lit(view, lights).items():
                try:
                    changed |= lights[name].render(view, surface)
                except Exception as error:
                    self.faults.note(surface.item, error)
        finally:
            self.is_hiding = False
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

    def _contents(self, view: View) -> Contents:
        """What a view layer shows, looked at anew if it may have changed."""
        if self.inputs.upload():
            self._layers.scene_changed(materials=False)
        contents = self._layers.layers.get(view.content)
        served = contents is not None and contents.serves(not view.has_depth)
        return contents if contents and served else self._collected(view)

    def _collected(self, view: View) -> Contents:
        """What a view layer shows, looked at anew; what is used no more is let go."""
        contents = self._layers.collect(view, not view.has_depth, self.faults)
        surfaces = [each.surface for each in self._layers.previewed()]
        self.inputs.keep({each.number for each in surfaces})
        self._looks.keep({each.path for each in surfaces})
        self._map_sets.keep(surfaces, self.worlds.shown)
        return contents

    def _world(self, view: View) -> ViewportMapSet | None:
        """What a view that shades all objects shows behind them, once it is there."""
        path = self.worlds.of(view.scene) if view.shades_all else ""
        return self._map_sets.world(path) if path else None

    def _seen(self, contents: Contents, view: View) -> list[tuple[Drawable, ViewportMapSet]]:
        """What a view shows with a preview, and what it is shaded from."""
        return [
            (each, map_set)
            for each in contents.previews
            if each.is_seen(view) and (map_set := self._shading(each.surface))
        ]

    def _shows_own(self, surface: Surface) -> bool:
        """Whether an object is to be drawn with its own materials, by what shades it now."""
        if surface.in_world:
            return True
        map_set = self._map_sets.shown(surface.item)
        return map_set is not None and wants_own(surface.item, map_set.kind)

    def _beneath(self, view: View, strength: float) -> Beneath | None:
        """Where previews lie beneath overlays; None where they have to lie over them."""
        blenders = self._displays.of_surfaces(view.scene, view.space)
        if blenders is None or self._surfaces is None:
            return None
        return Beneath(self._surfaces, strength * blenders.scale if blenders.transforms else None)

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
        if surface.in_world:
            return self._map_sets.shading(surface)
        if self.faults.stands(surface.item):
            return None
        try:
            return self._map_sets.shading(surface)
        except Exception as error:
            self.faults.note(surface.item, error)
            return None

    def _looks_of(
        self, drawable: Drawable, map_set: ViewportMapSet, wanted: Collection[bool]
    ) -> dict[bool, Any]:
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

    def _set(self, stage: Stage, frame: Frame, strength: float, among_others: bool, other: bool) -> None:
        """Draw previews in light of one strength, in their first or their other look, onto a stage."""
        frame.set(stage, strength, not among_others, lambda each: each.draw(other), other)
