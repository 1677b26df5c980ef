"""Put an environment together from six photographs."""

from pathlib import Path

import bpy

from ..rsibr_addon.core.progress import Steps
from ..rsibr_addon.files.map_pictures import layout
from ..rsibr_addon.host.option_properties import options_of
from ..rsibr_addon.settings.environment import FacesSettings
from ..rsibr_addon.tasks.light.faces import illuminate_from_faces
from .from_pictures import FromPictures


class RSIBR_OT_assemble_faces(FromPictures, bpy.types.Operator):
    """Make an environment from six square photographs along the axes, NAME-px and -nx, -py, -ny, -pz, -nz; select one of them"""  # noqa: D400, E501  (a tooltip)

    bl_idname = "rsibr.assemble_faces"
    bl_label = "Assemble Faces"
    SETTINGS = FacesSettings

    def work(self, context: bpy.types.Context) -> Steps[Path]:
        """Put them together."""
        source = layout("cube_faces").whole(self.source())
        output = self.target(source)
        yield from illuminate_from_faces(source, options_of(FacesSettings, self), output, self.force)
        return output
