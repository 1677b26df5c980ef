"""Bake the scene's world, in whose light the render engine shades all objects."""

import bpy

from ..rsibr_addon.files.map_set import is_whole_map_set
from ..rsibr_addon.session.running import session
from ..rsibr_addon.tasks.queue.world_bakes import world_bake_of, world_file
from . import background
from .at_once import AtOnce


class RSIBR_OT_bake_world(AtOnce, bpy.types.Operator):
    """Bake the light of the scene's world in the background, for the render engine"""  # noqa: D400  (a tooltip)

    bl_idname = "rsibr.bake_world"
    bl_label = "Bake World"

    def work(self, context: bpy.types.Context) -> None:
        """Queue the bake, unless it is there or on its way."""
        output = world_file(context.scene)
        if not is_whole_map_set(output) and session().bakes.unfinished(output) is None:
            background.submit(world_bake_of(context.scene))
