"""A toy shading mode for the toy kind, two tones: with its shader, what a mode adds to a kind's files."""

from dataclasses import dataclass
from pathlib import Path

import gpu
import numpy as np
from rsibr.rsibr_addon.core.conventions import Array
from rsibr.rsibr_addon.core.geometry.directions import dot
from rsibr.rsibr_addon.core.options import option
from rsibr.rsibr_addon.device.drawing import Draw, GpuMesh
from rsibr.rsibr_addon.device.shaders import build, kept_until_exit, mesh_interface
from rsibr.tests.toys.disk_core import Disk, DiskLook
from rsibr.tests.toys.disk_device import GpuDisk

FRAGMENT = str(Path(__file__).with_name("toon_frag.glsl"))


@dataclass(frozen=True)
class ToonLook(DiskLook):
    """The colour of the middle where the cosine is above an edge, and the rim's elsewhere."""

    edge: float = option(0.5, label="Edge", help="Cosine between the tones", least=0.0, most=1.0)


def toon_radiance(disk: Disk, normal: Array, view_dir: Array, look: ToonLook) -> Array:
    """Two tones, shape (..., 3). GLSL twin: toon_frag.glsl."""
    middle = dot(normal, view_dir)[..., None] > look.edge
    return look.gain * np.where(middle, disk.middle, disk.rim)


@kept_until_exit
def toon_shader() -> gpu.types.GPUShader:
    info = mesh_interface("struct ToonLook { vec4 middle; vec4 rim; vec4 gain; vec4 edge; };")
    info.uniform_buf(1, "ToonLook", "look")
    return build("toon", info, "mesh_vert.glsl", FRAGMENT)


class GpuToon(GpuDisk):
    """A disk, drawn in two tones where the look asks for that."""

    def draw(self, mesh: GpuMesh, draw: Draw, look: DiskLook) -> None:
        if not isinstance(look, ToonLook):
            super().draw(mesh, draw, look)
            return
        shader = toon_shader()
        shader.bind()
        shader.uniform_block("look", self._look.filled(*self.fields(look), np.array([look.edge])))
        mesh.draw(shader, draw)
