"""Pictures in panels: of the shown map set's maps and lobes, made aside while Blender goes on."""

from concurrent.futures import Future, ThreadPoolExecutor
from pathlib import Path
from typing import Any

import bpy
import bpy.utils.previews
from bpy.app.handlers import persistent

from ..core.errors import MapSetError
from ..core.lobes.fit import Fit
from ..files.read_once import file_stamp
from ..host.icons import add_icon
from ..host.sidebars import redraw_sidebars
from ..tasks.reflectance.fit_plots import lobe_picture
from ..tasks.report.pictures import MapPicture, map_set_pictures

SECONDS = 0.1
"""Between two looks at whether a file has been read."""

Item = tuple[str, str, str, int, int]
"""Item of an enumeration: identifier, name, description, icon, number."""


class MapPictures:
    """Pictures of one map set at a time, kept while its file stays the same.

    Parameters
    ----------
    has_windows : bool
        Without windows, there is nothing to show in.

    Attributes
    ----------
    items : list of Item
        One for each map that there is a picture of; empty while the file is being read.
    fault : str
        Why there will be none; empty else.
    """

    def __init__(self, has_windows: bool) -> None:
        self.items: list[Item] = []
        self.fault = ""
        self._shown: tuple[Path, tuple[int, int] | None] | None = None
        self._read: Future[list[MapPicture]] | None = None
        self._lobes: float | None = None
        # Blender knows a timer and a handler by their objects, and each look at a method makes another.
        self._timer = self._take
        self._closed = persistent(lambda *_: self._forget())
        self._icons: Any = None  # A bpy.utils.previews.ImagePreviewCollection
        self._reader: ThreadPoolExecutor | None = None
        if has_windows:
            self._icons = bpy.utils.previews.new()
            self._reader = ThreadPoolExecutor(1, "rsibr-map-pictures")
            bpy.app.handlers.load_pre.append(self._closed)

    def show(self, path: Path) -> None:
        """Have `items` be of this map set: at once, or when its file has been read."""
        shown = path, file_stamp(path)
        if shown == self._shown or self._reader is None:
            return
        self._forget()
        self._shown = shown
        self._read = self._reader.submit(map_set_pictures, path)
        bpy.app.timers.register(self._timer, first_interval=SECONDS, persistent=True)

    def lobes(self, fit: Fit, mu: float) -> int:
        """The icon of the lobes of the map set that is shown.

        Parameters
        ----------
        fit : Fit
            What it tells of them.
        mu : float
            n.v, in (0, 1].
        """
        if self._lobes != mu:
            self._icons.pop("lobes", None)
            add_icon(self._icons, "lobes", lobe_picture(fit, mu))
            self._lobes = mu
        return int(self._icons["lobes"].icon_id)

    def close(self) -> None:
        """Let go of everything."""
        if self._reader is not None:
            self._forget()
            bpy.app.handlers.load_pre.remove(self._closed)
            self._reader.shutdown()
            bpy.utils.previews.remove(self._icons)

    def _take(self) -> float | None:
        """Take what has been read."""
        if self._read is None:
            return None
        if not self._read.done():
            return SECONDS
        try:
            pictures = self._read.result()
        except MapSetError as error:
            self.fault, pictures = str(error), []
        for number, picture in enumerate(pictures):
            icon = add_icon(self._icons, picture.name, picture.pixels)
            self.items.append((picture.name, picture.title, picture.name, icon, number))
        redraw_sidebars()
        return None

    def _forget(self) -> None:
        if bpy.app.timers.is_registered(self._timer):
            bpy.app.timers.unregister(self._timer)
        self.items.clear()
        self._icons.clear()
        self.fault = ""
        self._shown = self._read = self._lobes = None
