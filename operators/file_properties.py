"""Properties of operators that say which files they work on."""

import bpy


def file_path(name: str, description: str = "File to write") -> str:
    """A property for a path of Blender's; it is asked for anew each time."""
    return bpy.props.StringProperty(
        name=name,
        description=description,
        subtype="FILE_PATH",
        options={"SKIP_SAVE", "PATH_SUPPORTS_BLEND_RELATIVE"},
    )
