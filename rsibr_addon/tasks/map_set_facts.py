"""What to tell of a map set at a glance."""

import os
from functools import lru_cache
from pathlib import Path
from typing import Any

from ..files.map_set import read_map_set_header
from ..files.map_set_header import content_hash


def map_set_facts(path: Path) -> dict[str, str]:
    """What a map set is and promises, read again only when its file changes.

    Parameters
    ----------
    path : Path

    Returns
    -------
    dict
        In words: what -> which.

    Raises
    ------
    MapSetError
        See `read_map_set_header`.
    """
    return _facts(path, *_state(path))


def map_set_content(path: Path) -> str:
    """The `content_hash` of a map set, computed again only when its file changes.

    Raises
    ------
    MapSetError
        See `read_map_set_header`.
    """
    return _content(path, *_state(path))


def _state(path: Path) -> tuple[int, int]:
    """Of a file, what changes when it does: the time, and its size."""
    try:
        status = os.stat(path)
    except OSError:
        return 0, 0
    return status.st_mtime_ns, status.st_size


@lru_cache(maxsize=64)
def _facts(path: Path, changed: int, size: int) -> dict[str, str]:
    header = read_map_set_header(path)
    material = header["material"]
    named = material.get("name") or material.get("brdf")
    return {
        "Kind": header["kind"].replace("_", " ").capitalize(),
        "Light": Path(header["environment"]["name"]).stem,
        **({"Material": str(named)} if named else {}),
        "Maps": f"{len(header['parts'])}, {header['size'][0]} x {header['size'][1]}",
        **{_words(name): _number(value) for name, value in (header["error_bound"] or {}).items()},
    }


@lru_cache(maxsize=64)
def _content(path: Path, changed: int, size: int) -> str:
    return content_hash(read_map_set_header(path))


def _words(name: str) -> str:
    return f"Error: {name.replace('_', ' ')}"


def _number(value: Any) -> str:
    """The largest of several, as an error is."""
    return f"{max(value) if isinstance(value, list) else value:.2g}"
