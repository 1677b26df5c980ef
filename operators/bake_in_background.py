"""Bake for the selected objects in a background Blender, by the scene's settings."""

from collections.abc import Sequence

import bpy

from ..rsibr_addon.core.errors import RsibrError
from ..rsibr_addon.core.warned import warn
from ..rsibr_addon.files.map_set import is_whole_map_set
from ..rsibr_addon.host.bake_settings import SHAPED, assign
from ..rsibr_addon.session.running import session
from ..rsibr_addon.tasks.queue.background import Farm
from ..rsibr_addon.tasks.queue.bake_request import (
    BakeRequest,
    bake_of,
    output_for,
    plain_name,
    request_for,
)
from ..rsibr_addon.tasks.report.facts import map_set_content
from . import background
from .at_once import Undoable
from .reporting import can_start


class RSIBR_OT_bake(Undoable, bpy.types.Operator):
    """Bake in the background, then shade the selected objects from what was baked"""  # noqa: D400  (a tooltip)

    bl_idname = "rsibr.bake"
    bl_label = "Bake"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Whether the bake can start; if not, the button's tooltip says why."""
        return can_start(cls, lambda: request_for(context.scene.rsibr_bake, context.scene, context.object))

    def work(self, context: bpy.types.Context) -> None:
        """Queue the bakes; where the same was baked before, its file is taken at once."""
        self.report({"INFO"}, queue_bakes(context.scene, chosen_objects(context)))


def chosen_objects(context: bpy.types.Context) -> list[bpy.types.Object]:
    """The active object, and the others that are selected and can be shaded."""
    selected = [each for each in context.selected_objects if each.type in SHAPED]
    return list(dict.fromkeys((context.object, *selected)))


def queue_bakes(
    scene: bpy.types.Scene, items: Sequence[bpy.types.Object], kind: str = "", farm: Farm | None = None
) -> str:
    """Bake for objects by a scene's settings, once for all that ask for the same.

    Parameters
    ----------
    scene : bpy.types.Scene
    items : sequence of bpy.types.Object
        At least one.
    kind : str
        See `request_for`.
    farm : Farm, optional
        Does the bakes.

    Returns
    -------
    str
        What was done, in words.

    Raises
    ------
    RsibrError
        See `request_for`, of the first object, `output_for` and `bake_of`.

    Warns
    -----
    RsibrWarning
        Another object cannot be baked for.
    """
    first = request_for(scene.rsibr_bake, scene, items[0], kind)
    alike = {(first.own_material, first.light): (first, [items[0]])}
    for item in items[1:]:
        try:
            request = request_for(scene.rsibr_bake, scene, item, kind)
        except RsibrError as error:
            warn(str(error))
            continue
        alike.setdefault((request.own_material, request.light), (request, []))[1].append(item)
    return "; ".join(queue_bake(scene, request, shaded, farm=farm) for request, shaded in alike.values())


def queue_bake(
    scene: bpy.types.Scene,
    request: BakeRequest,
    items: Sequence[bpy.types.Object],
    content: str = "",
    by_itself: bool = False,
    farm: Farm | None = None,
) -> str:
    """Bake for objects, unless the same is being baked or was before.

    Parameters
    ----------
    scene : bpy.types.Scene
    request : BakeRequest
        That of each of the objects.
    items : sequence of bpy.types.Object
    content : str
        Hash of what a file that was baked before has to hold; empty if anything will do.
    by_itself : bool
        Whether nobody asked for it.
    farm : Farm, optional
        Does the bake.

    Returns
    -------
    str
        What was done, in words.

    Raises
    ------
    RsibrError
        See `output_for` and `bake_of`.
    """
    output = output_for(request, scene, items[0])
    numbers = [item.session_uid for item in items]
    if (unfinished := session().bakes.unfinished(output)) is not None:
        unfinished.items += [number for number in numbers if number not in unfinished.items]
        unfinished.by_itself &= by_itself
        return f"Being baked already: {plain_name(output)}"
    if is_whole_map_set(output) and content in ("", map_set_content(output)):
        assign(numbers, output, request.shown)
        return f"Baked before: {plain_name(output)}"
    bake = bake_of(request, scene, items, output, farm)
    bake.by_itself = by_itself
    background.submit(bake)
    return f"{'Sending' if farm else 'Baking'} {plain_name(output)}"
