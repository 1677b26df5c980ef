"""Movies of pictures, encoded by Blender."""

import shutil
from collections.abc import Sequence
from pathlib import Path

import bpy

from ..core.errors import InputFileError, RangeError, RenderError
from ..files.temporary import temporary_folder
from .scenes import temporary_scene


def save_movie(path: Path, frames: Sequence[Path], frames_per_second: int = 24) -> None:
    """Write pictures as an MP4 movie (H.264).

    Parameters
    ----------
    path : Path
        Written as it is, replaced if it exists.
    frames : sequence of Path
        sRGB pictures of one even width and height in one folder, in the order shown. Transparent pixels
        become black: the movie has no alpha.
    frames_per_second : int

    Raises
    ------
    InputFileError
        A picture is missing.
    RangeError
        The pictures' width or height is odd, which H.264 does not allow.
    RenderError
        Blender cannot encode the movie.

    Notes
    -----
    The sequencer of a separate scene shows the pictures unchanged: the view transform "Standard" undoes the
    decoding of an sRGB picture. Blender encodes into a temporary folder, because it reads braces in a path as
    a template.
    """
    for frame in frames:
        if not frame.is_file():  # on which Blender's sequencer may crash
            raise InputFileError(f"The movie's picture {frame} is missing: draw it again.")
    with temporary_folder() as folder, temporary_scene() as scene:
        strip = scene.sequence_editor_create().strips.new_image(
            "frames", str(frames[0].resolve()), channel=1, frame_start=1, fit_method="ORIGINAL"
        )
        for frame in frames[1:]:
            strip.elements.append(frame.name)
        strip.duration = len(frames)
        width, height = strip.elements[0].orig_width, strip.elements[0].orig_height
        if width % 2 or height % 2:
            raise RangeError(f"A movie of {width}x{height} pixels cannot be encoded: choose an even size.")
        scene.frame_start, scene.frame_end = 1, len(frames)
        movie = folder / "movie.mp4"
        scene.view_settings.view_transform = "Standard"
        _encode_h264(scene.render, width, height, frames_per_second)
        scene.render.filepath = str(movie)
        try:
            bpy.ops.render.render(animation=True, scene=scene.name)
        except RuntimeError as error:
            raise RenderError(f"Blender cannot encode the movie {path.name}: {error}") from error
        if not _is_whole(movie.read_bytes()):  # Blender does not report this
            raise RenderError(f"Blender did not finish the movie {path.name}: draw it again.")
        shutil.move(movie, path)


def _encode_h264(render: bpy.types.RenderSettings, width: int, height: int, frames_per_second: int) -> None:
    render.resolution_x, render.resolution_y, render.resolution_percentage = width, height, 100
    render.fps, render.fps_base = frames_per_second, 1.0
    render.use_file_extension = False
    render.dither_intensity = 0.0
    # The same pictures make the same bytes
    for stamp in ("date", "time", "render_time", "filename", "memory", "hostname"):
        setattr(render, f"use_stamp_{stamp}", False)
    render.image_settings.media_type = "VIDEO"
    render.image_settings.color_mode = "RGB"
    render.ffmpeg.format, render.ffmpeg.codec = "MPEG4", "H264"
    render.ffmpeg.constant_rate_factor = "PERC_LOSSLESS"
    render.ffmpeg.audio_codec = "NONE"


def _is_whole(movie: bytes) -> bool:
    """Whether an MP4's index is there to its end: the encoder writes it last."""
    start = movie.rfind(b"moov") - 4
    return start >= 0 and start + int.from_bytes(movie[start : start + 4]) == len(movie)
