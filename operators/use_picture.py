"""What becomes of a picture of light once it is written."""

from pathlib import Path

import bpy

from ..rsibr_addon.host.map_sets import stored_path


def take_picture(path: Path, load: bool, use: bool) -> None:
    """Load a picture into the open file, and choose it as the light to bake with if asked to."""
    if load:
        bpy.data.images.load(str(path), check_existing=True).reload()
    if use:
        chosen = bpy.context.scene.rsibr_bake
        chosen.light, chosen.picture = "PICTURE", stored_path(path)
