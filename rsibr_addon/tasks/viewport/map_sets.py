"""The map sets that viewports shade from: read aside, uploaded piece by piece, and kept for a while after."""

from collections.abc import Iterable
from concurrent.futures import Executor, Future
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from ...core.environment import Environment
from ...core.warned import recorded_warnings
from ...device.backdrop import Backdrop
from ...host.live_light import is_live_name
from ...host.map_sets import written_path
from ...host.visible_surfaces import Surface
from ..methods.kinds import KINDS, darkness, live_map_set, open_map_set, own_materials_kind
from ..methods.live_materials import LiveFits
from .live_light import LiveLight

KEPT_BYTES = 512 * 2**20
"""What map sets that no object uses may take on the GPU."""

TEXEL_BYTES = 16
"""Bytes of a texel of most textures; half floats take half."""

PIECE_BYTES = 16 * 2**20
"""What a redraw uploads: it takes Mesa's software driver some 20 ms."""

DARKNESS = "darkness\0"
"""What stands for the file of a world that is not there: a name that no file can have."""

NO_LIGHT = Environment(np.zeros((2, 4, 3), np.float32), "no world")

Stamp = tuple[int, int, int]
"""Another for a file that has been written anew."""


@dataclass(frozen=True)
class ViewportMapSet:
    """What objects are shaded from.

    Attributes
    ----------
    kind : str
        See `kinds.KINDS`.
    gpu_map_set : GpuMapSet, or LiveGpuMapSet of a kind that is live
    stamp : Stamp or None
        The file that it was read from, as it was then; None for light that is rendered.
    size : int
        Bytes that it takes on the GPU, about.
    warnings : tuple of str
        What reading it had to tell.
    backdrop : Backdrop or None
        Of a kind that shades own materials: its environment, to be seen behind them.
    """

    kind: str
    gpu_map_set: Any
    stamp: Stamp | None = None
    size: int = 0
    warnings: tuple[str, ...] = ()
    backdrop: Backdrop | None = None


def read_if_new(path: Path, fits: LiveFits, known: Stamp | None) -> ViewportMapSet | None:
    """Read a map set, all of which but the upload is done then; without Blender's data, in any thread.

    Parameters
    ----------
    path : Path
    fits : LiveFits
        Makes looks of kinds that are live.
    known : Stamp or None
        The file as it was read before.

    Returns
    -------
    ViewportMapSet or None
        None where the file is still the same.

    Raises
    ------
    MapSetError, InputFileError, DeviceError
        As `kinds.open_map_set` and `OpenedMapSet.drawable`.
    """
    stamp = stamp_of(path)  # before it is read, so that what is written meanwhile counts as new
    if stamp is not None and stamp == known:
        return None
    with recorded_warnings() as warnings:
        opened = open_map_set(path)
        drawable = opened.drawable(fits)
    light = opened.environment if KINDS[opened.kind].own else None
    backdrop = None if light is None else Backdrop(light)
    size = TEXEL_BYTES * opened.texels
    return ViewportMapSet(opened.kind, drawable, stamp, size, tuple(warnings), backdrop)


def stamp_of(path: Path) -> Stamp | None:
    """A file as it is now; None where it is not there."""
    try:
        status = path.stat()
    except OSError:
        return None
    return status.st_ino, status.st_size, status.st_mtime_ns


class UnusedMapSets:
    """Map sets that objects used lately: they need no upload when they are used again."""

    def __init__(self) -> None:
        self._kept: dict[str, ViewportMapSet] = {}

    def __len__(self) -> int:
        return len(self._kept)

    def keep(self, name: str, map_set: ViewportMapSet) -> None:
        """Keep a map set of a file, and release the oldest ones beyond `KEPT_BYTES`."""
        if map_set.stamp is not None:
            self._kept[name] = map_set
        while sum(each.size for each in self._kept.values()) > KEPT_BYTES:
            del self._kept[next(iter(self._kept))]

    def take(self, name: str) -> ViewportMapSet | None:
        """A map set that was kept under a name; its file may have changed since."""
        return self._kept.pop(name, None)


@dataclass(frozen=True)
class _Coming:
    """A map set on its way.

    Attributes
    ----------
    read : Future
        See `read_if_new`. What is on the GPU is not given to the thread, which must not free it.
    known : ViewportMapSet or None
        That of the file as it was read before.
    """

    read: Future[ViewportMapSet | None]
    known: ViewportMapSet | None


