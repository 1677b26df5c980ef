"""What operators share that make a picture of light from pictures chosen in the file browser."""

from pathlib import Path

import bpy

from ..rsibr_addon.core.errors import InputFileError
from .file_properties import file_path
from .makes_light import MakesLight


class FromPictures(MakesLight):
    """Base of an operator that makes a picture of light; `work` returns its path."""

    filepath = file_path("Picture", "Picture to work on")
    filter_image = bpy.props.BoolProperty(default=True, options={"HIDDEN", "SKIP_SAVE"})
    filter_folder = bpy.props.BoolProperty(default=True, options={"HIDDEN", "SKIP_SAVE"})
    output = bpy.props.StringProperty(
        name="Output",
        description="File to write, OpenEXR or Radiance HDR by its name, in the folder of what it is made "
        "from unless it names another; empty for that one's name with -light.exr",
        options={"SKIP_SAVE"},
    )

    def source(self) -> Path:
        """The picture that was chosen.

        Raises
        ------
        InputFileError
            None was.
        """
        if not self.filepath:
            raise InputFileError("No picture is chosen: select one.")
        return Path(bpy.path.abspath(self.filepath))

    def target(self, source: Path) -> Path:
        """Where to write what is made from a picture."""
        if not self.output:
            return source.with_name(f"{source.stem}-light.exr")
        return source.parent / bpy.path.abspath(self.output)


class FromSeveralPictures(FromPictures):
    """The same, from one picture or several of a folder."""

    directory = bpy.props.StringProperty(
        name="Folder",
        description="Folder of the pictures",
        subtype="DIR_PATH",
        options={"HIDDEN", "SKIP_SAVE", "PATH_SUPPORTS_BLEND_RELATIVE"},
    )
    files = bpy.props.CollectionProperty(
        name="Pictures",
        description="Names of pictures in the folder; empty for the one picture that the path gives",
        type=bpy.types.OperatorFileListElement,
        options={"HIDDEN", "SKIP_SAVE"},
    )

    def sources(self) -> tuple[Path, ...]:
        """The pictures that were chosen, in their order.

        Raises
        ------
        InputFileError
            None was.
        """
        folder = Path(bpy.path.abspath(self.directory))
        # With no file selected, the browser gives one without a name
        return tuple(folder / file.name for file in self.files if file.name) or (self.source(),)
