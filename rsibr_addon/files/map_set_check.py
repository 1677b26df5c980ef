"""Whether a description is one of a map set: docs/map-set-format.md in code."""

from collections.abc import Iterator
from itertools import chain
from typing import Any

from ..core.errors import MapSetError, SchemaError
from ..core.schema import decode
from .kinds.registry import STORED
from .map_set_data import ENVIRONMENT
from .map_set_header import FORMAT, Header, StoredKind


def check_header(header: Any, name: str) -> None:
    """Check the description of a map set against the format.

    Parameters
    ----------
    header : object
        The decoded JSON text.
    name : str
        The file, for messages.

    Raises
    ------
    MapSetError
        It is of a newer version or an unknown kind; a field is missing or not what it must be; two parts have
        one name; the environment's part is missing; or the kind's own `problems` find one.
    """
    if not isinstance(header, dict) or type(header.get("format")) is not int or header["format"] < 1:
        raise MapSetError(f"{name} states no format version, so it is no map set: make it again.")
    if header["format"] > FORMAT:
        raise MapSetError(
            f"{name} was written by a newer RSIBR (format {header['format']}; this one reads {FORMAT}): "
            f"update RSIBR."
        )
    kind = header.get("kind")
    if not isinstance(kind, str) or kind not in STORED:
        raise MapSetError(f"{name} is a map set of unknown kind {kind!r:.40}: update, or make it again.")
    try:
        _check_types(header, STORED[kind])
    except SchemaError as error:
        raise MapSetError(f"{name} is not a whole map set ({error}): make it again.") from error
    for problem in chain(_problems(header), STORED[kind].problems(header)):
        raise MapSetError(f"{name} is not a whole map set ({problem}): make it again.")


def _check_types(header: dict[str, Any], stored: StoredKind) -> None:
    decode(Header, header)
    decode(stored.material, header["material"], "material")
    for number, part in enumerate(header["parts"]):
        if part["role"] in stored.roles:
            decode(stored.roles[part["role"]], part, f"parts[{number}]")


def _problems(header: dict[str, Any]) -> Iterator[str]:
    """Contradictions between fields that are valid alone."""
    parts = {part["name"]: part for part in header["parts"]}
    if len(parts) < len(header["parts"]):
        yield "two parts have one name"
    yield from _environment_problems(header["environment"], parts)


def _environment_problems(environment: dict[str, Any], parts: dict[str, dict[str, Any]]) -> Iterator[str]:
    name = environment["part"]
    if name is None:
        return
    if name not in parts or parts[name]["role"] != ENVIRONMENT:
        yield f"environment.part names {name!r}, which is no part with that role"
    elif parts[name]["size"] != environment["size"]:
        yield f"part {name!r} has another size than environment.size"
