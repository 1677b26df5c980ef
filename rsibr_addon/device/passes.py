"""Passes over a target: one triangle that covers it, whatever state Blender had set."""

from collections.abc import Iterator
from contextlib import contextmanager

import gpu
import numpy as np

from . import buffers

_TRIANGLE = np.array([[-1.0, -1.0], [3.0, -1.0], [-1.0, 3.0]])


def screen_triangle(shader: gpu.types.GPUShader) -> gpu.types.GPUBatch:
    """A triangle that covers the viewport, for a program with screen_vert.glsl."""
    return buffers.triangles(shader, {"position": _TRIANGLE}, np.array([[0, 1, 2]]))


@contextmanager
def plain_state() -> Iterator[None]:
    """Within, drawing replaces the target's content, whatever state Blender had set."""
    depth_test, blend = gpu.state.depth_test_get(), gpu.state.blend_get()
    gpu.state.depth_test_set("NONE")
    gpu.state.blend_set("NONE")
    try:
        yield
    finally:
        gpu.state.depth_test_set(depth_test)
        gpu.state.blend_set(blend)
