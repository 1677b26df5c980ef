"""`rsibr render`: frames of a file as pictures, one JSON result, and what is refused."""

from pathlib import Path

import bpy
import numpy as np
import pytest
from rsibr.rsibr_addon.core.errors import RangeError
from rsibr.rsibr_addon.files.pictures import read_exr
from rsibr.rsibr_addon.settings.render import FramesOptions
from rsibr.rsibr_addon.tasks.light import environments
from rsibr.tests.json_command import json_result
from rsibr.tests.pages import calls

pytestmark = [pytest.mark.needs("gl", "cycles"), pytest.mark.usefixtures("registered")]


@pytest.fixture
def blend(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A file with the factory file's cube, which moves from frame 1 to 48."""
    monkeypatch.setattr(environments, "WORLD_HEIGHT", 16)
    monkeypatch.chdir(tmp_path)
    scene, cube = bpy.context.scene, bpy.data.objects["Cube"]
    scene.rsibr_bake.kernel_pyramid.size = "256"
    scene.render.resolution_x, scene.render.resolution_y, scene.rsibr_render.samples = 32, 18, 1
    scene.render.use_motion_blur = True
    for frame, place in ((1, 0.0), (48, 1.0)):
        cube.location.z = place
        cube.keyframe_insert("location", frame=frame)
    path = tmp_path / "car.blend"
    bpy.ops.wm.save_as_mainfile(filepath=str(path))
    return path


def test_frames_are_files_beside_the_blender_file(blend: Path, capfd: pytest.CaptureFixture[str]) -> None:
    before = blend.read_bytes()
    result = json_result(capfd, "render", str(blend), "--frames", "47-48", "-o", "//frames/a_###.exr")
    paths = [blend.parent / "frames" / f"a_{number}.exr" for number in ("047", "048")]
    assert result["pictures"] == list(map(str, paths))
    assert "RSIBR renders without motion blur, which the scene asks for." in result["warnings"]
    first, last = map(read_exr, paths)
    assert first.shape == last.shape == (18, 32, 3)
    assert (first != last).any()
    assert blend.read_bytes() == before
    again = json_result(capfd, "render", str(blend), "--frames", "48", "-o", "//frames/a_###.exr")
    assert "exists" in again["error"]


def test_frames_have_steps_and_may_be_negative(blend: Path, capfd: pytest.CaptureFixture[str]) -> None:
    result = json_result(capfd, "render", str(blend), "--frames", "-5-4:6", "-o", "##.exr")
    assert result["pictures"] == ["-05.exr", "01.exr"]
    assert all(Path(path).exists() for path in result["pictures"])


@pytest.mark.parametrize(
    ("text", "numbers"),
    [
        ("12", [12]),
        ("-3", [-3]),
        ("1-8:3", [1, 4, 7]),
        ("-5--3", [-5, -4, -3]),
        ("-1-1", [-1, 0, 1]),
        ("-5-10:5", [-5, 0, 5, 10]),
    ],
)
def test_a_text_names_frames(text: str, numbers: list[int]) -> None:
    frames = FramesOptions(frames=text).numbers
    assert frames is not None
    assert list(frames) == numbers


@pytest.mark.parametrize("text", ["", "-", "1-", "3--1", "1-4:0", "1-4:-1", "4:2", "1.5", "-1048575"])
def test_what_names_no_frames_is_refused(text: str) -> None:
    with pytest.raises(RangeError, match=f"Frames cannot be '{text}'"):
        FramesOptions(frames=text)


@pytest.mark.parametrize(
    ("frames", "output", "told"),
    [
        ("1-3", "one.png", "one name for 3 frames: write ####"),
        ("3-1", "####.png", "Frames cannot be '3-1'"),
        ("1-9999999", "####.png", "Frames cannot be '1-9999999'"),
        ("2", "####.jpg", "does not end in .exr or .png"),
    ],
)
def test_what_cannot_be_is_refused(
    blend: Path, frames: str, output: str, told: str, capfd: pytest.CaptureFixture[str]
) -> None:
    result = json_result(capfd, "render", str(blend), "--frames", frames, "-o", output)
    assert told in result["error"]
    assert not list(blend.parent.glob("*.png"))


def test_a_file_without_a_camera_is_told(blend: Path, capfd: pytest.CaptureFixture[str]) -> None:
    bpy.data.objects.remove(bpy.data.objects["Camera"])
    bpy.ops.wm.save_mainfile()
    capfd.readouterr()
    result = json_result(capfd, "render", str(blend), "-o", "one.png")
    assert result["error"].startswith("Scene Scene has no camera")
    assert not Path("one.png").exists()


def test_a_marker_chooses_the_camera(blend: Path, capfd: pytest.CaptureFixture[str]) -> None:
    scene = bpy.context.scene
    scene.timeline_markers.new("Camera", frame=2).camera = scene.camera
    scene.camera = None
    bpy.ops.wm.save_mainfile()
    capfd.readouterr()
    result = json_result(capfd, "render", str(blend), "--frames", "2", "-o", "two.exr")
    assert [Path(path).name for path in result["pictures"]] == ["two.exr"]


def test_stereoscopy_is_left_out_and_said(blend: Path, capfd: pytest.CaptureFixture[str]) -> None:
    bpy.context.scene.render.use_multiview = True
    bpy.ops.wm.save_mainfile()
    capfd.readouterr()
    result = json_result(capfd, "render", str(blend), "-o", "one.exr")
    assert "RSIBR renders without stereoscopy, which the scene asks for." in result["warnings"]
    assert read_exr(Path("one.exr")).shape == (18, 32, 3)


def test_a_scene_that_renders_no_layer_is_refused(blend: Path, capfd: pytest.CaptureFixture[str]) -> None:
    bpy.context.view_layer.use = False
    bpy.ops.wm.save_mainfile()
    capfd.readouterr()
    result = json_result(capfd, "render", str(blend), "-o", "one.png")
    assert result["error"].startswith("Scene Scene renders no view layer: ")


@pytest.mark.slow
def test_the_page_s_commands_do_what_they_say(blend: Path, capfd: pytest.CaptureFixture[str]) -> None:
    first, second = (json_result(capfd, *words) for words in calls("docs/render.md", "rsibr"))
    assert len(first["pictures"]) == 48
    assert all(np.isfinite(read_exr(path)).all() for path in first["pictures"][::20])
    assert [Path(path).name for path in second["pictures"]] == ["car.png"]