class MapSets:
    """The map sets, and the live lights, that objects are shaded from.

    Parameters
    ----------
    fits : LiveFits
    reader : Executor
        Reads files: see `read_if_new`.

    Attributes
    ----------
    used : dict
        Path -> ViewportMapSet that is whole on the GPU.
    lights : dict
        Name of a live light -> LiveLight.
    unused : UnusedMapSets
    """

    def __init__(self, fits: LiveFits, reader: Executor) -> None:
        self._fits, self._reader = fits, reader
        self.used: dict[str, ViewportMapSet] = {}
        self.lights: dict[str, LiveLight] = {}
        self.unused = UnusedMapSets()
        self._coming: dict[str, _Coming] = {}
        self._shown: dict[int, ViewportMapSet] = {}  # by the number of the object
        self._has_come = False
        self._bytes_left = 0

    @property
    def is_busy(self) -> bool:
        """Whether a map set is on its way, so that `take_news` is to be asked."""
        return bool(self._coming)

    def is_coming(self, path: str) -> bool:
        """Whether a map set is being read, or uploaded."""
        return path in self._coming

    def take_news(self) -> bool:
        """Whether a redraw, or its panel, would show more than the last one."""
        has_come, self._has_come = self._has_come, False
        return has_come or any(each.read.done() for each in self._coming.values())

    def begin_frame(self) -> None:
        """Have another piece be uploaded by what follows."""
        self._bytes_left = PIECE_BYTES

    def shading(self, surface: Surface) -> ViewportMapSet | None:
        """What an object is shaded from: until that is whole, what it was shaded from before.

        Returns
        -------
        ViewportMapSet or None
            None where there is nothing yet.

        Raises
        ------
        OutputFileError
            As `host.map_sets.written_path`.
        MapSetError, InputFileError, DeviceError
            As `read_if_new`, or it is too large for the device.
        """
        path, item = surface.path, surface.number
        try:
            self._fetch(path, None if surface.in_world else surface.item)
        except Exception:  # Whatever it was, told by the caller: a stale picture must not stay
            self._shown.pop(item, None)
            raise
        if path in self.used and self._is_lit(path):
            self._shown[item] = self.used[path]
        return self._shown.get(item)

    def world(self, path: str) -> ViewportMapSet | None:
        """A world's map set, once it is whole.

        Parameters
        ----------
        path : str
            See `Worlds.of`.

        Raises
        ------
        MapSetError, InputFileError, DeviceError
            See `shading`.
        """
        self._fetch(path, None)
        return self.used.get(path)

    def shown(self, item: Any) -> ViewportMapSet | None:
        """What an object was shaded from when `shading` was asked last."""
        return self._shown.get(item.original.session_uid)

    def keep(self, surfaces: Iterable[Surface], worlds: Iterable[str] = ()) -> None:
        """Let go of what none of these surfaces and worlds uses any more, of files in a while."""
        shown = {each.number: each.path for each in surfaces}
        paths = {*shown.values(), *worlds}
        for path in self.used.keys() - paths:
            self.unused.keep(path, self.used.pop(path))
        for path in self._coming.keys() - paths:
            self._drop(path)
        self.lights = {name: light for name, light in self.lights.items() if name in paths}
        self._shown = {item: map_set for item, map_set in self._shown.items() if item in shown}

    def _is_lit(self, path: str) -> bool:
        """Whether what is there can be drawn: live light is once all its faces are."""
        light = self.lights.get(path)
        return light is None or light.is_ready

    def _fetch(self, path: str, item: Any) -> None:
        """See to it that a map set, of an object or of the world, is used once it is there."""
        if path in self.used:
            return
        try:
            self._come_nearer(path, item)
        except Exception:  # Whatever it was, told by the caller: half an upload must not stay
            self._drop(path)
            raise

    def _come_nearer(self, path: str, item: Any) -> None:
        """Take the next step on a map set's way: have it read, upload a piece, have it used."""
        if is_live_name(path):
            live = item.rsibr.live
            kind, gpu_map_set = live_map_set(int(live.size), live.degree if live.mips else None)
            self.lights[path] = LiveLight(gpu_map_set)
            self.used[path] = ViewportMapSet(kind, gpu_map_set)
            return
        if path == DARKNESS:
            self.used[path] = ViewportMapSet(own_materials_kind(), darkness(), backdrop=Backdrop(NO_LIGHT))
            return
        if path not in self._coming:
            known = self.unused.take(path)
            stamp = known.stamp if known else None
            file = Path(path) if item is None else written_path(item.rsibr)
            read = self._reader.submit(read_if_new, file, self._fits, stamp)
            self._coming[path] = _Coming(read, known)
        coming = self._coming[path]
        if not coming.read.done():
            return
        map_set = coming.read.result() or coming.known
        assert map_set is not None
        for texture in map_set.gpu_map_set.textures:
            if self._bytes_left > 0:
                self._bytes_left -= texture.upload(self._bytes_left)
        if all(texture.is_whole for texture in map_set.gpu_map_set.textures):
            self.used[path] = map_set
            self._drop(path)

    def _drop(self, path: str) -> None:
        coming = self._coming.pop(path, None)
        if coming is not None:
            coming.read.cancel()
            self._has_come = True
