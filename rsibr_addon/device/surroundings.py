"""The surroundings of a point, rendered by Blender's own viewport into a texture."""

import bpy
import gpu
from mathutils import Matrix

from ..core.conventions import Array


class SurroundingsCamera:
    """Renders square views; one camera serves all views of its size, as Blender keeps an engine for each.

    Parameters
    ----------
    size : int
        Width and height in pixels.
    """

    def __init__(self, size: int) -> None:
        self._target = gpu.types.GPUOffScreen(size, size, format="RGBA16F")

    def see(
        self, scene: bpy.types.Scene, layer: str, space: bpy.types.SpaceView3D, view: Array, projection: Array
    ) -> gpu.types.GPUTexture:
        """Render one view with a viewport's shading; only while a viewport's pixels are drawn.

        Parameters
        ----------
        scene : bpy.types.Scene
        layer : str
            Name of one of its view layers.
        space : bpy.types.SpaceView3D
            The viewport that is being drawn.
        view, projection : ndarray, shape (4, 4)
            See `core.kinds.live_environment.face_view` and `face_projection`.

        Returns
        -------
        GPUTexture
            Radiance before the view transform; valid until the next view is rendered.
        """
        self._target.draw_view3d(
            scene,
            scene.view_layers[layer],
            space,
            bpy.context.region,
            Matrix(view.tolist()),
            Matrix(projection.tolist()),
            do_color_management=False,
        )
        return self._target.texture_color
