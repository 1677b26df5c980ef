"""Arrays to the GPU and back."""

import gpu
import numpy as np
from gpu_extras.batch import batch_for_shader

from ..core.conventions import Array, Indices


def texture(image: Array) -> gpu.types.GPUTexture:
    """Upload a map, shape (height, width, 4), to be looked up bilinearly within its edges, as RGBA32F."""
    height, width = image.shape[:2]
    return smooth(gpu.types.GPUTexture((width, height), format="RGBA32F", data=buffer(image)))


def table_texture(table: Array) -> gpu.types.GPUTexture:
    """Upload a table of colours, to be fetched node by node.

    Parameters
    ----------
    table : ndarray, shape (depth, height, width, 3)

    Returns
    -------
    GPUTexture, RGBA16F
        11 significant bits are an eighth of a step of a display of 8 bits.
    """
    depth, height, width = table.shape[:3]
    texels: Array = np.ones((depth, height, width, 4), dtype=np.float32)
    texels[..., :3] = table
    return gpu.types.GPUTexture((width, height, depth), format="RGBA16F", data=buffer(texels))


def with_alpha(image: Array) -> Array:
    """A map with the four channels of textures, shape (..., 4), of one of shape (..., 3); alpha is 1."""
    return np.concatenate([image, np.ones_like(image[..., :1])], axis=-1)


def render_target(size: int) -> gpu.types.GPUTexture:
    """An empty square map to be drawn to and looked up, RGBA32F."""
    return smooth(gpu.types.GPUTexture((size, size), format="RGBA32F"))


FRAMES_IN_FLIGHT = 3
"""Frames that drivers may draw behind the program; some wait for them before a buffer changes."""


class KeptBlock:
    """A uniform block of mat4 and vec4 fields that is filled for each draw, in place after the first few.

    Keep it with the thing that is drawn: Blender binds a block without a reference to it, and the block has
    to outlive the draw. Filling and drawing are commands in one order, so the draws of a frame may share a
    block.
    """

    def __init__(self) -> None:
        self._uploaded: dict[bytes, gpu.types.GPUUniformBuf] = {}

    def filled(self, *fields: Array) -> gpu.types.GPUUniformBuf:
        """Upload fields, the same number each time, unless they were uploaded lately.

        Parameters
        ----------
        *fields : ndarray
            In the block's order: vectors of up to 4 numbers, filled up with 0; matrices of shape
            (4, 4) for column vectors; arrays of vectors of shape (n, 3) or (n, 4).
        """
        return self.with_rows(block_rows(*fields))

    def with_rows(self, rows: Array) -> gpu.types.GPUUniformBuf:
        """The same of a block's rows, shape (rows, 4), float32."""
        values = rows.tobytes()
        block = self._uploaded.pop(values, None)
        if block is None and len(self._uploaded) < FRAMES_IN_FLIGHT:
            block = gpu.types.GPUUniformBuf(values)
        elif block is None:
            block = self._uploaded.pop(next(iter(self._uploaded)))
            block.update(values)
        self._uploaded[values] = block  # the newest last
        return block


def pixels(framebuffer: gpu.types.GPUFrameBuffer, size: int) -> Array:
    """Read the first colour target back, shape (size, size, 4), float32, row 0 at the bottom."""
    read = framebuffer.read_color(0, 0, size, size, 4, 0, "FLOAT")
    return np.array(read, dtype=np.float32)


def triangles(
    shader: gpu.types.GPUShader, attributes: dict[str, Array], indices: Indices
) -> gpu.types.GPUBatch:
    """Upload a triangle mesh.

    Parameters
    ----------
    shader : GPUShader
        A program with these vertex attributes.
    attributes : dict of str to ndarray, shape (V, n)
    indices : ndarray of int, shape (F, 3)
    """
    contiguous = {name: np.ascontiguousarray(values, np.float32) for name, values in attributes.items()}
    return batch_for_shader(shader, "TRIS", contiguous, indices=np.ascontiguousarray(indices, np.int32))


def buffer(values: Array) -> gpu.types.Buffer:
    """Values, of any shape, as textures take them: in single precision, one after the other."""
    flat = np.ascontiguousarray(values, dtype=np.float32).reshape(-1)
    return gpu.types.Buffer("FLOAT", flat.size, flat)


def smooth(texture: gpu.types.GPUTexture) -> gpu.types.GPUTexture:
    """The texture, looked up bilinearly within its edges from now on."""
    texture.filter_mode(True)
    texture.extend_mode("EXTEND")
    return texture


def block_rows(*fields: Array) -> Array:
    """Fields, see `KeptBlock.filled`, in a block's layout, shape (rows, 4), float32."""
    heights = [1 if field.ndim == 1 else len(field) for field in fields]
    block, row = np.zeros((sum(heights), 4), np.float32), 0
    for field, height in zip(fields, heights, strict=True):
        # GLSL stores matrices by column
        block[row : row + height, : field.shape[-1]] = field.T if field.shape == (4, 4) else field
        row += height
    return block
