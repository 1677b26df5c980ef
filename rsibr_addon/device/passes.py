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


def screen_interface() -> gpu.types.GPUShaderCreateInfo:
    """The interface of programs with screen_vert.glsl, to be completed with what they read and write."""
    info = gpu.types.GPUShaderCreateInfo()
    info.vertex_in(0, "VEC2", "position")
    varyings = gpu.types.GPUStageInterfaceInfo("rsibr_screen")
    varyings.smooth("VEC2", "map_uv")
    info.vertex_out(varyings)
    return info


@contextmanager
def plain_state() -> Iterator[None]:
    """Within, drawing replaces the target's content, whatever state Blender had set."""
    with blended("NONE"):
        yield


@contextmanager
def blended(blending: str) -> Iterator[None]:
    """Within, all that is drawn is blended with the target's content, whatever lies in front there.

    Parameters
    ----------
    blending : str
        As `gpu.state.blend_set` takes it.
    """
    depth_test, blend = gpu.state.depth_test_get(), gpu.state.blend_get()
    gpu.state.depth_test_set("NONE")
    gpu.state.blend_set(blending)
    try:
        yield
    finally:
        gpu.state.depth_test_set(depth_test)
        gpu.state.blend_set(blend)
