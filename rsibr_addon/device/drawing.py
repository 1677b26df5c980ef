"""What every kind of map set has in common on the GPU: an upload, drawn on a mesh as its look says."""

from dataclasses import dataclass, field
from typing import Any, Protocol

import gpu
import numpy as np

from ..core.conventions import Array
from . import buffers, shaders


@dataclass(frozen=True)
class Draw:
    """Where a mesh stands and from where it is seen; matrices of shape (4, 4) for column vectors.

    Attributes
    ----------
    model, view, projection : ndarray, shape (4, 4)
    eye : ndarray, shape (4,)
        Homogeneous position of the eye in world space, as `core.camera.Camera.eye`.
    view_dir : ndarray, shape (3,)
        Unit vector from the object to the eye: the view that destination maps are made for.
    turn : ndarray, shape (3, 3)
        Rotation from the world to that of the map set, for a world that has been turned since. It is for
        shading alone: position, normal and `eye` are turned by it, `view_dir` has been.
    """

    model: Array
    view: Array
    projection: Array
    eye: Array
    view_dir: Array
    turn: Array = field(default_factory=lambda: np.eye(3))

    def uniforms(self) -> gpu.types.GPUUniformBuf:
        """The block `Draw` of the shaders."""
        normal_matrix, turn = np.eye(4), np.eye(4)
        normal_matrix[:3, :3] = self.turn @ np.linalg.inv(self.model[:3, :3]).T
        turn[:3, :3] = self.turn
        return buffers.uniform_block(
            self.model, normal_matrix, self.view, self.projection, turn, turn @ self.eye
        )


class OnDevice(Protocol):
    """What a map set holds, uploaded."""

    def draw(self, mesh: gpu.types.GPUBatch, draw: Draw, look: Any) -> None:
        """Draw a mesh into the active frame buffer, with the depth test as it is set.

        Parameters
        ----------
        mesh : GPUBatch
            See `mesh_batch`.
        draw : Draw
        look : object
            The look of this kind of map set: see `core.shading`.
        """


def mesh_batch(positions: Array, normals: Array, triangles: Array) -> gpu.types.GPUBatch:
    """Upload a mesh for `OnDevice.draw`.

    Parameters
    ----------
    positions, normals : ndarray, shape (V, 3)
    triangles : ndarray of int, shape (F, 3)

    Returns
    -------
    GPUBatch
        With attributes `position` and `normal`, as every program that draws meshes has them.
    """
    attributes = {"position": positions, "normal": normals}
    return buffers.triangles(shaders.views_fragment_shader(), attributes, triangles)
