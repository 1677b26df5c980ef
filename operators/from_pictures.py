"""What operators share that make a picture of light from pictures chosen in the file browser."""

from pathlib import Path

import bpy

from ..rsibr_addon.core.errors import InputFileError
from ..rsibr_addon.tasks.light.scene import LARGEST, SMALLEST
from .file_properties import file_path
from .stepwise import Stepwise
from .use_picture import take_picture


class FromPictures(Stepwise):
    """Of a picture of light; `work` is to return its path."""

    filepath = file_path("Picture", "Picture to work on")
    filter_image = bpy.props.BoolProperty(default=True, options={"HIDDEN", "SKIP_SAVE"})
    filter_folder = bpy.props.BoolProperty(default=True, options={"HIDDEN", "SKIP_SAVE"})
    output = bpy.props.StringProperty(
        name="Output",
        description="File to write, OpenEXR or Radiance HDR by its name, in the folder of what it is made "
        "from unless it names another; empty for that one's name with -light.exr",
        options={"SKIP_SAVE"},
    )
    load_image = bpy.props.BoolProperty(
        name="Load", description="Load the result into this file afterwards", default=True
    )
    use = bpy.props.BoolProperty(
        name="Use", description="Bake with this light from now on", options={"SKIP_SAVE"}
    )

    interrupted = "Interrupted; nothing was written"

    def finish(self, result: Path) -> None:
        """Load the picture and choose it if asked to, and say where it is."""
        take_picture(result, self.load_image, self.use)
        self.report({"INFO"}, f"Wrote {result}")

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
        description="Of the pictures",
        subtype="DIR_PATH",
        options={"HIDDEN", "SKIP_SAVE", "PATH_SUPPORTS_BLEND_RELATIVE"},
    )
    files = bpy.props.CollectionProperty(
        name="Pictures",
        description="Names in the folder; none for the one picture that is given by its path",
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
        # A browser in which no file is selected gives one without a name
        return tuple(folder / file.name for file in self.files if file.name) or (self.source(),)


class EnvironmentSize:
    """Of operators whose result is a latitude-longitude map."""

    size = bpy.props.IntProperty(
        name="Size",
        description="Width of the environment in texels, even; it is half as high",
        default=1024,
        min=SMALLEST,
        max=LARGEST,
        step=2,
    )
