"""Reflection tables on the GPU [Miller1984]: a texture for each, looked up for each fragment."""

import gpu
import numpy as np

from ..core.conventions import Array
from ..core.errors import DeviceError
from ..core.maps import equirect
from ..core.reflection_tables import ReflectionTables, Role
from ..core.shading.reflection_tables import TablesLook
from . import buffers
from .drawing import Draw
from .shaders import build, kept_until_exit, mesh_interface

# Whether each table counts, in the order of `Role`, and the index of refraction.
_FIELDS = (*(role.value for role in Role), "eta", "unused_0", "unused_1")
_TABLES_BLOCK = f"struct Tables {{ {' '.join(f'float {field};' for field in _FIELDS)} }};"


@kept_until_exit
def reflection_tables_shader() -> gpu.types.GPUShader:
    """Draws a mesh from reflection tables.

    Raises
    ------
    DeviceError
        The driver refuses the program.
    """
    info = mesh_interface(_TABLES_BLOCK)
    info.uniform_buf(1, "Tables", "tables")
    for slot, role in enumerate(Role):
        info.sampler(slot, "FLOAT_2D", role.value)
    info.sampler(len(Role), "FLOAT_2D", "weights")
    return build("reflection_tables", info, "mesh_vert.glsl", "reflection_tables_frag.glsl")


class ReflectionTablesOnDevice:
    """A map set's reflection tables, uploaded.

    Parameters
    ----------
    tables : ReflectionTables

    Raises
    ------
    DeviceError
        A table is larger than the device takes.
    """

    def __init__(self, tables: ReflectionTables) -> None:
        self._eta = tables.eta
        self._there = [role in tables.maps for role in Role]
        black = buffers.texture(np.zeros((1, 1, 4)))
        self._textures = {
            role: _bordered_texture(role, tables.maps[role]) if role in tables.maps else black
            for role in Role
        }
        self._weights = buffers.texture(_with_alpha(tables.weights))

    def draw(self, mesh: gpu.types.GPUBatch, draw: Draw, look: TablesLook) -> None:
        """See `device.drawing.OnDevice`.

        Notes
        -----
        Reference: core/shading/reflection_tables.py.
        """
        counts = [there and role in look.shown for role, there in zip(Role, self._there, strict=True)]
        # Bound blocks must outlive the draw: Blender keeps no reference to them.
        placed = draw.uniforms()
        fields = buffers.uniform_block(np.array([*counts, self._eta, 0.0, 0.0], dtype=float).reshape(2, 4))
        shader = reflection_tables_shader()
        shader.bind()
        shader.uniform_block("draw", placed)
        shader.uniform_block("tables", fields)
        for role, texture in self._textures.items():
            shader.uniform_sampler(role.value, texture)
        shader.uniform_sampler("weights", self._weights)
        mesh.draw(shader)


def bordered(image: Array) -> Array:
    """A latitude-longitude map with what lies across its seam and poles around it.

    Parameters
    ----------
    image : ndarray, shape (height, width, channels)

    Returns
    -------
    ndarray, shape (height + 2, width + 2, channels)
    """
    height, width = image.shape[:2]
    columns, rows = np.meshgrid(np.arange(-1, width + 1), np.arange(-1, height + 1))
    columns, rows = equirect.wrap(columns, rows, width, height)
    return image[rows, columns]


def _bordered_texture(role: Role, image: Array) -> gpu.types.GPUTexture:
    width, largest = image.shape[1] + 2, gpu.capabilities.max_texture_size_get()
    if width > largest:
        raise DeviceError(
            f"The {role} table takes a texture {width} wide, and this device has {largest} at most: "
            f"bake a smaller table."
        )
    return buffers.texture(_with_alpha(bordered(image)))


def _with_alpha(image: Array) -> Array:
    return np.concatenate([image, np.ones_like(image[..., :1])], axis=-1)
