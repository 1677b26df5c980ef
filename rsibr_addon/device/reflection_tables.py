"""Reflection tables on the GPU [Miller1984]: a texture for each, looked up for each fragment."""

from dataclasses import dataclass
from functools import cached_property

import gpu
import numpy as np

from ..core.antialiased.summed_area import summed_area_table
from ..core.conventions import Array
from ..core.errors import DeviceError
from ..core.maps import equirect
from ..core.reflection_tables import ReflectionTables, Role
from ..core.shading.reflection_tables import MIRRORED, TablesLook
from . import buffers
from .drawing import Draw, MeshOnDevice
from .shaders import build, kept_until_exit, mesh_interface
from .summed_area import summed_area_texture

# Whether each table counts, in the order of `Role`; the index of refraction; whether each table of `MIRRORED`
# counts by its mean over a pixel; and what the sums of those count.
_FIELDS = (*(role.value for role in Role), "eta", *(f"{role}_mean" for role in MIRRORED))
_UNITS = " ".join(f"vec4 {role}_unit;" for role in MIRRORED)
_TABLES_BLOCK = f"struct Tables {{ {' '.join(f'float {field};' for field in _FIELDS)} {_UNITS} }};"


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
    for slot, role in enumerate(MIRRORED, start=len(Role) + 1):
        info.sampler(slot, "FLOAT_2D_ARRAY", f"{role}_sums")
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
        black = buffers.texture(np.zeros((1, 1, 4)))
        self._textures = {
            role: _bordered_texture(role, tables.maps[role]) if role in tables.maps else black
            for role in Role
        }
        self._weights = buffers.texture(_with_alpha(tables.weights))
        self._tables = tables
        self._fields = buffers.KeptBlock()
        self._no_sums = _Sums(buffers.texture_array(np.zeros((3, 2, 2, 4))), np.ones(3))

    @cached_property
    def _sums(self) -> dict[Role, "_Sums"]:
        """Made when an antialiased look first asks for them: they take three times the tables' memory."""
        there = [role for role in MIRRORED if role in self._tables.maps]
        return {role: _summed(self._tables.maps[role]) for role in there}

    def draw(self, mesh: MeshOnDevice, draw: Draw, look: TablesLook) -> None:
        """See `device.drawing.OnDevice`.

        Notes
        -----
        Reference: core/shading/reflection_tables.py.
        """
        averaged = self._sums if look.antialiased else {}
        shown = [role for role in self._tables.maps if role in look.shown]
        counts = [role in shown and role not in averaged for role in Role]
        means = [role in shown and role in averaged for role in MIRRORED]
        sums = {role: averaged.get(role, self._no_sums) for role in MIRRORED}
        fields = self._fields.filled(
            np.array([*counts, self._tables.eta, *means], dtype=float).reshape(2, 4),
            *(each.unit for each in sums.values()),
        )
        shader = reflection_tables_shader()
        shader.bind()
        shader.uniform_block("tables", fields)
        for role, texture in self._textures.items():
            shader.uniform_sampler(role.value, texture)
        for role, each in sums.items():
            shader.uniform_sampler(f"{role}_sums", each.texture)
        shader.uniform_sampler("weights", self._weights)
        mesh.draw(shader, draw)


@dataclass(frozen=True)
class _Sums:
    """A table for antialiased lookup, and what its sums count, shape (3,)."""

    texture: gpu.types.GPUTexture
    unit: Array


def _summed(image: Array) -> _Sums:
    table = summed_area_table(image)
    return _Sums(summed_area_texture(table), table.unit)


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
