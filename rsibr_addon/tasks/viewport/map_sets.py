"""The map sets that viewports shade from: uploaded once, and kept for a while after."""

from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ...host.live_light import is_live_name
from ...host.map_sets import written_path
from ...host.visible_surfaces import Surface
from ..methods.kinds import open_map_set
from ..methods.live_materials import LiveFits
from .live_light import LiveLight

KEPT_BYTES = 512 * 2**20
"""What map sets that no object uses may take on the GPU."""

TEXEL_BYTES = 16
"""Bytes of a texel of most textures; half floats take half."""

type Stamp = tuple[int, int, int]
"""Another for a file that has been written anew."""


@dataclass(frozen=True)
class UploadedMapSet:
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
    """

    kind: str
    gpu_map_set: Any
    stamp: Stamp | None = None
    size: int = 0


def upload_map_set(path: Path, fits: LiveFits) -> UploadedMapSet:
    """Read a map set and put it on the GPU.

    Parameters
    ----------
    path : Path
    fits : LiveFits
        Makes looks of kinds that are live.

    Returns
    -------
    UploadedMapSet

    Raises
    ------
    MapSetError, InputFileError, DeviceError
        As `kinds.open_map_set` and `OpenedMapSet.upload`.
    """
    stamp = stamp_of(path)  # before it is read, so that what is written meanwhile counts as new
    opened = open_map_set(path)
    return UploadedMapSet(opened.kind, opened.upload(fits), stamp, TEXEL_BYTES * opened.texels)


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
        self._kept: dict[str, UploadedMapSet] = {}

    def __len__(self) -> int:
        return len(self._kept)

    def keep(self, name: str, map_set: UploadedMapSet) -> None:
        """Keep a map set of a file, and release the oldest ones beyond `KEPT_BYTES`."""
        if map_set.stamp is not None:
            self._kept[name] = map_set
        while sum(each.size for each in self._kept.values()) > KEPT_BYTES:
            del self._kept[next(iter(self._kept))]

    def take(self, name: str, path: Path) -> UploadedMapSet | None:
        """A map set that was kept under a name, if its file has not changed since."""
        map_set = self._kept.pop(name, None)
        return map_set if map_set and map_set.stamp == stamp_of(path) else None


class MapSets:
    """The map sets, and the live lights, that objects are shaded from.

    Parameters
    ----------
    fits : LiveFits
        See `upload_map_set`.

    Attributes
    ----------
    used : dict
        Path -> UploadedMapSet.
    lights : dict
        Name of a live light -> LiveLight.
    unused : UnusedMapSets
    """

    def __init__(self, fits: LiveFits) -> None:
        self._fits = fits
        self.used: dict[str, UploadedMapSet] = {}
        self.lights: dict[str, LiveLight] = {}
        self.unused = UnusedMapSets()

    def upload(self, surface: Surface) -> None:
        """Have what an object is shaded from on the GPU."""
        path, settings = surface.path, surface.item.rsibr
        if is_live_name(path):
            light = self.lights[path] = LiveLight(int(settings.live.size))
            self.used[path] = UploadedMapSet("mip_chain", light.gpu_map_set)
        else:
            written = written_path(settings)
            self.used[path] = self.unused.take(path, written) or upload_map_set(written, self._fits)

    def is_lit(self, path: str) -> bool:
        """Whether what is uploaded can be drawn: live light is there once all its faces are."""
        light = self.lights.get(path)
        return light is None or light.is_ready

    def keep(self, paths: set[str]) -> None:
        """Let go of what is not used any more, of files in a while."""
        for path in self.used.keys() - paths:
            self.unused.keep(path, self.used.pop(path))
        self.lights = {name: light for name, light in self.lights.items() if name in paths}
