"""What several tests of Blender's side need."""

from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager
from pathlib import Path

import numpy as np
import pytest


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
