"""The toy kind on the GPU. As a module of `device/kinds`."""

from pathlib import Path

import gpu
from rsibr.rsibr_addon.core.conventions import Array
from rsibr.rsibr_addon.device import buffers
from rsibr.rsibr_addon.device.drawing import Draw, GpuMesh
from rsibr.rsibr_addon.device.shaders import build, kept_until_exit, mesh_interface
from rsibr.tests.toys.disk_core import Disk, DiskLook

FRAGMENT = str(Path(__file__).with_name("disk_frag.glsl"))


@kept_until_exit
def disk_shader() -> gpu.types.GPUShader:
    info = mesh_interface("struct DiskLook { vec4 middle; vec4 rim; vec4 gain; };")
    info.uniform_buf(1, "DiskLook", "look")
    return build("disk", info, "mesh_vert.glsl", FRAGMENT)


class GpuDisk:
    """A disk, which a uniform block has room for."""

    textures = ()

    def __init__(self, disk: Disk) -> None:
        self._disk, self._look = disk, buffers.KeptBlock()

    def fields(self, look: DiskLook) -> tuple[Array, ...]:
        return self._disk.middle, self._disk.rim, buffers.np.array([look.gain])

    def draw(self, mesh: GpuMesh, draw: Draw, look: DiskLook) -> None:
        shader = disk_shader()
        shader.bind()
        shader.uniform_block("look", self._look.filled(*self.fields(look)))
        mesh.draw(shader, draw)
