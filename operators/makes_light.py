"""What operators share that make a picture of light."""

from pathlib import Path

import bpy

from ..rsibr_addon.files.radiance_pictures import describe_radiance
from ..rsibr_addon.host.map_sets import stored_path
from .stepwise import Stepwise


class MakesLight(Stepwise):
    """Base of an operator whose `work` returns the path of a picture of light."""

    bl_options = {"REGISTER", "UNDO"}  # noqa: RUF012  (Blender reads the class)
    interrupted = "Interrupted; nothing was written"

    load_image = bpy.props.BoolProperty(
        name="Load", description="Load the picture into this file afterwards", default=True
    )
    use = bpy.props.BoolProperty(
        name="Use", description="Bake with this light from now on", options={"SKIP_SAVE"}
    )

    def finish(self, result: Path) -> None:
        """Load the picture and choose it as the light to bake with if asked to, and say where it is."""
        if self.load_image:
            bpy.data.images.load(str(result), check_existing=True).reload()
        if self.use:
            chosen = bpy.context.scene.rsibr_bake
            chosen.light, chosen.picture = "PICTURE", stored_path(result)
        scale = describe_radiance(result).comments
        self.report({"INFO"}, f"Wrote {result}. {scale}".rstrip())
