"""Which map sets stay on the GPU when no object uses them."""

import warnings
from pathlib import Path

import numpy as np
import pytest
from rsibr.rsibr_addon.core.errors import MapSetError
from rsibr.rsibr_addon.files.map_set import write_map_set
from rsibr.rsibr_addon.files.pictures import write_exr
from rsibr.rsibr_addon.tasks.methods.live_materials import LiveFits
from rsibr.rsibr_addon.tasks.viewport import map_sets as viewport_map_sets
from rsibr.rsibr_addon.tasks.viewport.map_sets import UnusedMapSets, ViewportMapSet, read_if_new, stamp_of
from rsibr.tests.faults.small_map_sets import map_sets


class Nothing:
    """Takes no memory at all."""

    textures = ()

    def draw(self, mesh: object, draw: object, look: object) -> None:
        """Draw nothing."""


def uploaded(path: Path, size: int) -> ViewportMapSet:
    return ViewportMapSet("mip_chain", Nothing(), stamp_of(path), size)


def test_the_oldest_leave_when_there_is_no_room(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(viewport_map_sets, "KEPT_BYTES", 10)
    unused, paths = UnusedMapSets(), [tmp_path / name for name in "abcd"]
    for path in paths:
        path.write_text("maps")
    kept = [uploaded(path, 4) for path in paths]
    for path, map_set in zip(paths[:3], kept[:3], strict=True):
        unused.keep(str(path), map_set)
    assert len(unused) == 2
    assert unused.take(str(paths[0])) is None
    assert unused.take(str(paths[1])) is kept[1]
    assert unused.take(str(paths[1])) is None
    unused.keep(str(paths[3]), uploaded(paths[3], 11))
    assert len(unused) == 0


def test_what_has_been_written_anew_is_read_anew(tmp_path: Path) -> None:
    path = tmp_path / "chain.rsibr.exr"
    (chain,) = (each for each in map_sets() if each.kind == "mip_chain")
    write_map_set(path, chain)
    read = read_if_new(path, LiveFits(), None)
    assert read is not None
    assert read.kind == "mip_chain"
    assert read_if_new(path, LiveFits(), read.stamp) is None
    write_map_set(path, chain, force=True)
    assert read_if_new(path, LiveFits(), read.stamp) is not None
    path.unlink()
    with pytest.raises(MapSetError):
        read_if_new(path, LiveFits(), read.stamp)


def test_what_reading_tells_comes_with_what_was_read(tmp_path: Path) -> None:
    radiance = np.ones((8, 16, 4), np.float32)
    radiance[2, 3, 0] = -1.0
    write_exr(tmp_path / "light.exr", radiance)
    with warnings.catch_warnings(action="error"):
        read = read_if_new(tmp_path / "light.exr", LiveFits(), None)
    assert read is not None
    (warning,) = read.warnings
    assert "light.exr" in warning
    assert "negative" in warning


def test_light_that_is_rendered_is_not_kept() -> None:
    unused = UnusedMapSets()
    unused.keep("live", ViewportMapSet("mip_chain", Nothing()))
    assert len(unused) == 0
