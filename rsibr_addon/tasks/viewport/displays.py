"""How scenes show radiance, on the GPU."""

from typing import Any

from ...core.conventions import Array
from ...core.pictures.display import table_radiance
from ...device import buffers
from ...host.display import Display, display_of, displayed_colours, scale_before_display

KEPT = 4
"""Tables of 7 MB each, so that one can switch between view transforms."""


class Displays:
    """Tables of displayed colours, each learnt once and uploaded when it is drawn with."""

    def __init__(self) -> None:
        self._learnt: dict[Display, Array] = {}
        self.textures: dict[Display, Any] = {}

    def learn(self, scene: Any) -> None:
        """Learn how a scene shows radiance; not while a view is being drawn, as data come and go for it."""
        self._learnt[display_of(scene)] = displayed_colours(scene, table_radiance())

    def of(self, scene: Any) -> tuple[Any, float]:
        """The texture of how a scene shows radiance, None until it is learnt; and the scale before it."""
        display, scale = display_of(scene), scale_before_display(scene)
        if display in self._learnt:
            while len(self.textures) >= KEPT:
                del self.textures[next(iter(self.textures))]
            self.textures[display] = buffers.table_texture(self._learnt.pop(display))
        return self.textures.get(display), scale
