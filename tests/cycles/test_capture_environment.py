"""The operator: what the tasks do, from Blender's own interface."""

from pathlib import Path

import bpy
import pytest
from rsibr.rsibr_addon.core.progress import drain
from rsibr.rsibr_addon.settings.environment import SceneLight, WorldLight
from rsibr.rsibr_addon.tasks.light.scene import illuminate_from_scene
from rsibr.rsibr_addon.tasks.light.world import illuminate_from_world
from rsibr.tests.open_file import open_file_state

pytestmark = pytest.mark.usefixtures("registered")


def by_operator(path: Path, **properties: object) -> bytes:
    before = open_file_state()
    given = {"size": 16, "samples": 2, "load_image": False, **properties}
    assert bpy.ops.rsibr.capture_environment(filepath=str(path), **given) == {"FINISHED"}
    assert open_file_state() == before
    return path.read_bytes()


def test_the_operator_writes_what_the_tasks_write(tmp_path: Path) -> None:
    path = tmp_path / "task.exr"
    drain(illuminate_from_scene(SceneLight(size=16, samples=2, subject="Cube"), path))
    assert by_operator(tmp_path / "object.exr") == path.read_bytes()
    bpy.context.scene.cursor.location = (0.0, 0.0, 3.0)
    drain(
        illuminate_from_scene(
            SceneLight(size=16, samples=2, faces=True, denoise=True, seed=3), path, force=True
        )
    )
    settings = {"source": "CURSOR", "faces": True, "denoise": True, "seed": 3}
    assert by_operator(tmp_path / "cursor.exr", **settings) == path.read_bytes()
    drain(illuminate_from_world(WorldLight(size=16), path, force=True))
    assert by_operator(tmp_path / "world.exr", source="WORLD") == path.read_bytes()


def test_the_picture_can_be_loaded(tmp_path: Path) -> None:
    path = tmp_path / "light.exr"
    for size in (16, 32):
        bpy.ops.rsibr.capture_environment(filepath=str(path), size=size, samples=2, force=True)
        (image,) = (image for image in bpy.data.images if image.name == "light.exr")
        assert tuple(image.size) == (size, size // 2)


def test_errors_are_reports(tmp_path: Path) -> None:
    path = tmp_path / "out.exr"
    path.write_text("precious")
    before = open_file_state()
    with pytest.raises(RuntimeError, match=r"out\.exr exists: .*"):
        bpy.ops.rsibr.capture_environment(filepath=str(path))
    with pytest.raises(RuntimeError, match="cannot be 17 texels wide"):
        bpy.ops.rsibr.capture_environment(filepath=str(tmp_path / "new.exr"), size=17)
    assert open_file_state() == before
    bpy.context.view_layer.objects.active = None
    with pytest.raises(RuntimeError, match="There is no object to capture around: select one"):
        bpy.ops.rsibr.capture_environment(filepath=str(tmp_path / "new.exr"))
    assert path.read_text() == "precious"
    assert list(tmp_path.iterdir()) == [path]
