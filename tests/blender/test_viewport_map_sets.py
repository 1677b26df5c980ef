"""Which map sets stay on the GPU when no object uses them."""

from pathlib import Path

import pytest
from rsibr.rsibr_addon.tasks.viewport import map_sets as viewport_map_sets
from rsibr.rsibr_addon.tasks.viewport.map_sets import UnusedMapSets, UploadedMapSet, stamp_of


class Nothing:
    """Takes no memory at all."""

    def draw(self, mesh: object, draw: object, look: object) -> None:
        """Draw nothing."""


def uploaded(path: Path, size: int) -> UploadedMapSet:
    return UploadedMapSet("mip_chain", Nothing(), stamp_of(path), size)


def test_the_oldest_leave_when_there_is_no_room(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(viewport_map_sets, "KEPT_BYTES", 10)
    unused, paths = UnusedMapSets(), [tmp_path / name for name in "abcd"]
    for path in paths:
        path.write_text("maps")
    kept = [uploaded(path, 4) for path in paths]
    for path, map_set in zip(paths[:3], kept[:3], strict=True):
        unused.keep(str(path), map_set)
    assert len(unused) == 2
    assert unused.take(str(paths[0]), paths[0]) is None
    assert unused.take(str(paths[1]), paths[1]) is kept[1]
    assert unused.take(str(paths[1]), paths[1]) is None
    unused.keep(str(paths[3]), uploaded(paths[3], 11))
    assert len(unused) == 0


def test_what_has_been_written_anew_or_is_gone_is_not_kept(tmp_path: Path) -> None:
    unused, path = UnusedMapSets(), tmp_path / "maps"
    path.write_text("maps")
    unused.keep("maps", uploaded(path, 4))
    path.write_text("others")
    assert unused.take("maps", path) is None
    unused.keep("maps", uploaded(path, 4))
    path.unlink()
    assert unused.take("maps", path) is None


def test_light_that_is_rendered_is_not_kept() -> None:
    unused = UnusedMapSets()
    unused.keep("live", UploadedMapSet("mip_chain", Nothing()))
    assert len(unused) == 0
