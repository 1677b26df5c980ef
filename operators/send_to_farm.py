"""Have a farm bake, then shade the selected objects from what it has baked."""

import bpy

from ..rsibr_addon.core.errors import SceneError
from ..rsibr_addon.host.bake_settings import check_online, farm_address, farm_folder
from ..rsibr_addon.tasks.queue.background import Farm
from ..rsibr_addon.tasks.queue.bake_request import request_for
from .at_once import Undoable
from .bake_in_background import chosen_objects, queue_bakes
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
        self.report({"INFO"}, queue_bakes(context.scene, chosen_objects(context), farm=_farm()))


def _check(context: bpy.types.Context) -> None:
    _farm()
    request_for(context.scene.rsibr_bake, context.scene, context.object)


def _farm() -> Farm:
    address = farm_address()
    if not address:
        raise SceneError("No farm is known: give its manager's address in the add-on's preferences.")
    check_online()
    return Farm(address, farm_folder())
