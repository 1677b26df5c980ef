"""How scenes show radiance, on the GPU."""

from typing import Any

from ...core.conventions import Array
from ...core.pictures.display import table_radiance
from ...device import buffers
from ...host.display import (
    Display,
    SurfaceDisplay,
    display_of,
    displayed_colours,
    scale_before_display,
    surface_display,
)
from ...host.working_space import works_in_rec709

KEPT = 4
"""Tables of 7 MB each, so that one can switch between view transforms."""


class Displays:
    """Tables of displayed colours, each learnt once and uploaded when it is drawn with."""

    def __init__(self) -> None:
        self._learnt: dict[Display, Array] = {}
        self.textures: dict[Display, Any] = {}
        self.scene_changed()

    def scene_changed(self) -> None:
        """Read settings anew when they are asked for next: Blender takes long to say them."""
        self._in_rec709: bool | None = None
        self._read: dict[int, tuple[Display, float]] = {}  # by the number of the scene

    def learn(self, scene: Any) -> None:
        """Learn how a scene shows radiance; not while a view is being drawn, as data come and go for it."""
        self._learnt[display_of(scene)] = displayed_colours(scene, table_radiance())

    def of(self, scene: Any) -> tuple[Any, float]:
        """The texture of how a scene shows radiance, None until it is learnt; and the scale before it."""
        display, scale = self._settings(scene)
        if display in self._learnt:
            while len(self.textures) >= KEPT:
                del self.textures[next(iter(self.textures))]
            self.textures[display] = buffers.table_texture(self._learnt.pop(display))
        return self.textures.get(display), scale

    def of_surfaces(self, scene: Any, space: Any) -> SurfaceDisplay | None:
        """How the colours of a viewport's surfaces come to the display.

        Returns
        -------
        SurfaceDisplay or None
            None as `surface_display`, or where the file's working space is not Rec. 709.
        """
        if self._in_rec709 is None:
            self._in_rec709 = works_in_rec709()
        display, _ = self._settings(scene)
        return surface_display(scene, space, display) if self._in_rec709 else None

    def _settings(self, scene: Any) -> tuple[Display, float]:
        # A curve's points change without notice
        if scene.session_uid not in self._read or scene.view_settings.use_curve_mapping:
            self._read[scene.session_uid] = display_of(scene), scale_before_display(scene)
        return self._read[scene.session_uid]
