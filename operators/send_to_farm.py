"""Have a farm bake, then shade the selected objects from what it has baked."""

from collections.abc import Iterator, Sequence

import bpy

from ..rsibr_addon.core.errors import RsibrError, SceneError
from ..rsibr_addon.core.warned import warn
from ..rsibr_addon.files.baked_inputs import is_whole
from ..rsibr_addon.host.preferences import check_online, farm_address, farm_folder
from ..rsibr_addon.tasks.methods.kinds import KINDS
from ..rsibr_addon.tasks.queue.background import Farm
from ..rsibr_addon.tasks.queue.bake_request import request_for
from ..rsibr_addon.tasks.queue.input_bakes import inputs_file
from .at_once import Undoable
from .bake_in_background import chosen_objects, queue_bakes
from .bake_inputs import queue_inputs
from .reporting import can_start


class RSIBR_OT_send_to_farm(Undoable, bpy.types.Operator):
    """Have the farm's machines bake, then shade the selected objects from what they have baked"""  # noqa: D400  (a tooltip)

    bl_idname = "rsibr.send_to_farm"
    bl_label = "Send to Farm"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Whether it can be sent; if not, the button's tooltip says why."""
        return can_start(cls, lambda: _check(context))

    def work(self, context: bpy.types.Context) -> None:
        """Send the bakes; where the same was baked before, its file is taken at once."""
        items, farm = chosen_objects(context), _farm()
        told = [queue_bakes(context.scene, items, farm=farm), *_queue_inputs(context, items, farm)]
        self.report({"INFO"}, "; ".join(told))


def _queue_inputs(context: bpy.types.Context, items: Sequence[bpy.types.Object], farm: Farm) -> Iterator[str]:
    """Have the farm bake what no image says of the objects' own materials, if they will show these."""
    kind, depsgraph = context.scene.rsibr_bake.kind, context.evaluated_depsgraph_get()
    for item in items:
        if not KINDS[kind].own or not getattr(item.rsibr, kind).own:
            continue
        try:
            output = inputs_file(item, depsgraph)
            if output is not None and not is_whole(output):
                queue_inputs(context.scene, item, output, farm)
                yield f"Sending textures of {item.name}"
        except RsibrError as error:
            warn(str(error))


def _check(context: bpy.types.Context) -> None:
    _farm()
    request_for(context.scene.rsibr_bake, context.scene, context.object)


def _farm() -> Farm:
    address = farm_address()
    if not address:
        raise SceneError("No farm is known: give its manager's address in the extension's preferences.")
    check_online()
    return Farm(address, farm_folder())
