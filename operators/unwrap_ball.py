"""Unwrap photographs of a mirrored ball into an environment."""

from pathlib import Path

import bpy

from ..rsibr_addon.core.errors import RangeError
from ..rsibr_addon.core.progress import Steps
from ..rsibr_addon.host.option_properties import options_of
from ..rsibr_addon.settings.photographs import BallSettings
from ..rsibr_addon.tasks.light.ball import illuminate_from_ball
from .from_pictures import FromSeveralPictures


class RSIBR_OT_unwrap_ball(FromSeveralPictures, bpy.types.Operator):
    """Make an environment from one photograph of a mirrored ball, or from two sides of it. Merge exposures first"""  # noqa: D400, E501  (a tooltip)

    bl_idname = "rsibr.unwrap_ball"
    bl_label = "Unwrap Mirror Ball"
    SETTINGS = BallSettings

    def work(self, context: bpy.types.Context) -> Steps[Path]:
        """Unwrap, and say where the balls are."""
        photographs = self.sources()
        if len(photographs) > 2:
            raise RangeError(
                f"There are {len(photographs)} photographs of the ball: select one or two, and merge "
                f"exposures before."
            )
        output = self.target(photographs[0])
        sides = [(path,) for path in photographs]
        found = yield from illuminate_from_ball(sides, options_of(BallSettings, self), output, self.force)
        for path, (x, y, radius) in found.circles:
            self.report({"INFO"}, f"{path}: ball {x:.1f},{y:.1f},{radius:.1f}")
        return output
