"""Movies: an MP4 that plays, of as many frames, in the colours of the pictures it is made of."""

import time
from collections.abc import Callable
from pathlib import Path

import bpy
import numpy as np
import pytest
from rsibr.rsibr_addon.core.errors import InputFileError, OutputFileError, RangeError
from rsibr.rsibr_addon.host.movies import save_movie
from rsibr.rsibr_addon.host.pictures import save_png

COLOURS = ((0.18, 0.18, 0.18), (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0), (0.5, 0.25, 0.1))


def frames_of(folder: Path, width: int = 64, height: int = 48) -> list[Path]:
    """One picture a colour: the lower left quarter is transparent, the rest that colour."""
    paths = [folder / f"frame{number}.png" for number in range(len(COLOURS))]
    for path, colour in zip(paths, COLOURS, strict=True):
        rgba = np.ones((height, width, 4), dtype=np.float32)
        rgba[..., :3] = colour
        rgba[: height // 2, : width // 2] = 0.0
        save_png(path, rgba)
    return paths


def decode(movie: Path, count: int) -> list[Path]:
    """Have Blender read a movie and write its frames as PNG."""
    image = bpy.data.images.load(str(movie))
    scene = bpy.data.scenes.new("player")
    scene.view_settings.view_transform = "Standard"
    scene.sequence_editor_create().strips.new_movie("movie", str(movie), channel=1, frame_start=1)
    scene.frame_start, scene.frame_end = 1, count
    render = scene.render
    render.resolution_x, render.resolution_y = image.size
    render.dither_intensity = 0.0
    render.image_settings.media_type, render.image_settings.file_format = "IMAGE", "PNG"
    render.filepath = str(movie.with_name("decoded_####.png"))
    bpy.ops.render.render(animation=True, scene=scene.name)
    return [movie.with_name(f"decoded_{number:04d}.png") for number in range(1, count + 1)]


def test_a_movie_shows_its_pictures(tmp_path: Path, stored_bytes: Callable) -> None:
    movie = tmp_path / "turn.mp4"
    frames = frames_of(tmp_path)
    save_movie(movie, frames, frames_per_second=12)
    head = movie.read_bytes()
    assert head[4:8] == b"ftyp"
    assert b"avc1" in head  # H.264

    clip = bpy.data.movieclips.load(str(movie))
    assert clip.frame_duration == len(COLOURS)
    assert clip.fps == 12.0
    assert tuple(clip.size) == (64, 48)
    for frame, picture in zip(frames, decode(movie, len(COLOURS)), strict=True):
        decoded = stored_bytes(picture)[..., :3]
        # 8-bit Y'CbCr in limited range: a step of luma is 1.16 of 255, a step of chroma up to 2.1.
        # One step off in each, and the encoder's quantiser doubling that, is under 7; areas are flat.
        shown = stored_bytes(frame)[36:, 40:, :3]
        assert np.abs(decoded[36:, 40:] - shown).max() < 7.0
        assert decoded[4:20, 4:28].max() < 7.0  # transparent became black; bottom left stayed there


def test_the_blender_file_is_left_alone(tmp_path: Path) -> None:
    frames = frames_of(tmp_path)
    before = {name: [*getattr(bpy.data, name).keys()] for name in ("scenes", "images", "objects", "texts")}
    save_movie(tmp_path / "turn.mp4", frames)
    for name, items in before.items():
        assert [*getattr(bpy.data, name).keys()] == items


def test_any_folder_will_do(tmp_path: Path) -> None:
    folder = tmp_path / "50% {blend} #1"
    folder.mkdir()
    save_movie(folder / "turn.tmp", frames_of(folder))
    assert (folder / "turn.tmp").read_bytes()[4:8] == b"ftyp"


def test_an_odd_size_is_refused(tmp_path: Path) -> None:
    with pytest.raises(RangeError, match="63x48 pixels cannot be encoded: choose an even size"):
        save_movie(tmp_path / "turn.mp4", frames_of(tmp_path, width=63))
    assert not (tmp_path / "turn.mp4").exists()


def test_a_missing_picture_is_reported(tmp_path: Path) -> None:
    frames = frames_of(tmp_path)
    frames[2].unlink()
    with pytest.raises(InputFileError, match=r"frame2\.png is missing"):
        save_movie(tmp_path / "turn.mp4", frames)


def test_a_full_disk_is_reported(tmp_path: Path, files_end_at: Callable) -> None:
    frames = frames_of(tmp_path)
    with files_end_at(1500), pytest.raises(OutputFileError, match="disk with the temporary files is full"):
        save_movie(tmp_path / "turn.mp4", frames)
    assert not (tmp_path / "turn.mp4").exists()


def test_the_same_pictures_make_the_same_bytes(tmp_path: Path) -> None:
    frames = frames_of(tmp_path)
    first, second = tmp_path / "first.mp4", tmp_path / "second.mp4"
    save_movie(first, frames)
    made = first.stat().st_mtime
    while time.time() < made + 1.5:  # a date has whole seconds
        time.sleep(0.1)
    save_movie(second, frames)
    assert first.read_bytes() == second.read_bytes()
