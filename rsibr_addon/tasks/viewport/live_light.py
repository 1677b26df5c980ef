"""The light around an object, rendered while one looks: [Kautz2004] section 5."""

import time
from collections import deque
from contextlib import AbstractContextManager, nullcontext

import numpy as np

from ...core.kinds.live_environment import (
    FACE_COUNT,
    NEAREST,
    face_projection,
    face_view,
    faces_due,
    faces_within,
    near_distances,
)
from ...device.kinds.live_environment import GpuLiveEnvironment
from ...device.kinds.live_pyramid import GpuLivePyramid
from ...device.viewport_camera import ViewportCamera
from ...host.live_light import appearance_of, bare, can_hide, hidden, points_of
from ...host.sun_lamps import suns_above
from ...host.visible_surfaces import Surface, View

UPDATES_JUDGED = 5
"""So many of the last say what the next one will take."""


class LiveLight:
    """Light on the GPU, and which of its six faces are older than the scene.

    Parameters
    ----------
    gpu_map_set : GpuLiveEnvironment or GpuLivePyramid
        To be drawn with, once `is_ready`.
    """

    def __init__(self, gpu_map_set: GpuLiveEnvironment | GpuLivePyramid) -> None:
        self.gpu_map_set = gpu_map_set
        self._camera = ViewportCamera(gpu_map_set.size, gpu_map_set.size)
        self._missing = FACE_COUNT
        self._due = FACE_COUNT
        self._next_face = 0
        self._appearance: tuple[object, ...] = ()
        self._seconds_per_face: deque[float] = deque(maxlen=UPDATES_JUDGED)

    @property
    def is_ready(self) -> bool:
        """Whether every face has been rendered once."""
        return self._missing == 0

    def scene_changed(self) -> None:
        """Have all faces rendered anew, the oldest first."""
        self._due = FACE_COUNT

    def render(self, view: View, surface: Surface) -> bool:
        """Render faces that are due, and filter; only while a viewport's pixels are being drawn.

        Parameters
        ----------
        view : View
            View of that viewport; its shading is that of the surroundings.
        surface : Surface
            The object, as it stands.

        Returns
        -------
        bool
            Whether the light has changed.
        """
        self._look_at_viewport(view)
        if not self._due:
            return False
        budget = 1e-3 * surface.item.rsibr.live.budget
        faces = faces_due(self._due, self._next_face, faces_within(budget, self._seconds_per_face))
        since = time.perf_counter()
        self._render(faces, view, surface)
        self.gpu_map_set.filter()
        self.gpu_map_set.finish()
        self._seconds_per_face.append((time.perf_counter() - since) / len(faces))
        self._next_face = (faces[-1] + 1) % FACE_COUNT
        self._due -= len(faces)
        self._missing = max(self._missing - len(faces), 0)
        return True

    def _look_at_viewport(self, view: View) -> None:
        """Have all faces rendered anew where the viewport shows things in another way, as no scene tells."""
        appearance = appearance_of(view.space)
        if appearance != self._appearance:
            self._appearance, self._due = appearance, FACE_COUNT

    def _render(self, faces: tuple[int, ...], view: View, surface: Surface) -> None:
        space, layer = view.space, view.scene.view_layers[view.layer[1]]
        reached = points_of(surface.item, view.depsgraph) @ surface.matrix[:3, :3].T + surface.matrix[:3, 3]
        centre = 0.5 * (reached.min(axis=0) + reached.max(axis=0))
        x, y, z = centre.tolist()
        self.gpu_map_set.captured_at = x, y, z
        out_of_sight: AbstractContextManager[None]
        # An instance cannot be hidden without all others that the same object makes
        if not surface.is_instance and can_hide(surface.item, layer):
            reach, own = np.abs(reached - centre).max(), 0.0
            nearest, out_of_sight = np.full(FACE_COUNT, NEAREST * reach), hidden(surface.item, layer)
        else:
            nearest, out_of_sight = near_distances(reached - centre), nullcontext()
            nearest = np.maximum(nearest, space.clip_start)
            own = float(np.linalg.norm(reached - centre, axis=-1).max())
        with bare(space), out_of_sight:
            for face in faces:
                projection = face_projection(nearest[face], max(space.clip_end, 2.0 * nearest[face]))
                seen = self._camera.see(view.scene, view.layer[1], space, face_view(face, centre), projection)
                self.gpu_map_set.set_face(face, seen)
            if isinstance(self.gpu_map_set, GpuLivePyramid):
                suns = suns_above(view.scene, view.depsgraph, space.shading, centre, own)
                self.gpu_map_set.set_lamps(*suns)
