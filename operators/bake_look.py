"""Bake the active object's map set as its look shows it."""

from typing import Any

import bpy

from ..rsibr_addon.core.options import declared_options
from ..rsibr_addon.files.kinds.registry import STORED
from ..rsibr_addon.host.plain_settings import apply_settings, plain_settings
from ..rsibr_addon.tasks.queue.bake_request import request_for
from .at_once import Undoable
from .bake_in_background import queue_bake


class RSIBR_OT_bake_look(Undoable, bpy.types.Operator):
    """Bake this object's map set again with the material of its look, where that asks for other tables"""  # noqa: D400  (a tooltip)

    bl_idname = "rsibr.bake_look"
    bl_label = "Bake Look"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Whether the settings of its bake are known."""
        known = context.object is not None and context.object.is_property_set("rsibr_baked")
        if not known:
            cls.poll_message_set("It was not baked here: choose the material below Advanced")
        return known

    def work(self, context: bpy.types.Context) -> None:
        """Choose the settings of the object's bake, with the parts of its look, and queue the bake."""
        scene, item = context.scene, context.object
        kind, settings = item.rsibr_baked.kind, plain_settings(item.rsibr_baked)
        look: Any = getattr(item.rsibr, kind)
        named = [each.name for each in declared_options(STORED[kind].look) if each.option.models]
        settings[kind] |= {name: text for name in named if (text := getattr(look, name))}
        apply_settings(scene.rsibr_bake, settings)
        self.report({"INFO"}, queue_bake(scene, request_for(scene.rsibr_bake, scene, item), [item]))
