"""What the panel asks for of the open file."""

from pathlib import Path

import bpy
from rsibr.rsibr_addon.tasks.queue.bake_request import (
    BakeRequest,
    output_for,
    request_for,
)


def order() -> BakeRequest:
    return request_for(bpy.context.scene.rsibr_bake, bpy.context.scene, bpy.context.object)


def output() -> Path:
    return output_for(order(), bpy.context.scene, bpy.context.object)
