"""The previews of a running Blender: what shades which object, uploaded once and drawn every frame."""

import traceback
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from itertools import product
from typing import Any

from ...core.conventions import Array
from ...core.errors import RsibrError
from ...core.pictures.display import table_radiance
from ...device import buffers
from ...device.preview_stage import Sight, Stage, current_sight, draw_occluder
from ...files.kinds.registry import look_types
from ...host.display import Display, display_of, displayed_colours, scale_before_display
from ...host.live_light import is_live_name, shows_surroundings
from ...host.map_sets import written_path
from ...host.option_properties import options_of, said_by
from ...host.visible_surfaces import Layer, Surface, View, is_wanted, map_set_of, shown_layers, surfaces
from ...host.world_light import AS_IT_IS
from ..methods.kinds import KINDS
from .live_light import LiveLight
from .map_sets import UnusedMapSets, UploadedMapSet, upload_map_set
from .meshes import UploadedMeshes

DISPLAYS_KEPT = 4
"""Tables of 7 MB each, so that one can switch between view transforms."""


@dataclass(frozen=True, eq=False)
class _Preview:
    """A surface, and the file that it is shaded from."""

    surface: Surface
    path: str


@dataclass
class _Contents:
    """What a view layer shows: surfaces with a preview, and, where they were asked for, without."""

    previews: list[_Preview]
    others: list[Surface] | None
    changed: bool = False
    paths: dict[Any, str] = field(default_factory=dict)

    @property
    def moved(self) -> bool:
        """Whether a map set was packed or moved; Blender sends no notice of that."""
        return any(map_set_of(item) != path for item, path in self.paths.items())


@dataclass(frozen=True)
class _Fault:
    """What went wrong with an object, and the settings that it went wrong with."""

    settings: object
    message: str


