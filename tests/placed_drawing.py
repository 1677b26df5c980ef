"""Meshes in a place of their own, drawn off-screen; and small surfaces that have two sides."""

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from typing import Any

import gpu
import numpy as np
from rsibr.rsibr_addon.core.geometry.camera import Camera
from rsibr.rsibr_addon.core.geometry.directions import normalize
from rsibr.rsibr_addon.device import buffers
from rsibr.rsibr_addon.device.context import ensure_context
from rsibr.rsibr_addon.device.drawing import Draw, GpuMapSet, GpuMesh
from rsibr.rsibr_addon.host.meshes import TriangleMesh

SAMPLES = 4

MIRRORING = np.diag([-1.0, 1.0, 1.0, 1.0])


@contextmanager
def depth_tested(size: int) -> Iterator[gpu.types.GPUFrameBuffer]:
    """A frame buffer of a transparent picture, bound, in which what is nearer hides what is behind."""
    depth = gpu.types.GPUTexture((size, size), format="DEPTH_COMPONENT32F")
    colour = buffers.render_target(size)
    target = gpu.types.GPUFrameBuffer(depth_slot=depth, color_slots=(colour,))
    with target.bind():
        target.clear(color=(0.0, 0.0, 0.0, 0.0), depth=1.0)
        gpu.state.depth_test_set("LESS_EQUAL")
        gpu.state.depth_mask_set(True)
        try:
            yield target
        finally:
            gpu.state.depth_test_set("NONE")
            gpu.state.depth_mask_set(False)


def drawn(
    content: GpuMapSet, mesh: TriangleMesh, model: np.ndarray, camera: Camera, size: int, look: Any
) -> np.ndarray:
    """A picture of a mesh that a matrix places, as `PreviewRenderer.draw` makes it of one in its place."""
    ensure_context()
    fine = size * SAMPLES
    placed = Draw(model, np.linalg.inv(camera.world_from_camera), camera.projection, camera.eye)
    with depth_tested(fine) as target:
        content.draw(GpuMesh(mesh.positions, mesh.normals, mesh.triangles), placed, look)
        pixels = buffers.pixels(target, fine)
    return pixels.reshape(size, SAMPLES, size, SAMPLES, 4).mean(axis=(1, 3))


def grid(u: np.ndarray, v: np.ndarray, positions: np.ndarray, name: str) -> TriangleMesh:
    """A surface over a grid of parameters, with the means of its facets' normals at its vertices."""
    columns = len(u)
    row, column = np.divmod(np.arange((len(v) - 1) * (columns - 1)), columns - 1)
    here = row * columns + column
    above = here + columns
    triangles = np.concatenate(
        [np.stack([here, here + 1, above + 1], axis=-1), np.stack([here, above + 1, above], axis=-1)]
    )
    corners = positions[triangles]
    facets = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals = np.zeros_like(positions)
    for corner in range(3):
        np.add.at(normals, triangles[:, corner], facets)
    return TriangleMesh(
        name, np.float32(positions), np.float32(normalize(normals)), triangles.astype(np.int32)
    )


def leaf(columns: int = 9, rows: int = 7) -> TriangleMesh:
    """A wavy sheet of coarse facets, of which the eye sees both sides."""
    u, v = np.linspace(-1.0, 1.0, columns), np.linspace(-1.0, 1.0, rows)
    x, y = np.meshgrid(0.7 * u, 0.6 * v)
    z = 0.35 * np.sin(3.0 * x) * np.cos(2.0 * y)
    return grid(u, v, np.stack([x, y, z], axis=-1).reshape(-1, 3), "leaf")


def shell(columns: int = 25, rows: int = 9) -> TriangleMesh:
    """The lower half of a ball: from above the eye sees its inside."""
    u, v = np.linspace(0.0, 2.0 * np.pi, columns), np.linspace(0.05, 0.5 * np.pi, rows)
    azimuth, polar = np.meshgrid(u, v)
    direction = np.stack(
        [np.sin(polar) * np.cos(azimuth), np.sin(polar) * np.sin(azimuth), -np.cos(polar)], axis=-1
    ).reshape(-1, 3)
    return replace(grid(u, v, 0.9 * direction, "shell"), normals=np.float32(direction))


def flat(mesh: TriangleMesh) -> TriangleMesh:
    """The same surface with each facet's own normal."""
    corners = mesh.positions[mesh.triangles]
    facets = normalize(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]))
    triangles = np.arange(3 * len(corners), dtype=np.int32).reshape(-1, 3)
    return TriangleMesh(
        f"flat {mesh.name}", corners.reshape(-1, 3), np.float32(np.repeat(facets, 3, axis=0)), triangles
    )


def inside_out(mesh: TriangleMesh) -> TriangleMesh:
    """The same surface, whose inside is the other's outside."""
    return TriangleMesh(mesh.name, mesh.positions, -mesh.normals, mesh.triangles[:, ::-1])


def mirrored(mesh: TriangleMesh) -> TriangleMesh:
    """What `MIRRORING` places where the given mesh is, with its outside outside."""
    turn = np.float32(np.diag(MIRRORING)[:3])
    return TriangleMesh(mesh.name, turn * mesh.positions, turn * mesh.normals, mesh.triangles[:, ::-1])
