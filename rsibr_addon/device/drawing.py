"""The interface of every kind of map set on the GPU: an upload that is drawn on a mesh with a look."""

from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from copy import copy
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, Protocol, runtime_checkable

import gpu
import numpy as np

from ..core.conventions import Array, Indices
from . import buffers, shaders
from .textures import GpuTexture

LEAST_STRENGTH = 1e-9
"""That of a world without light: not even a sun is seen, and what materials emit stays finite beside it."""

LOOKS_KEPT = 64
"""Looks of a map set whose inputs are kept."""


@dataclass(frozen=True)
class Draw:
    """The place of a mesh and of the eye; matrices of shape (4, 4) for column vectors.

    Attributes
    ----------
    model, view, projection : ndarray, shape (4, 4)
    eye : ndarray, shape (4,)
        Homogeneous position of the eye in world space: see `core.geometry.camera.Camera.eye`.
    turn : ndarray, shape (3, 3)
        Rotation from the world to that of the map set, for a world that was turned since the bake. It is for
        shading alone: it turns position, normal and `eye`.
    strength : float
        Factor of the picture on its way to the display, from `LEAST_STRENGTH`. What a material emits is
        divided by it: only the world's light has it.
    """

    model: Array
    view: Array
    projection: Array
    eye: Array
    turn: Array = field(default_factory=lambda: np.eye(3))
    strength: float = 1.0

    @cached_property
    def rows(self) -> Array:
        """The rows of the block `Draw` of the shaders, shape (18, 4), float32, with matrices by column."""
        rows = np.zeros((18, 4), np.float32)
        rows[0:4], rows[4:8], rows[8:12] = self.model.T, self.view.T, self.projection.T
        rows[12:15, :3], rows[15, 3] = self.turn.T, 1.0
        rows[16, :3], rows[16, 3] = self.turn @ self.eye[:3], self.eye[3]
        rows[17, 0] = self.strength
        return rows


class GpuMesh:
    """An uploaded mesh, and the block with its place.

    Parameters
    ----------
    positions, normals : ndarray, shape (V, 3)
    triangles : ndarray of int, shape (F, 3)

    Attributes
    ----------
    is_deferred : bool
        Whether `draw` takes the deferred forms of programs.
    """

    is_deferred = False

    def __init__(self, positions: Array, normals: Array, triangles: Indices) -> None:
        attributes = {"position": positions, "normal": normals}
        self._batch = buffers.triangles(shaders.views_fragment_shader(), attributes, triangles)
        self._placed = buffers.KeptBlock()

    @property
    def batch(self) -> gpu.types.GPUBatch:
        """What is uploaded: the same for the same mesh elsewhere."""
        return self._batch

    def again(self) -> "GpuMesh":
        """The same mesh for another place in the same frames, with its own block."""
        other = copy(self)
        other._placed = buffers.KeptBlock()
        return other

    def place(self, shader: gpu.types.GPUShader, draw: Draw) -> None:
        """Give a program, bound, the block `draw`."""
        shader.uniform_block("draw", self._placed.with_rows(draw.rows))

    def draw(self, shader: gpu.types.GPUShader, draw: Draw) -> None:
        """Draw the mesh into the active frame buffer.

        Parameters
        ----------
        shader : GPUShader
            A program of `shaders.mesh_interface`, bound, with all that it needs but the block `draw`.
        draw : Draw
        """
        self.place(shader, draw)
        self._batch.draw(shader)


class GpuMapSet(Protocol):
    """The content of a map set, to be drawn with; any thread makes it, with nothing on the GPU at first."""

    @property
    def textures(self) -> Sequence[GpuTexture]:
        """Those that looks need. What is not on the GPU yet is uploaded when it is drawn."""

    def draw(self, mesh: GpuMesh, draw: Draw, look: Any) -> None:
        """Draw a mesh into the active frame buffer, with the current depth test.

        Parameters
        ----------
        mesh : GpuMesh
        draw : Draw
        look : object
            The look of this kind of map set: see `core.kinds`.
        """


