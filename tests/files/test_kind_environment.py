"""Pictures of environments, told from map sets."""

from pathlib import Path

import numpy as np
import pytest
from rsibr.rsibr_addon.core.errors import MapSetError, RsibrWarning
from rsibr.rsibr_addon.files.kinds.environment import from_map_set, is_environment, read_as_map_set
from rsibr.rsibr_addon.files.map_set import read_map_set
from rsibr.rsibr_addon.files.radiance_pictures import write_radiance
from rsibr.tests.mirror_capture import environment, mirror_map_set, write_mirror_capture


@pytest.mark.parametrize("name", ["forest.exr", "forest.hdr", "forest.rsibr.exr"])
def test_a_picture_stands_for_itself(tmp_path: Path, name: str) -> None:
    light = environment(16)
    write_radiance(tmp_path / name, light.radiance)
    assert is_environment(tmp_path / name)
    read = from_map_set(tmp_path / name, read_as_map_set(tmp_path / name))
    assert read.name == name
    # Radiance HDR keeps 8 bits of the largest channel.
    np.testing.assert_allclose(read.radiance, light.radiance, atol=light.radiance.max() / 128.0)


def test_a_picture_is_clamped(tmp_path: Path) -> None:
    light = environment(16)
    write_radiance(tmp_path / "forest.exr", light.radiance)
    clamp = float(np.median(light.radiance))
    with pytest.warns(RsibrWarning, match=r"forest\.exr holds \d+ values above"):
        map_set = read_as_map_set(tmp_path / "forest.exr", clamp)
    read = from_map_set(tmp_path / "forest.exr", map_set).radiance
    np.testing.assert_array_equal(read, np.minimum(light.radiance, np.float32(clamp)))


def test_map_sets_and_what_is_neither_are_no_pictures(tmp_path: Path) -> None:
    map_set = write_mirror_capture(tmp_path / "mirror.rsibr.exr", size=16)
    assert not is_environment(map_set)
    (tmp_path / "text.exr").write_text("no picture")
    (tmp_path / "cut.exr").write_bytes(map_set.read_bytes()[:64])
    for name in ("text.exr", "cut.exr", "missing.exr", "."):
        assert not is_environment(tmp_path / name)


def test_a_map_set_has_the_environment_that_it_holds(tmp_path: Path) -> None:
    path = write_mirror_capture(tmp_path / "mirror.rsibr.exr", size=16)
    assert from_map_set(path, read_map_set(path)).sha256 == environment().sha256
    without = mirror_map_set(size=16)
    without.header["environment"]["part"] = None
    with pytest.raises(MapSetError, match="give that as a picture"):
        from_map_set(path, without)
