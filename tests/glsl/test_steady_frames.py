"""A steady orbit allocates nothing on the GPU, whatever is shown."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

import gpu
import numpy as np
import pytest
from mathutils import Matrix
from rsibr.rsibr_addon.core.environment import Environment
from rsibr.rsibr_addon.core.geometry.camera import Camera
from rsibr.rsibr_addon.core.kinds.environment import EnvironmentLook
from rsibr.rsibr_addon.core.kinds.lobe_stack.shading import StackLook
from rsibr.rsibr_addon.core.kinds.mip_chain.shading import MipLook
from rsibr.rsibr_addon.core.kinds.mip_chain.texture_space import tent_halved
from rsibr.rsibr_addon.core.kinds.radiance_views.shading import Mode, ViewsLook
from rsibr.rsibr_addon.core.kinds.reflection_tables.shading import TablesLook
from rsibr.rsibr_addon.device import buffers
from rsibr.rsibr_addon.device.context import ensure_context
from rsibr.rsibr_addon.device.drawing import GpuMapSet, GpuMesh
from rsibr.rsibr_addon.device.kinds.environment import GpuEnvironment
from rsibr.rsibr_addon.device.kinds.live_environment import GpuLiveEnvironment
from rsibr.rsibr_addon.device.kinds.lobe_stack import GpuLobeStack
from rsibr.rsibr_addon.device.kinds.mip_chain import GpuMipChain
from rsibr.rsibr_addon.device.kinds.radiance_views import GpuRadianceViews
from rsibr.rsibr_addon.device.kinds.reflection_tables import GpuReflectionTables
from rsibr.rsibr_addon.device.preview_stage import Stage, current_sight
from rsibr.tests.glsl.test_mip_chain_preview import smooth_chain
from rsibr.tests.glsl.test_reflection_tables import smooth_tables
from rsibr.tests.lobe_stacks import random_stack
from rsibr.tests.synthetic_views import smooth_views

ALLOCATED = ("GPUTexture", "GPUUniformBuf", "GPUFrameBuffer", "GPUBatch", "GPUVertBuf", "GPUIndexBuf")

SUBJECTS: dict[str, Callable[[], tuple[GpuMapSet, Any]]] = {
    **{
        mode.value: lambda mode=mode: (GpuRadianceViews(smooth_views(12, 16)), ViewsLook(mode))
        for mode in Mode
    },
    "mip chain": lambda: (GpuMipChain(smooth_chain(tent_halved)), MipLook()),
    "tables": lambda: (GpuReflectionTables(smooth_tables(1.5)), TablesLook()),
    "tables, antialiased": lambda: (
        GpuReflectionTables(smooth_tables(1.5)),
        TablesLook(antialiased=True),
    ),
    "lobe stack": lambda: (GpuLobeStack(random_stack("dual_paraboloid")), StackLook()),
    "environment": lambda: (
        GpuEnvironment(Environment(np.ones((8, 16, 3), np.float32), "even")),
        EnvironmentLook(),
    ),
    "live light": lambda: (GpuLiveEnvironment(8), MipLook()),
}


@contextmanager
def allocations() -> Iterator[list[str]]:
    """What is made on the GPU within, by type."""
    made: list[str] = []

    def counted(name: str, original: type) -> Callable[..., Any]:
        def make(*arguments: Any, **named: Any) -> Any:
            made.append(name)
            return original(*arguments, **named)

        return make

    with pytest.MonkeyPatch.context() as patch:
        for name in ALLOCATED:
            patch.setattr(gpu.types, name, counted(name, getattr(gpu.types, name)))
        yield made


@pytest.mark.parametrize("name", SUBJECTS)
def test_frames_after_the_first_few_allocate_nothing(name: str) -> None:
    ensure_context()
    subject, look = SUBJECTS[name]()
    corners, stage = np.eye(3), Stage()
    mesh = GpuMesh(corners, corners, np.array([[0, 1, 2]]))
    display = buffers.table_texture(np.ones((96, 96, 96, 3)))
    colour = gpu.types.GPUTexture((32, 32), format="RGBA32F")
    depth = gpu.types.GPUTexture((32, 32), format="DEPTH_COMPONENT32F")
    target = gpu.types.GPUFrameBuffer(depth_slot=depth, color_slots=(colour,))

    def frame(angle: float) -> None:
        camera = Camera((np.cos(angle), np.sin(angle), 0.3), field_of_view=1.0)
        with target.bind(), gpu.matrix.push_pop(), gpu.matrix.push_pop_projection():
            gpu.matrix.load_matrix(Matrix(np.linalg.inv(camera.world_from_camera)))
            gpu.matrix.load_projection_matrix(Matrix(camera.projection))
            placed = current_sight().on(np.eye(4), np.eye(3))
            with stage.drawing():
                subject.draw(mesh, placed, look)
            stage.show(display, 1.0, (0.0, 1.0), among_others=True)

    with allocations() as made:
        for number in range(buffers.FRAMES_IN_FLIGHT):
            frame(0.1 * number)
        assert "GPUUniformBuf" in made
        made.clear()
        for number in range(2 * buffers.FRAMES_IN_FLIGHT):
            frame(0.1 * number)
        assert made == []
