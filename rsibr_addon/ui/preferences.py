"""What a user sets once for all files."""

import bpy

from ..core.options import declared_options
from ..host.option_properties import group_of, properties_of
from ..host.preferences import EXTENSION, FOLDER
from ..settings.baked_inputs import BakedInputsSettings

INPUTS_GROUP = group_of(
    "RSIBR_PG_inputs", "How materials' inputs are baked.", properties_of(BakedInputsSettings)
)


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
    bake_inputs = bpy.props.BoolProperty(
        name="Bake Materials by Itself",
        description="Bake what no image says of previewed materials, such as procedural textures, in the "
        "background, a second after the last edit",
        default=True,
    )
    farm_manager = bpy.props.StringProperty(
        name="Flamenco Manager",
        description="Address of the manager of a farm in the local network, such as http://192.168.0.10:8080",
    )
    farm_folder = bpy.props.StringProperty(
        name="Shared Folder",
        description="The farm's shared storage, by its path on this machine; empty for the one that the "
        "manager says",
        subtype="DIR_PATH",
    )
    inputs = bpy.props.PointerProperty(type=INPUTS_GROUP)

    def draw(self, context: bpy.types.Context) -> None:
        """Show it."""
        self.layout.use_property_split = True
        self.layout.prop(self, "folder")
        self.layout.prop(self, "bake_inputs")
        for declared in declared_options(BakedInputsSettings):
            self.layout.prop(self.inputs, declared.name)
        self.layout.prop(self, "farm_manager")
        self.layout.prop(self, "farm_folder")
