"""What a user sets once for all files."""

import bpy

from ..host.bake_settings import EXTENSION, FOLDER


class RSIBR_AP_preferences(bpy.types.AddonPreferences):
    """Where files go."""

    bl_idname = EXTENSION

    folder = bpy.props.StringProperty(
        name="Baked Files",
        description="Folder for baked map sets; // is the folder of the open file. Files that are not saved "
        "yet use a folder of the user",
        subtype="DIR_PATH",
        options={"PATH_SUPPORTS_BLEND_RELATIVE"},
        default=FOLDER,
    )

    def draw(self, context: bpy.types.Context) -> None:
        """Show it."""
        self.layout.use_property_split = True
        self.layout.prop(self, "folder")
