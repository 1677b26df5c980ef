"""What every kind of map set has in common on the GPU: an upload, drawn on a mesh as its look says."""

from copy import copy
from dataclasses import dataclass, field
from typing import Any, Protocol

import gpu
import numpy as np

from ..core.conventions import Array, Indices
from . import buffers, shaders


@dataclass(frozen=True)
class Draw:
    """Where a mesh stands and from where it is seen; matrices of shape (4, 4) for column vectors.

    Attributes
    ----------
    model, view, projection : ndarray, shape (4, 4)
    eye : ndarray, shape (4,)
        Homogeneous position of the eye in world space, as `core.geometry.camera.Camera.eye`.
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

    def fields(self) -> tuple[Array, ...]:
        """The block `Draw` of the shaders, as `buffers.KeptBlock` takes it."""
        turn = np.eye(4)
        turn[:3, :3] = self.turn
        return self.model, self.view, self.projection, turn, turn @ self.eye


class MeshOnDevice:
    """A mesh, uploaded, and the block that says where it stands.

    Parameters
    ----------
    positions, normals : ndarray, shape (V, 3)
    triangles : ndarray of int, shape (F, 3)
    """

    def __init__(self, positions: Array, normals: Array, triangles: Indices) -> None:
        attributes = {"position": positions, "normal": normals}
        self._batch = buffers.triangles(shaders.views_fragment_shader(), attributes, triangles)
        self._placed = buffers.KeptBlock()

    def again(self) -> "MeshOnDevice":
        """The same mesh, to be drawn elsewhere in the same frames: with a block of its own."""
        other = copy(self)
        other._placed = buffers.KeptBlock()
        return other

    def draw(self, shader: gpu.types.GPUShader, draw: Draw) -> None:
        """Draw it into the active frame buffer.

        Parameters
        ----------
        shader : GPUShader
            A program of `shaders.mesh_interface`, bound, with all that it needs but the block `draw`.
        draw : Draw
        """
        shader.uniform_block("draw", self._placed.filled(*draw.fields()))
        self._batch.draw(shader)


class OnDevice(Protocol):
    """What a map set holds, uploaded."""

    def draw(self, mesh: MeshOnDevice, draw: Draw, look: Any) -> None:
        """Draw a mesh into the active frame buffer, with the depth test as it is set.

        Parameters
        ----------
        mesh : MeshOnDevice
        draw : Draw
        look : object
            The look of this kind of map set: see `core.kinds`.
        """
