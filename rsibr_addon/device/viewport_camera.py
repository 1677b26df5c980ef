"""What Blender's own viewport shows, rendered into a texture."""

import bpy
import gpu
from mathutils import Matrix

from ..core.conventions import Array


class ViewportCamera:
    """Renders views; one camera serves all views of its size, as Blender keeps an engine for each.

    Parameters
    ----------
    width, height : int
        In pixels.
    """

    def __init__(self, width: int, height: int) -> None:
        self._target = gpu.types.GPUOffScreen(width, height, format="RGBA16F")

    def see(
        self, scene: bpy.types.Scene, layer: str, space: bpy.types.SpaceView3D, view: Array, projection: Array
    ) -> gpu.types.GPUTexture:
        """Render one view with a viewport's shading, without previews; only while its pixels are drawn.

        Parameters
        ----------
        scene : bpy.types.Scene
        layer : str
            Name of one of its view layers.
        space : bpy.types.SpaceView3D
            The viewport that is being drawn.
        view, projection : ndarray, shape (4, 4)
            From world to eye coordinates, and on to the picture's.

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
