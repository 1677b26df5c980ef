"""Frames of a Blender file, rendered into files."""

import re
from pathlib import Path

from ...core.errors import OutputFileError, SceneError
from ...core.progress import Progress, Steps
from ...core.warned import recorded_warnings, warn
from ...device.context import ensure_context
from ...files.atomic import check_target, written_aside
from ...files.outputs import make_folder
from ...host.blend_files import open_blend
from ...host.preferences import enable_extension
from ...host.render_views import checked_camera, without
from ...host.rendering import render_frame
from ...host.scenes import find_scene
from ...host.visible_surfaces import RENDER_ENGINE
from ...settings.render import FramesOptions
from .missing_bakes import bake_for_render

FORMATS = {".exr": "OPEN_EXR", ".png": "PNG"}
"""Ending -> Blender's name of a format."""

BESIDE = "//"
"""How Blender writes the folder of the file that is open."""


def render_frames(
    blend: Path, settings: FramesOptions, output: str, force: bool = False
) -> Steps[list[Path]]:
    """Render frames by the engine RSIBR, each into a file of its own.

    Parameters
    ----------
    blend : Path
        The file, whose active scene and camera are rendered. It stays as it is.
    settings : FramesOptions
    output : str
        NAME.exr for linear radiance as 32-bit floats, or NAME.png as the scene's view transform shows it; #
        stands for a digit of the frame, as in ####.exr, and // in front for the folder of the Blender file.
        Folders are made.
    force : bool
        Whether existing files are replaced.

    Returns
    -------
    list of Path

    Raises
    ------
    OutputFileError
        Several frames have one name, or a file exists or cannot be written.
    InputFileError, SceneError, RenderError
        The file cannot be read, or not be rendered.
    DeviceError
        There is no graphics driver.

    Warns
    -----
    RsibrWarning
        Of what a picture leaves out.
    """
    yield Progress(0, 1, f"opening {blend.name}")
    enable_extension()
    open_blend(blend)
    scene = find_scene(None)
    scene.render.engine = RENDER_ENGINE
    numbers = settings.numbers or range(scene.frame_current, scene.frame_current + 1)
    scene.frame_set(numbers[0])  # a marker may choose the camera
    checked_camera(scene, scene.camera)
    if not any(layer.use for layer in scene.view_layers):
        raise SceneError(f"Scene {scene.name} renders no view layer: switch Use for Rendering on for one.")
    if scene.render.use_multiview:
        warn(without("stereoscopy"))
    ensure_context()
    paths = [_path(output, blend, number) for number in numbers]
    if len(set(paths)) < len(paths):
        raise OutputFileError(
            f"{output} is one name for {len(paths)} frames: write #### where the number goes."
        )
    for path in paths:
        make_folder(path.parent)
        check_target(path, force, tuple(FORMATS))
    yield from bake_for_render(scene)
    for done, (number, path) in enumerate(zip(numbers, paths, strict=True)):
        yield Progress(done, len(paths), f"rendering frame {number}")
        with written_aside(path, force) as aside, recorded_warnings() as warnings:
            render_frame(scene, number, FORMATS[path.suffix.lower()], aside, settings.samples)
        for warning in warnings:
            warn(warning)
    return paths


def _path(output: str, blend: Path, number: int) -> Path:
    """The file of a frame; a minus is beside its digits, as Blender writes it."""
    minus = "-" if number < 0 else ""
    told = re.sub("#+", lambda digits: f"{minus}{abs(number):0{len(digits[0])}d}", output)
    beside = blend.resolve().parent
    return beside / told.removeprefix(BESIDE) if told.startswith(BESIDE) else Path(told)
