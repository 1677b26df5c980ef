"""What the Result panel shows; no file keeps it."""

import math

import bpy

from ..session.map_pictures import Item
from ..session.running import session


def _items(group: bpy.types.PropertyGroup, context: bpy.types.Context | None) -> list[Item]:
    return session().map_pictures.items


def _number(group: "RSIBR_PG_result") -> int:
    """Another map set may have fewer maps."""
    return min(group.number, len(session().map_pictures.items) - 1)


def _set_number(group: "RSIBR_PG_result", number: int) -> None:
    group.number = number


class RSIBR_PG_result(bpy.types.PropertyGroup):
    """Which map, and the lobes from where."""

    number = bpy.props.IntProperty(options={"HIDDEN"})
    part = bpy.props.EnumProperty(
        name="Map", description="Which map is shown", items=_items, get=_number, set=_set_number
    )
    angle = bpy.props.FloatProperty(
        name="View",
        description="Angle between the surface's normal and the eye, for which the lobes are drawn",
        subtype="ANGLE",
        min=0.0,
        max=math.radians(89.0),
        default=math.radians(60.0),
    )


CLASSES = (RSIBR_PG_result,)
"""In the order of registration."""

POINTERS = {"rsibr_result": (bpy.types.WindowManager, RSIBR_PG_result)}
"""Name of a property -> what has it, and the group it points to."""
