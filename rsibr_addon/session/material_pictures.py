"""The picture of the material that a panel shows, made aside while Blender goes on."""

from concurrent.futures import Future, ThreadPoolExecutor
from typing import Any

import bpy
import bpy.utils.previews

from ..core.conventions import Array
from ..core.errors import RsibrError
from ..host.icons import add_icon
from ..host.sidebars import redraw_sidebars
from ..tasks.reflectance.material_picture import material_picture

SECONDS = 0.05
"""Between two looks at whether a picture has been made."""

MOST = 64
"""Pictures that are kept."""


class MaterialPictures:
    """Pictures by the texts of models; while a slider moves, one at a time, the last one next.

    Parameters
    ----------
    has_windows : bool
        Without windows, there is nothing to show in.
    """

    def __init__(self, has_windows: bool) -> None:
        self._kept: dict[str, int] = {}  # Text of a model -> its icon; 0 for one that is none
        self._shown, self._wanted, self._at_work = 0, "", ""
        self._making: Future[Array] | None = None
        # Blender knows a timer by its object, and each look at a method makes another
        self._timer = self._take
        self._icons: Any = None  # A bpy.utils.previews.ImagePreviewCollection
        self._maker: ThreadPoolExecutor | None = None
        if has_windows:
            self._icons = bpy.utils.previews.new()
            self._maker = ThreadPoolExecutor(1, "rsibr-material-pictures")

    def icon(self, spec: str) -> int:
        """The icon of a model, or while it is made that of the one before; 0 where there is none.

        Parameters
        ----------
        spec : str
            Text of a model.
        """
        self._wanted = spec
        if spec in self._kept:
            self._shown = self._kept[spec]
        elif self._making is None:
            self._make()
        return self._shown

    def close(self) -> None:
        """Let go of everything."""
        if self._maker is not None:
            if bpy.app.timers.is_registered(self._timer):
                bpy.app.timers.unregister(self._timer)
            self._maker.shutdown()
            bpy.utils.previews.remove(self._icons)

    def _make(self) -> None:
        if self._maker is None:
            return
        self._at_work = self._wanted
        self._making = self._maker.submit(material_picture, self._at_work)
        if not bpy.app.timers.is_registered(self._timer):
            bpy.app.timers.register(self._timer, first_interval=SECONDS, persistent=True)

    def _take(self) -> float | None:
        """Take what has been made, and begin what is wanted now."""
        if self._making is not None and self._making.done():
            self._keep(self._at_work, self._making)
            self._making = None
            redraw_sidebars()
            if self._wanted not in self._kept:
                self._make()
        return None if self._making is None else SECONDS

    def _keep(self, spec: str, made: Future[Array]) -> None:
        if len(self._kept) >= MOST:
            self._kept.clear()
            self._icons.clear()
        try:
            self._kept[spec] = add_icon(self._icons, spec, made.result())
        except RsibrError:  # The viewport's own try tells why
            self._kept[spec] = 0
        self._shown = self._kept[spec]