@dataclass(frozen=True)
class Inputs:
    """What a look is drawn from.

    Attributes
    ----------
    program : MeshProgram
    fields : tuple of ndarray
        Values of its block, as `buffers.block_rows` takes them.
    textures : mapping of str to GpuTexture
        Its samplers -> what they look up.
    sums : mapping of str to (str, ndarray of shape (3,))
        Samplers of summed tables -> the sampler of the map that each sums, and the unit of its sums.
    exact_from : mapping of str to int
        Samplers -> the row of their texture from which on none may be rounded, as kernels of opposite signs,
        which are shown by their difference, would magnify that.
    """

    program: shaders.MeshProgram
    fields: tuple[Array, ...]
    textures: Mapping[str, GpuTexture]
    sums: Mapping[str, tuple[str, Array]] = field(default_factory=dict)
    exact_from: Mapping[str, int] = field(default_factory=dict)

    @cached_property
    def rows(self) -> Array:
        """The rows of its block, shape (n, 4), float32."""
        return buffers.block_rows(*self.fields)


@runtime_checkable
class WithInputs(Protocol):
    """A map set that one program draws from one block and textures, here or on a web page."""

    def inputs(self, look: Any) -> Inputs:
        """What a look is drawn from; made without the GPU."""


@runtime_checkable
class Emissive(Protocol):
    """A map set that knows what of its radiance is emitted."""

    def draw_emission(self, mesh: GpuMesh, draw: Draw, look: Any) -> None:
        """The same as `GpuMapSet.draw`, of emitted radiance alone."""


@runtime_checkable
class Refractive(Protocol):
    """A map set that may show what is seen through an object."""

    def refracts(self, look: Any) -> bool:
        """Whether a look shows refracted light, averaged over pixels."""


@runtime_checkable
class WithSplitSum(WithInputs, Protocol):
    """A map set whose program also shades by the split sum of engines."""

    def split_sum(self) -> Mapping[str, GpuTexture]:
        """Samplers -> what they look up for it in the place of their textures; made without the GPU."""


class ProgramMapSet(ABC):
    """A `GpuMapSet` that one program draws from its inputs."""

    textures: Sequence[GpuTexture]

    @abstractmethod
    def inputs(self, look: Any) -> Inputs:
        """See `WithInputs`."""

    @cached_property
    def _block(self) -> buffers.KeptBlock:
        return buffers.KeptBlock()

    @cached_property
    def _lately(self) -> dict[int, tuple[Any, Inputs]]:
        return {}

    def draw(self, mesh: GpuMesh, draw: Draw, look: Any) -> None:
        """See `GpuMapSet.draw`."""
        self._draw(mesh, draw, self._inputs(look))

    def _inputs(self, look: Any) -> Inputs:
        """The inputs of a look, made once for all redraws that show it."""
        if id(look) not in self._lately:
            if len(self._lately) >= LOOKS_KEPT:
                self._lately.clear()
            self._lately[id(look)] = look, self.inputs(look)  # a look that is kept has its number to itself
        return self._lately[id(look)][1]

    def _draw(self, mesh: GpuMesh, draw: Draw, inputs: Inputs) -> None:
        shader = inputs.program(mesh.is_deferred)
        shader.bind()
        shader.uniform_block(inputs.program.block, self._block.with_rows(inputs.rows))
        for name, texture in inputs.textures.items():
            shader.uniform_sampler(name, texture.whole())
        mesh.draw(shader, draw)


class LiveGpuMapSet(GpuMapSet, Protocol):
    """What is uploaded of a kind whose looks are made while one looks."""

    def newest(self, looks: list[Any]) -> Any:
        """The last of some looks that can be drawn. If the very last cannot be drawn, it is made.

        Parameters
        ----------
        looks : list
            At least one, oldest first.

        Returns
        -------
        object or None
            None where none can be drawn yet.
        """

    def warning(self, look: Any) -> str:
        """What there is to be said of a look that can be drawn; empty for nothing."""
