"""Pictures of a mesh drawn off-screen, in linear radiance."""

import gpu
import numpy as np

from ..core.camera import Camera
from ..core.conventions import Array
from ..core.radiance_views import RadianceViews
from ..core.shading import Mode, Warping
from . import buffers
from .context import ensure_context
from .radiance_views import Draw, RadianceViewsOnDevice, mesh_batch

SAMPLES_PER_AXIS = 4
"""Each pixel is the mean of SAMPLES_PER_AXIS**2 samples: antialiased, as Cycles' box filter."""


class PreviewRenderer:
    """Draws meshes with a map set's radiance views into pictures.

    Parameters
    ----------
    views : RadianceViews
        Uploaded once.

    Raises
    ------
    DeviceError
        There is no graphics driver, or it refuses a shader.
    """

    def __init__(self, views: RadianceViews) -> None:
        ensure_context()
        self._views = RadianceViewsOnDevice(views)

    def draw(
        self,
        positions: Array,
        normals: Array,
        triangles: Array,
        camera: Camera,
        size: int,
        mode: Mode,
        warping: Warping,
    ) -> Array:
        """Draw one picture.

        Parameters
        ----------
        positions, normals : ndarray, shape (V, 3)
            A mesh within the unit sphere, in world coordinates.
        triangles : ndarray of int, shape (F, 3)
        camera : Camera
        size : int
            Width and height of the picture in pixels.
        mode : Mode
        warping : Warping

        Returns
        -------
        ndarray, shape (size, size, 4), float32
            Radiance times coverage, and coverage; row 0 at the bottom.
        """
        fine = size * SAMPLES_PER_AXIS
        colour = buffers.render_target(fine)
        depth = gpu.types.GPUTexture((fine, fine), format="DEPTH_COMPONENT32F")
        target = gpu.types.GPUFrameBuffer(depth_slot=depth, color_slots=(colour,))
        placed = Draw(
            model=np.eye(4),
            view=np.linalg.inv(camera.world_from_camera),
            projection=camera.projection,
            eye=camera.eye,
            view_dir=np.asarray(camera.view_dir),
        )
        mesh = mesh_batch(positions, normals, triangles)
        depth_test, depth_mask = gpu.state.depth_test_get(), gpu.state.depth_mask_get()
        with target.bind():
            target.clear(color=(0.0, 0.0, 0.0, 0.0), depth=1.0)
            gpu.state.depth_test_set("LESS_EQUAL")
            gpu.state.depth_mask_set(True)
            try:
                self._views.draw(mesh, placed, mode, warping)
            finally:
                gpu.state.depth_test_set(depth_test)
                gpu.state.depth_mask_set(depth_mask)
            picture = buffers.pixels(target, fine)
        return picture.reshape(size, SAMPLES_PER_AXIS, size, SAMPLES_PER_AXIS, 4).mean(axis=(1, 3))
