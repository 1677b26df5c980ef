"""What several tests of Blender's side need."""

from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager
from pathlib import Path
from typing import Any

import numpy as np
import pytest

WIDTH, HEIGHT = 64, 40
"""Of renders, in pixels."""

Render = Callable[..., dict[str, np.ndarray]]


@pytest.fixture
def stored_bytes() -> Callable[[Path], np.ndarray]:
    """Read what a PNG file holds, shape (height, width, 4), row 0 at the bottom, 0 to 255."""
    import bpy

    def read(path: Path) -> np.ndarray:
        image = bpy.data.images.load(str(path))
        image.colorspace_settings.name = "Non-Color"
        image.alpha_mode = "CHANNEL_PACKED"
        width, height = image.size
        pixels = np.empty(width * height * 4, dtype=np.float32)
        image.pixels.foreach_get(pixels)
        bpy.data.images.remove(image)
        return np.rint(255.0 * pixels).reshape(height, width, 4)

    return read


@pytest.fixture
def files_end_at() -> Callable[[int], AbstractContextManager[None]]:
    """Let no file grow beyond a number of bytes, as on a disk that is almost full."""
    resource = pytest.importorskip("resource")

    @contextmanager
    def limited(size: int) -> Iterator[None]:
        before = resource.getrlimit(resource.RLIMIT_FSIZE)
        resource.setrlimit(resource.RLIMIT_FSIZE, (size, before[1]))
        try:
            yield
        finally:
            resource.setrlimit(resource.RLIMIT_FSIZE, before)

    return limited


@pytest.fixture
def scene(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Any:
    """The factory file's cube in a world of two colours, which is baked small and beside the file."""
    import bpy
    from rsibr.rsibr_addon.tasks.light import environments

    monkeypatch.setattr(environments, "WORLD_HEIGHT", 16)
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "scene.blend"))
    scene = bpy.context.scene
    scene.rsibr_bake.kernel_pyramid.size = "256"
    scene.render.engine = "RSIBR"
    scene.render.resolution_x, scene.render.resolution_y = WIDTH, HEIGHT
    scene.view_settings.view_transform = "Standard"
    scene.world.node_tree.nodes["Background"].inputs["Color"].default_value = (0.2, 0.4, 0.8, 1.0)
    bpy.data.objects.remove(bpy.data.objects["Light"])
    return scene


@pytest.fixture
def render(scene: Any, tmp_path: Path) -> Render:
    """Render a frame, and read its passes: name -> pixels, shape (height, width, channels).

    Of a stereoscopic one, those of the right eye.
    """
    import bpy
    from rsibr.rsibr_addon.files.exr import read_parts

    layer = bpy.context.view_layer
    layer.use_pass_z = layer.use_pass_normal = layer.use_pass_emit = True

    def rendered(engine: str = "RSIBR", samples: int = 1) -> dict[str, np.ndarray]:
        scene.render.engine, scene.rsibr_render.samples = engine, samples
        cycles, settings = scene.cycles, scene.render.image_settings
        cycles.samples, cycles.pixel_filter_type = samples, "BOX"
        cycles.use_adaptive_sampling = cycles.use_denoising = False
        settings.media_type, settings.file_format = "MULTI_LAYER_IMAGE", "OPEN_EXR_MULTILAYER"
        settings.color_depth = "32"
        path = tmp_path / f"{engine}.exr"
        scene.render.filepath = str(path)
        bpy.ops.render.render(write_still=True)
        if scene.render.use_multiview:
            path = tmp_path / f"{engine}_R.exr"
        passes: dict[str, dict[str, np.ndarray]] = {}
        for part in read_parts(path):
            for channel, pixels in part.channels.items():
                _, name, axis = channel.split(".")
                passes.setdefault(name, {})[axis] = pixels
        return {
            name: np.stack([axes[axis] for axis in sorted(axes, key="RGBAXYZ".index)], axis=-1)
            for name, axes in passes.items()
        }

    return rendered


@pytest.fixture
def panel(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Iterator[None]:
    """The registered extension, whose panel bakes into the test's folder."""
    import rsibr

    monkeypatch.setattr("rsibr.rsibr_addon.tasks.queue.bake_request.baked_folder", lambda: tmp_path)
    monkeypatch.setattr("rsibr.rsibr_addon.tasks.light.environments.WORLD_HEIGHT", 16)
    rsibr.register()
    yield
    rsibr.unregister()