class Previews:
    """All that viewports need between frames. Nothing is on the GPU before the first preview is drawn.

    Objects say what shades them in `properties.RSIBR_PG_preview`. One whose preview fails is left to
    Blender until its settings change.
    """

    def __init__(self) -> None:
        self.release()

    def release(self) -> None:
        """Let go of everything: the file is closed, or the extension leaves."""
        self._stage, self._other_stage = Stage(), Stage()
        self._contents: dict[Layer, _Contents] = {}
        self._meshes = UploadedMeshes()
        self._map_sets: dict[str, UploadedMapSet] = {}
        self._unused = UnusedMapSets()
        self._live: dict[str, LiveLight] = {}
        self._displays: dict[Display, Any] = {}
        self._learnt: dict[Display, Array] = {}
        self._looks: dict[tuple[int, str, bool], list[Any]] = {}
        self._faults: dict[int, _Fault] = {}
        self.trouble: str | None = None

    def scene_changed(self) -> None:
        """Look at each scene anew when it is drawn next; what is the same stays uploaded."""
        for contents in self._contents.values():
            contents.changed = True
        for light in self._live.values():
            light.scene_changed()

    def data_replaced(self) -> None:
        """Forget Blender's data: after an undo, they are others."""
        self.scene_changed()
        self._contents.clear()

    def reload(self) -> None:
        """Read the map sets' files anew, and try again what failed."""
        self._map_sets.clear()
        self._unused = UnusedMapSets()
        self._live.clear()
        self._faults.clear()
        self.trouble = None

    def kind(self, item: Any) -> str | None:
        """The kind of map set that shades an object; None before it is drawn."""
        map_set = self._map_sets.get(map_set_of(item))
        return map_set.kind if map_set else None

    def fault(self, item: Any) -> str | None:
        """Why an object is not shaded from its map set, in a sentence."""
        fault = self._faults.get(item.session_uid)
        return fault.message if fault else None

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
        with self.guarded():
            return bool(self.trouble) or not view.shaded or self._draw(view)
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
        changed = False
        with self.guarded():
            if self.trouble or not (self._live and shows_surroundings(view.space, view.layer)):
                return False
            for name, surface in self._in_live_light(view).items():
                with self._faults_noted(surface.item):
                    changed |= self._live[name].render(view, surface)
        return changed

    def add_display(self, scene: Any) -> None:
        """Learn how a scene shows radiance; not while a view is being drawn, as data come and go for it.

        Parameters
        ----------
        scene : bpy.types.Scene
        """
        with self.guarded():
            self._learnt[display_of(scene)] = displayed_colours(scene, table_radiance())

    @contextmanager
    def guarded(self) -> Iterator[None]:
        """Within, whatever goes wrong ends all previews until `reload`, and is told once: Blender goes on."""
        try:
            yield
        except Exception as error:
            self.trouble = self.trouble or _told(error)

    def _draw(self, view: View) -> bool:
        contents = self._contents_of(view)
        seen = [each for each in contents.previews if _is_seen(each.surface, view) and self._is_ready(each)]
        if not seen:
            return True
        display = self._display(view)
        if display is None:
            return False
        hidden_by = [each for each in contents.others or () if _is_seen(each, view)]
        sight = current_sight()
        for side, (strength, group) in product(view.sides, _by_strength(seen, view).items()):
            behind = (
                [] if view.has_depth else hidden_by + [each.surface for each in seen if each not in group]
            )
            self._set(self._stage, behind, group, view, sight, side.other)
            difference = (self._other_stage, side.difference) if side.difference else None
            if difference:
                self._set(self._other_stage, behind, group, view, sight, not side.other)
            scale = strength * scale_before_display(view.scene)
            self._stage.show(display, scale, (side.left, side.right), view.has_depth, difference)
        return True

    def _set(
        self,
        stage: Stage,
        behind: list[Surface],
        group: list[_Preview],
        view: View,
        sight: Sight,
        other: bool,
    ) -> None:
        """Draw previews, in their first or their other look, onto a stage."""
        with stage.drawing():
            self._hide(behind, sight)
            for each in group:
                self._draw_one(each, view, sight, other)

    def _hide(self, behind: list[Surface], sight: Sight) -> None:
        """Let surfaces hide what is drawn after them."""
        for surface in behind:
            draw_occluder(self._meshes[surface], sight.on(surface.matrix, AS_IT_IS.turn))

    def _contents_of(self, view: View) -> _Contents:
        contents = self._contents.get(view.layer)
        known = contents is not None and (contents.others is None) == view.has_depth
        if contents is None or not known or contents.changed or contents.moved:
            contents = self._contents[view.layer] = self._collect(view)
            self._let_go_of_unused()
        return contents

    def _collect(self, view: View) -> _Contents:
        """Find what a view layer shows, and upload the meshes that are new."""
        contents = _Contents([], None if view.has_depth else [])
        if not is_wanted():
            self._faults.clear()
            return contents
        for surface, evaluated in surfaces(view.depsgraph):
            path = map_set_of(surface.item)
            if not path:
                self._faults.pop(surface.item.session_uid, None)
            if not path and contents.others is None:
                continue
            if not self._meshes.there(surface, evaluated, view.depsgraph):
                continue
            if path:
                contents.previews.append(_Preview(surface, path))
                contents.paths[surface.item] = path
            elif contents.others is not None:
                contents.others.append(surface)
        return contents

    def _let_go_of_unused(self) -> None:
        for layer in self._contents.keys() - shown_layers():
            del self._contents[layer]
        previews = [each for contents in self._contents.values() for each in contents.previews]
        others = [each for contents in self._contents.values() for each in contents.others or ()]
        self._meshes.keep([*(each.surface for each in previews), *others])
        paths = {each.path for each in previews}
        for path in self._map_sets.keys() - paths:
            self._unused.keep(path, self._map_sets.pop(path))
        self._live = {name: light for name, light in self._live.items() if name in paths}
        self._looks = {shown: looks for shown, looks in self._looks.items() if shown[1] in paths}

    def _in_live_light(self, view: View) -> dict[str, Surface]:
        """The first of the surfaces in each light; instances share their object's."""
        contents = self._contents.get(view.layer)
        found: dict[str, Surface] = {}
        for each in contents.previews if contents else ():
            if each.path in self._live and _is_seen(each.surface, view):
                found.setdefault(each.path, each.surface)
        return found

    def _is_ready(self, preview: _Preview) -> bool:
        """Whether an object can be drawn: its map set is uploaded, and nothing has gone wrong."""
        item = preview.surface.item
        fault = self._faults.get(item.session_uid)
        if fault and fault.settings == _settings(item):
            return False
        self._faults.pop(item.session_uid, None)
        if preview.path not in self._map_sets:
            with self._faults_noted(item):
                self._map_sets[preview.path] = self._opened(preview)
        light = self._live.get(preview.path)
        return preview.path in self._map_sets and (light is None or light.is_ready)

    def _opened(self, preview: _Preview) -> UploadedMapSet:
        if is_live_name(preview.path):
            light = self._live[preview.path] = LiveLight(int(preview.surface.item.rsibr.live.size))
            return UploadedMapSet("mip_chain", light.gpu_map_set)
        path = written_path(preview.surface.item.rsibr)
        return self._unused.take(preview.path, path) or upload_map_set(path)

    def _draw_one(self, preview: _Preview, view: View, sight: Sight, other: bool) -> None:
        map_set, surface = self._map_sets[preview.path], preview.surface
        with self._faults_noted(surface.item):
            look = self._look(preview, other)
            if look is not None:
                placed = sight.on(surface.matrix, view.light_of(surface.item).turn)
                map_set.gpu_map_set.draw(self._meshes[surface], placed, look)

    def _look(self, preview: _Preview, other: bool) -> Any:
        """How an object is shaded: as before, while a new look is being made; None before there is any."""
        item, map_set = preview.surface.item, self._map_sets[preview.path]
        kind = KINDS[map_set.kind]
        look: Any = options_of(
            look_types()[map_set.kind], getattr(item.rsibr.other if other else item.rsibr, map_set.kind)
        )
        asked = self._looks.setdefault((item.session_uid, preview.path, other), [])
        if look in asked:
            asked.remove(look)
        asked.append(look)
        newest = kind.newest(map_set.gpu_map_set, asked)
        if newest is not None:
            del asked[: asked.index(newest)]
        return newest

    def _display(self, view: View) -> Any:
        """The texture of how a view's scene shows radiance; None if that is not known yet."""
        display = display_of(view.scene)
        if display in self._learnt:
            while len(self._displays) >= DISPLAYS_KEPT:
                del self._displays[next(iter(self._displays))]
            self._displays[display] = buffers.table_texture(self._learnt.pop(display))
        return self._displays.get(display)

    @contextmanager
    def _faults_noted(self, item: Any) -> Iterator[None]:
        try:
            yield
        except Exception as error:
            self._faults[item.session_uid] = _Fault(_settings(item), _told(error))


def _is_seen(surface: Surface, view: View) -> bool:
    return bool(surface.shown_by.visible_in_viewport_get(view.space))


def _by_strength(previews: list[_Preview], view: View) -> dict[float, list[_Preview]]:
    groups: dict[float, list[_Preview]] = {}
    for each in previews:
        groups.setdefault(view.light_of(each.surface.item).strength, []).append(each)
    return groups


def _settings(item: Any) -> object:
    """All that an object says of its preview."""
    both = (item.rsibr, item.rsibr.other)
    said = [said_by(look, getattr(looks, kind)) for looks in both for kind, look in look_types().items()]
    return map_set_of(item), said


def _told(error: Exception) -> str:
    """An error in a sentence; where it is a mistake of ours, its traceback goes to the console."""
    if isinstance(error, RsibrError | OSError):
        return str(error)
    traceback.print_exception(error)
    return f"The preview failed ({type(error).__name__}: {error}): see the console, and report it."


previews = Previews()
"""The previews of this Blender."""
