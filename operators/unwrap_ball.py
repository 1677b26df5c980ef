"""Unwrap photographs of a mirrored ball into an environment."""

import math
from collections.abc import Sequence
from pathlib import Path

import bpy

from ..rsibr_addon.core.errors import RangeError
from ..rsibr_addon.core.progress import Steps
from ..rsibr_addon.tasks.light.ball import BallSettings, SideSettings, illuminate_from_ball
from ..rsibr_addon.tasks.light.brackets import BracketSettings
from .from_pictures import EnvironmentSize, FromSeveralPictures


def _circle(name: str) -> Sequence[float]:
    return bpy.props.FloatVectorProperty(
        name=name,
        description="Middle and radius of the ball's outline in pixels from the top left corner of the "
        "photograph as Blender shows it; radius 0 to find it",
        options={"SKIP_SAVE"},
    )


class RSIBR_OT_unwrap_ball(FromSeveralPictures, EnvironmentSize, bpy.types.Operator):
    """Make an environment from a photograph of a mirrored ball, or two from two sides; merge exposures before"""  # noqa: D400, E501  (a tooltip)

    bl_idname = "rsibr.unwrap_ball"
    bl_label = "Unwrap Mirror Ball"
    bl_options = {"REGISTER", "UNDO"}  # noqa: RUF012  (Blender reads the class)

    circle = _circle("Circle")
    distance = bpy.props.FloatProperty(
        name="Distance", description="Of the camera in radii of the ball; 0 for far away", min=0.0
    )
    field_of_view = bpy.props.FloatProperty(
        name="Field of View",
        description="That the longer side of the photographs shows, not cropped, which tells the distance; 0 "
        "if not known",
        subtype="ANGLE",
        min=0.0,
        max=math.radians(179.0),
    )
    elevation = bpy.props.FloatProperty(
        name="Elevation", description="How far the camera looked down on the ball", subtype="ANGLE"
    )
    camera = bpy.props.FloatProperty(
        name="Camera",
        description="How far from its middle the camera and who held it show in the ball, as an angle of "
        "direction; there the other side counts",
        subtype="ANGLE",
        default=math.radians(15.0),
        min=0.0,
    )
    turn = bpy.props.FloatProperty(
        name="Turn",
        description="How far the camera went around the ball for the second photograph, counterclockwise as "
        "seen from above",
        subtype="ANGLE",
        default=math.radians(90.0),
    )
    second_circle = _circle("Second Circle")

    def work(self, context: bpy.types.Context) -> Steps[Path]:
        """Unwrap, and say where the balls are."""
        sides = self._sides()
        output = self.target(sides[0].bracket.photographs[0])
        if self.distance and self.field_of_view:
            raise RangeError("Distance and field of view both tell where the camera was: set one to 0.")
        settings = BallSettings(
            sides, self.size, self.distance or None, self.field_of_view or None, self.elevation, self.camera
        )
        found = yield from illuminate_from_ball(settings, output, self.force)
        for path, (x, y, radius) in found.circles:
            self.report({"INFO"}, f"{path}: ball {x:.1f},{y:.1f},{radius:.1f}")
        return output

    def _sides(self) -> tuple[SideSettings, ...]:
        photographs = self.sources()
        if len(photographs) > 2:
            raise RangeError(
                f"There are {len(photographs)} photographs of the ball: select one or two, and merge "
                f"exposures before."
            )
        circles, turns = (self.circle, self.second_circle), (0.0, self.turn)
        return tuple(
            SideSettings(BracketSettings((path,)), (x, y, radius) if radius else None, turn)
            for path, (x, y, radius), turn in zip(photographs, circles, turns, strict=False)
        )
