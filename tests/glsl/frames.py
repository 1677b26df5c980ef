"""Frames of previews without a window."""

import gpu
import numpy as np
from mathutils import Matrix
from rsibr.rsibr_addon.core.conventions import Array
from rsibr.rsibr_addon.host.visible_surfaces import View
from rsibr.rsibr_addon.tasks.viewport.previews import Previews

PROJECTION = Matrix.Diagonal((0.5, 0.5, -0.02, 1.0))
"""Orthographic, of 4 units along both sides."""


def frame_of(previews: Previews, view: View, target: gpu.types.GPUOffScreen, to_eye: Matrix) -> Array:
    """Draw previews, twice where their display is not known yet, and read them.

    Parameters
    ----------
    previews : Previews
    view : View
    target : GPUOffScreen
        Cleared first.
    to_eye : Matrix
        From the world to the eye.

    Returns
    -------
    ndarray, shape (height, width, 4)
        As shown, and the share of each pixel that previews cover.
    """
    with target.bind(), gpu.matrix.push_pop(), gpu.matrix.push_pop_projection():
        framebuffer = gpu.state.active_framebuffer_get()
        framebuffer.clear(color=(0.0, 0.0, 0.0, 0.0), depth=1.0)
        gpu.matrix.load_matrix(to_eye)
        gpu.matrix.load_projection_matrix(PROJECTION)
        with previews.faults.guarded():
            if not previews.draw(view):
                previews.add_display(view.scene)
                previews.draw(view)
        read = framebuffer.read_color(0, 0, target.width, target.height, 4, 0, "FLOAT")
    assert previews.faults.trouble is None
    return np.array(read.to_list())
