"""Preview every object of the scene in its own materials."""

from collections.abc import Iterator

import bpy

from ..rsibr_addon.core.errors import SceneError
from ..rsibr_addon.host.bake_settings import SHAPED
from ..rsibr_addon.tasks.methods.kinds import own_materials_kind
from ..rsibr_addon.tasks.queue.bake_request import request_for
from .at_once import Undoable
from .bake_in_background import queue_bakes
from .reporting import can_start


class RSIBR_OT_preview_scene(Undoable, bpy.types.Operator):
    """Bake the light in the background, then shade every object of the scene in it, with its own materials"""  # noqa: D400  (a tooltip)

    bl_idname = "rsibr.preview_scene"
    bl_label = "Preview Scene"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Whether the bake can start; if not, the button's tooltip says why."""
        return can_start(cls, lambda: _check(context.scene))

    def work(self, context: bpy.types.Context) -> None:
        """Queue the bake; where the light was baked before, its file is taken at once."""
        items = list(_surfaces(context.scene))
        self.report({"INFO"}, queue_bakes(context.scene, items, own_materials_kind()))


def _surfaces(scene: bpy.types.Scene) -> Iterator[bpy.types.Object]:
    """Objects that can be shaded. What belongs to another file is left as it is."""
    return (each for each in scene.objects if each.type in SHAPED and each.is_editable)


def _check(scene: bpy.types.Scene) -> None:
    item = next(_surfaces(scene), None)
    if item is None:
        raise SceneError("The scene has no object with a surface: add one.")
    request_for(scene.rsibr_bake, scene, item, own_materials_kind())
