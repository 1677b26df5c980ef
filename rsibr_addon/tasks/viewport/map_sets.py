"""The map sets that viewports shade from: uploaded once, and kept for a while after."""

from dataclasses import dataclass
from pathlib import Path

from ...device.drawing import GpuMapSet
from ..methods.kinds import open_map_set

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
    gpu_map_set : GpuMapSet
    stamp : Stamp or None
        The file that it was read from, as it was then; None for light that is rendered.
    size : int
        Bytes that it takes on the GPU, about.
    """

    kind: str
    gpu_map_set: GpuMapSet
    stamp: Stamp | None = None
    size: int = 0


def upload_map_set(path: Path) -> UploadedMapSet:
    """Read a map set and put it on the GPU.

    Parameters
    ----------
    path : Path

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
    return UploadedMapSet(opened.kind, opened.upload(), stamp, TEXEL_BYTES * opened.texels)


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
