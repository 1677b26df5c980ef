"""A map set that was cut off or damaged anywhere is refused, in words."""

import re
import struct
import threading
from collections.abc import Callable
from pathlib import Path

import numpy as np
import OpenEXR
import pytest
from rsibr.rsibr_addon.core.errors import MapSetError, RangeError
from rsibr.rsibr_addon.files.map_set import read_map_set, read_map_set_header, write_map_set
from rsibr.rsibr_addon.files.map_set_data import MapSet


@pytest.fixture
def path(tmp_path: Path, make_views: Callable[..., MapSet]) -> Path:
    path = tmp_path / "a.rsibr.exr"
    write_map_set(path, make_views())
    return path


def test_a_truncated_set_is_refused_wherever_it_ends(path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    whole = path.read_bytes()
    # Through headers and tables of offsets in the first third, the pixels, and the last byte alone
    cuts = {0, 1, 3, 4, 8, *np.linspace(9, len(whole) - 2, 120).astype(int).tolist(), len(whole) - 1}
    for length in sorted(cuts):
        path.write_bytes(whole[:length])
        with pytest.raises(MapSetError, match=r"a\.rsibr\.exr is (truncated|not a map set)"):
            read_map_set(path)
    assert capsys.readouterr().out == ""  # where a command's result belongs


def test_the_header_alone_is_refused_when_it_is_cut(path: Path) -> None:
    whole = path.read_bytes()
    end = whole.index(b"sha256", whole.index(b"view001.glossy"))
    for length in range(0, end, end // 25):
        path.write_bytes(whole[:length])
        with pytest.raises(MapSetError):
            read_map_set_header(path)


def test_a_set_that_something_was_appended_to_is_whole(path: Path, make_views: Callable[..., MapSet]) -> None:
    path.write_bytes(path.read_bytes() + b"more")
    np.testing.assert_array_equal(read_map_set(path).maps["environment"], make_views().maps["environment"])


def test_maps_that_the_file_cannot_hold_are_refused_before_they_take_memory(path: Path) -> None:
    with OpenEXR.File(str(path)) as file:
        number = [part.name() for part in file.parts].index("view001.glossy")
    data = bytearray(path.read_bytes())
    attribute = b"dataWindow\0box2i\0" + struct.pack("<i", 16)
    start = [match.end() for match in re.finditer(re.escape(attribute), data)][number]
    for width in (5000, 30000):
        data[start : start + 16] = struct.pack("<4i", 0, 0, width - 1, width - 1)
        path.write_bytes(data)
        with pytest.raises(MapSetError, match="is truncated: it states more than it can hold"):
            read_map_set_header(path)


@pytest.mark.slow
def test_a_flipped_bit_is_found_or_does_no_harm(path: Path, make_views: Callable[..., MapSet]) -> None:
    whole, views = path.read_bytes(), make_views()
    description = range(whole.index(b"rsibr"), whole.index(b"}", whole.index(b'"software"')))
    rng = np.random.default_rng(0)
    refused = 0
    for position in rng.choice(len(whole), 300, replace=False):
        if position in description:
            continue  # it has no checksum of its own
        damaged = bytearray(whole)
        damaged[position] ^= 1 << rng.integers(8)
        path.write_bytes(damaged)
        try:
            back = read_map_set(path)
        except MapSetError:
            refused += 1
        else:
            assert back.header == views.header
            for name, pixels in views.maps.items():
                np.testing.assert_array_equal(back.maps[name], pixels)
    # Compressed pixels are nearly the whole file; what is left is padding and fields that mean nothing here
    assert refused > 250


def test_a_thread_that_cannot_start_is_told(path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def fail(thread: threading.Thread) -> None:
        raise RuntimeError("can't start new thread")

    monkeypatch.setattr(threading.Thread, "start", fail)
    with pytest.raises(RangeError, match="ask for fewer by --threads"):
        read_map_set(path)
