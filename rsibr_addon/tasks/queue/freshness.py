"""Whether what shades objects is what a bake with the same settings would make today, and if not, why.

A file's name is a hash of all that it depends on (`output_for`), so another name tells that something has
changed. That takes long to compute for big images, so it is done only after an edit, and kept.
"""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ...core.errors import RsibrError
from ...files.version import rsibr
from ...host.map_sets import planned_path
from ...host.version import software
from ..methods.bake import METHODS
from ..report.facts import map_set_header
from .bake_request import BakeRequest, output_for, request_for


@dataclass(frozen=True)
class Stale:
    """Why an object's map set is out of date.

    Attributes
    ----------
    reason : str
        What has changed, in words.
    request, output : BakeRequest and Path, or None
        What would be baked today, and its file; None where that cannot be baked.
    by_itself : bool
        Whether that is done without asking: the object follows the world, and no material is baked.
    """

    reason: str
    request: BakeRequest | None = None
    output: Path | None = None
    by_itself: bool = False


class Freshness:
    """What is known of the objects of the scenes that are shown.

    Attributes
    ----------
    stale : dict
        Number of an object -> Stale, or None for one that is up to date. Others were not baked here.
    """

    def __init__(self) -> None:
        self.stale: dict[int, Stale | None] = {}
        self._worlds: dict[int, int | None] = {}
        self._seen: dict[int, tuple[object, ...]] = {}

    def of(self, item: Any) -> Stale | None:
        """Why an object's map set is out of date; None where it is not, or that is not known."""
        return self.stale.get(item.session_uid)

    def serves(self, request: BakeRequest, scene: Any, item: Any) -> bool:
        """Whether an object is up to date, and was baked with what a request asks for.

        Parameters
        ----------
        request : BakeRequest
            The request of `scene` and `item`.
        scene : bpy.types.Scene
        item : bpy.types.Object
        """
        if self.stale.get(item.session_uid, Stale("")) is not None:
            return False
        try:
            return request_for(item.rsibr_baked, scene, item).makes_the_same(request)
        except RsibrError:
            return False

    def has_changed(self, scene: Any, items: list[Any]) -> bool:
        """Whether a scene has another world, or one of these objects another map set, than when looked at."""
        return self._worlds.get(scene.session_uid) != _number(scene.world) or any(
            self._seen.get(item.session_uid) != _seen(item) for item in items if _is_baked(item)
        )

    def look(self, scenes: Iterable[Any]) -> None:
        """Look at all objects of scenes, and forget others.

        Parameters
        ----------
        scenes : iterable of bpy.types.Scene
        """
        self._worlds, self._seen, self.stale = {}, {}, {}
        for scene in scenes:
            self._worlds[scene.session_uid] = _number(scene.world)
            found: dict[tuple[object, ...], Stale | None] = {}
            for item in filter(_is_baked, scene.objects):
                self._seen[item.session_uid] = _seen(item)
                alike = *_seen(item), _number(item.active_material)
                if alike not in found:
                    found[alike] = _staleness(scene, item)
                self.stale[item.session_uid] = found[alike]

    def wanted(self, scene: Any) -> Iterator[tuple[Stale, list[Any]]]:
        """What is to be baked today, each with the objects of a scene that it is for."""
        for output in {each.output for each in self.stale.values() if each and each.output}:
            items = [item for item in scene.objects if (stale := self.of(item)) and stale.output == output]
            if items:
                stale = self.of(items[0])
                assert stale is not None
                yield stale, items


def _is_baked(item: Any) -> bool:
    if item.rsibr.painted:
        return False
    return item.rsibr.image is not None and item.is_editable and item.is_property_set("rsibr_baked")


def _seen(item: Any) -> tuple[object, ...]:
    """What of an object tells which file it should have, besides worlds, materials and images."""
    return _number(item.rsibr.image), item.rsibr.follow_world


def _number(data: Any) -> int | None:
    return data.session_uid if data else None


def _staleness(scene: Any, item: Any) -> Stale | None:
    baked, path = item.rsibr_baked, Path(planned_path(item.rsibr))
    try:
        request = request_for(baked, scene, item)
        output = output_for(request, scene, item)
        made_by = map_set_header(path)["software"]
    except (RsibrError, OSError) as error:
        return Stale(str(error))
    if output.name == path.name:
        return None
    if made_by not in (rsibr(), software()):
        return Stale("Baked by another version", request, output)
    in_world = baked.light == "WORLD"
    light = "World" if in_world else "Picture"
    if request.own_material is not None:
        what = f"World or {request.own_material}" if in_world else request.own_material
        return Stale(f"{what} changed", request, output)
    of_light_alone = not METHODS[request.settings.KIND].material(request.settings)
    follows = in_world and of_light_alone and item.rsibr.follow_world
    return Stale(f"{light} changed", request, output, follows)
