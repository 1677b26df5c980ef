"""Bake anew what is out of date."""

import bpy

from ..rsibr_addon.core.warned import warn
from ..rsibr_addon.session.running import session
from .at_once import Undoable
from .bake_in_background import queue_bake


class RSIBR_OT_rebake(Undoable, bpy.types.Operator):
    """Bake anew, with the settings of each object's bake, all objects of the scene that are out of date"""  # noqa: D400  (a tooltip)

    bl_idname = "rsibr.rebake"
    bl_label = "Rebake"

    def work(self, context: bpy.types.Context) -> None:
        """Queue the bakes."""
        freshness = session().freshness
        freshness.look([context.scene])
        reasons = [each.reason for each in freshness.stale.values() if each and each.output is None]
        for reason in dict.fromkeys(reasons):
            warn(f"Not all can be baked anew. {reason}")
        done = [
            queue_bake(context.scene, stale.request, items)
            for stale, items in freshness.wanted(context.scene)
            if stale.request is not None
        ]
        if done:
            self.report({"INFO"}, "; ".join(done))
        elif not any(freshness.stale.values()):
            self.report({"INFO"}, "Everything is up to date")
