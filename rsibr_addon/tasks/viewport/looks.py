"""How objects are shaded: what their settings say, or what can be drawn of it as yet."""

from dataclasses import dataclass
from typing import Any
from weakref import ReferenceType, ref

from ...core.errors import RangeError
from ...device.drawing import GpuMapSet, WithInputs
from ...device.own_materials import OwnMaterials
from ...files.kinds.registry import look_types
from ...host.option_properties import options_of, said_by
from ...host.visible_surfaces import Surface
from ..methods.kinds import KINDS
from .contents import Drawable
from .map_sets import ViewportMapSet


def wants_own(item: Any, kind: str) -> bool:
    """Whether either look of an object asks for its own materials."""
    return KINDS[kind].own and any(_settings(item, kind, other).own for other in (False, True))


def own_look(drawable: Drawable, kind: str, other: bool) -> OwnMaterials | None:
    """A look that shows an object's own materials; None where it asks for none, and is not in the world's."""
    if not (KINDS[kind].own and drawable.materials):
        return None
    settings = _settings(drawable.surface.item, kind, other)
    if not (settings.own or drawable.surface.in_world):
        return None
    return OwnMaterials(drawable.materials.slots, settings.antialiased)


def _settings(item: Any, kind: str, other: bool) -> Any:
    """The properties that say an object's look."""
    return getattr(item.rsibr.other if other else item.rsibr, kind)


@dataclass(frozen=True)
class _Drawn:
    """A look that was asked of a map set.

    Attributes
    ----------
    map_set : weakref.ref
    asked, look : object
        What was asked for, and what is drawn: the last look before it where the map set does not serve that.
    refusal : str
        Why it is not drawn; empty where it is.
    """

    map_set: ReferenceType[GpuMapSet]
    asked: object
    look: Any
    refusal: str = ""


class Looks:
    """Looks of objects; of kinds that are live, those that were asked for since the last that is there.

    Attributes
    ----------
    asked : dict
        Number of an object, path and whether it is the other look -> looks, oldest first.
    """

    def __init__(self) -> None:
        self._types = look_types()
        self._made: dict[tuple[int, bool, str], tuple[object, Any]] = {}  # what was said last, and the look
        self._read: set[tuple[int, bool, str]] = set()  # what has been read since the scene changed
        self._drawn: dict[tuple[int, bool], _Drawn] = {}
        self.asked: dict[tuple[int, str, bool], list[Any]] = {}

    def scene_changed(self) -> None:
        """Read what objects say of their looks anew, when they are drawn next."""
        self._read.clear()

    def of(self, surface: Surface, map_set: ViewportMapSet, other: bool) -> Any:
        """An object's look: as before, while a new one is being made; None before there is any.

        What the map set does not serve leaves the look as it was.

        Raises
        ------
        RangeError
            The map set does not serve the first look that is asked of it.
        """
        look = self._said(surface.item, map_set.kind, other)
        if not KINDS[map_set.kind].live:
            return self._served(map_set.gpu_map_set, (surface.item.original.session_uid, other), look)
        asked = self.asked.setdefault((surface.item.original.session_uid, surface.path, other), [])
        if look in asked:
            asked.remove(look)
        asked.append(look)
        newest = map_set.gpu_map_set.newest(asked)
        if newest is not None:
            del asked[: asked.index(newest)]
        return newest

    def warnings(self, item: Any, map_set: ViewportMapSet) -> list[str]:
        """What the makers of an object's looks have to say of them, or why the last ones are still shown."""
        if not KINDS[map_set.kind].live:
            both = (self._drawn.get((item.original.session_uid, other)) for other in (False, True))
            of_map_set = (each for each in both if each and each.map_set() is map_set.gpu_map_set)
            return list(dict.fromkeys(each.refusal for each in of_map_set if each.refusal))
        looks = [self._said(item, map_set.kind, other) for other in (False, True)]
        return [warning for look in dict.fromkeys(looks) if (warning := map_set.gpu_map_set.warning(look))]

    def keep(self, paths: set[str]) -> None:
        """Forget what was asked of other map sets."""
        self.asked = {shown: looks for shown, looks in self.asked.items() if shown[1] in paths}

    def _served(self, map_set: GpuMapSet, shown: tuple[int, bool], asked: Any) -> Any:
        """A look as a map set can draw it; it is tried once, as every frame asks for it."""
        drawn = self._drawn.get(shown)
        if drawn is None or drawn.asked is not asked or drawn.map_set() is not map_set:
            drawn = self._drawn[shown] = _tried(map_set, asked, drawn)
        return drawn.look

    def _said(self, item: Any, kind: str, other: bool) -> Any:
        """The look that an object's properties say; read once, as every frame asks for it."""
        shown = item.original.session_uid, other, kind
        before, look = self._made.get(shown, (None, None))
        if shown not in self._read:
            group = _settings(item, kind, other)
            said = said_by(self._types[kind], group)
            if before != said:
                look = options_of(self._types[kind], group)
                self._made[shown] = said, look
            self._read.add(shown)
        return look


def _tried(map_set: GpuMapSet, asked: Any, before: _Drawn | None) -> _Drawn:
    try:
        if isinstance(map_set, WithInputs):
            map_set.inputs(asked)
    except RangeError as error:
        if before is None or before.map_set() is not map_set:
            raise
        return _Drawn(before.map_set, asked, before.look, str(error))
    return _Drawn(ref(map_set), asked, asked)
