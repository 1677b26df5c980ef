"""Facts of map sets for panels."""

from pathlib import Path
from typing import Any

from ...core.lobes.fit import Fit
from ...files.kinds import environment
from ...files.kinds.registry import STORED
from ...files.map_set import read_map_set_header
from ...files.map_set_facts import told_errors, told_facts
from ...files.map_set_header import content_hash
from ...files.read_once import read_once


@read_once
def map_set_header(path: Path) -> dict[str, Any]:
    """The description of a map set; not to be changed.

    Raises
    ------
    MapSetError
        See `files.map_set.read_map_set_header`; so with all others here.
    """
    return read_map_set_header(path)


@read_once
def is_picture(path: Path) -> bool:
    """Whether a file that shades is no map set, but a picture of an environment."""
    return environment.is_environment(path)


@read_once
def map_set_content(path: Path) -> str:
    """Hash of what a map set holds: see `files.map_set_header.content_hash`."""
    return content_hash(map_set_header(path))


@read_once
def map_set_fit(path: Path) -> Fit | None:
    """The lobes that a map set was made of; None where there are none, or it does not tell them."""
    header = map_set_header(path)
    return STORED[header["kind"]].lobes(path, header)


@read_once
def map_set_facts(path: Path) -> dict[str, str]:
    """What a map set is and promises: see `files.map_set_facts`."""
    header = map_set_header(path)
    return told_facts(header) | told_errors(header)
