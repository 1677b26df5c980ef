"""What viewports would show without previews: Blender's own shading, for differences from it."""

from dataclasses import dataclass
from typing import Any

from ...device.viewport_camera import ViewportCamera
from ...host.live_light import appearance_of, bare
from ...host.visible_surfaces import View


@dataclass
class _Picture:
    """Attributes: the camera and its size; what was seen, and its texture."""

    camera: ViewportCamera
    size: tuple[int, int]
    seen: tuple[object, ...] = ()
    texture: Any = None


class BlenderPictures:
    """A picture for each viewport that shows a difference, rendered again after each change."""

    def __init__(self) -> None:
        self._pictures: dict[int, _Picture] = {}
        self._scenes = 0

    def scene_changed(self) -> None:
        """Have all pictures rendered anew."""
        self._scenes += 1

    def of(self, view: View) -> Any:
        """The picture of a viewport, as it was rendered last; None before that."""
        picture = self._pictures.get(view.number)
        return picture.texture if picture and picture.size == view.size else None

    def render(self, view: View) -> bool:
        """Render the picture of a viewport, if it shows something else than before.

        Parameters
        ----------
        view : View
            The one whose pixels Blender is drawing.

        Returns
        -------
        bool
            Whether the picture is another one.
        """
        sight, projection = view.matrices
        seen = (sight.tobytes(), projection.tobytes(), appearance_of(view.space), view.layer, self._scenes)
        picture = self._pictures.get(view.number)
        if picture is None or picture.size != view.size:
            picture = self._pictures[view.number] = _Picture(ViewportCamera(*view.size), view.size)
        if picture.seen == seen:
            return False
        with bare(view.space):
            picture.texture = picture.camera.see(view.scene, view.layer[1], view.space, sight, projection)
        picture.seen = seen
        return True
