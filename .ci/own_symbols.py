"""Have the library of a Linux wheel call its own functions, also where its program has others of their names.

Linux looks functions up in the program and its libraries first. The OpenEXR package is one library whose C
functions are visible, as are those of Blender's OpenEXR. Where that is of another version, the package would
call functions that take objects of another layout. A library with DT_SYMBOLIC is searched first itself.
"""

import base64
import hashlib
import struct
import zipfile
from collections.abc import Iterator
from pathlib import Path

DT_NULL, DT_SYMBOLIC = 0, 16
"""Tags of entries of a dynamic section."""

_PT_DYNAMIC = 2
_ENTRY, _SEGMENT = struct.Struct("<qQ"), struct.Struct("<IIQQQQQQ")
_ELF_64 = b"\x7fELF\x02\x01"


def bind_wheel_to_itself(path: Path) -> None:
    """Give each library of a wheel DT_SYMBOLIC; one that has it stays as it is.

    Parameters
    ----------
    path : Path
        For Linux and processors of 64 bits, little-endian; replaced.
    """
    with zipfile.ZipFile(path) as wheel:
        files = {each: wheel.read(each) for each in wheel.infolist()}
    bound = {
        each.filename: bound_to_itself(content)
        for each, content in files.items()
        if _is_library(each.filename)
    }
    if all(bound.get(each.filename, content) == content for each, content in files.items()):
        return
    aside = path.with_suffix(".aside")
    with zipfile.ZipFile(aside, "w") as wheel:
        for each, content in files.items():
            if each.filename.endswith(".dist-info/RECORD"):
                content = _recorded(content.decode(), bound).encode()
            wheel.writestr(each, bound.get(each.filename, content), zipfile.ZIP_DEFLATED)
    aside.replace(path)


def bound_to_itself(library: bytes) -> bytes:
    """A library with DT_SYMBOLIC, in place of a spare entry of its dynamic section.

    Raises
    ------
    ValueError
        It is of another kind, or has no spare entry.
    """
    if not library.startswith(_ELF_64):
        raise ValueError("not a library of 64 bits, little-endian, for Linux")
    entries = list(_dynamic_entries(library))
    if any(tag == DT_SYMBOLIC for _, tag in entries):
        return library
    spare = [place for place, tag in entries if tag == DT_NULL]
    if len(spare) < 2:  # the last one ends the section
        raise ValueError("no room in the dynamic section")
    bound = bytearray(library)
    _ENTRY.pack_into(bound, spare[0], DT_SYMBOLIC, 0)
    return bytes(bound)


def _dynamic_entries(library: bytes) -> Iterator[tuple[int, int]]:
    """Place and tag of each entry."""
    (segments,), (size, count) = struct.unpack_from("<Q", library, 32), struct.unpack_from("<HH", library, 54)
    for number in range(count):
        kind, _, place, _, _, length, *_ = _SEGMENT.unpack_from(library, segments + number * size)
        if kind == _PT_DYNAMIC:
            for entry in range(place, place + length, _ENTRY.size):
                yield entry, _ENTRY.unpack_from(library, entry)[0]


def _is_library(name: str) -> bool:
    return name.endswith(".so") or ".so." in name


def _recorded(record: str, bound: dict[str, bytes]) -> str:
    """A wheel's list of its files, with the hashes of those that were changed."""
    lines = []
    for line in record.splitlines():
        name = line.split(",")[0]
        if name in bound:
            digest = base64.urlsafe_b64encode(hashlib.sha256(bound[name]).digest()).rstrip(b"=").decode()
            line = f"{name},sha256={digest},{len(bound[name])}"
        lines.append(line)
    return "\n".join(lines) + "\n"
