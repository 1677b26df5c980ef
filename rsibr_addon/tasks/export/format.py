"""What an export format is, and what it starts from."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ...core.errors import RangeError
from ...core.options import Options
from ...files.kinds.registry import STORED
from ...files.map_set_data import MapSet
from ...files.textures import Texture, Up, arrays


@dataclass(frozen=True)
class Format:
    """A way to write map sets for other programs.

    Attributes
    ----------
    label : str
        In a menu.
    suffix : str
        Ending of its files' names, in small letters: ".ktx2".
    settings : type
        Its options, which all have defaults.
    write : callable
        The map set's file, for messages; what it holds; the output; settings; and whether existing files are
        replaced, to the files that were written.
    """

    label: str
    suffix: str
    settings: type[Options]
    write: Callable[[Path, MapSet, Path, Any, bool], list[Path]]


def textures_of(path: Path, map_set: MapSet, up: Up) -> list[Texture]:
    """The textures that hold all of a map set but its environment.

    Parameters
    ----------
    path : Path
        Its file, for messages.
    map_set : MapSet
    up : Up

    Raises
    ------
    RangeError
        `up` is Y, and maps of this kind are looked up by directions with Z up.
    MapSetError
        The map set is not what its kind must be.
    """
    stored = STORED[map_set.kind]
    if stored.textures is not None:
        return stored.textures(path, map_set, up)
    if up is Up.Y:
        raise RangeError(
            f"The maps of {path} cannot be turned: export it with Z up, and look it up by (x, -z, y)."
        )
    return arrays(stored.shaded(path, map_set), stored.numbers)
