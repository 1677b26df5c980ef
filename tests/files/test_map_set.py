"""Map sets: what is written comes back."""

import hashlib
import os
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import OpenEXR
import pytest
from rsibr.rsibr_addon.core.errors import MapSetError, OutputFileError, RangeError, RsibrWarning, ShapeError
from rsibr.rsibr_addon.files.map_set import read_map_set, read_map_set_header, write_map_set
from rsibr.rsibr_addon.files.map_set_data import MapSet

MakeViews = Callable[..., MapSet]

ELEVATION = {
    "mu": 0.5,
    "taps": [{"tilt": -0.1, "turn": 0.0, "weight": 1.0}],
    "scale": [1.0, 1.0, 1.0],
    "albedo": [0.9, 0.5, 0.2],
}


def test_float_maps_come_back_bit_by_bit(tmp_path: Path, make_views: MakeViews) -> None:
    path = tmp_path / "a.rsibr.exr"
    views = make_views()
    views.maps["view000.glossy"][0, 0] = (1e-40, 3e38, -0.0)
    write_map_set(path, views)
    back = read_map_set(path, "radiance_views")
    assert (back.kind, back.header, list(back.maps)) == (views.kind, views.header, list(views.maps))
    for name, pixels in views.maps.items():
        assert back.maps[name].dtype == np.float32
        assert back.maps[name].flags.c_contiguous
        np.testing.assert_array_equal(back.maps[name].view(np.uint32), pixels.view(np.uint32))


def test_half_maps_come_back_rounded(tmp_path: Path, make_views: MakeViews) -> None:
    path, views = tmp_path / "a.rsibr.exr", make_views()
    views.maps["view000.glossy"][0, :4] = [[65504, 1e-3, 1e-5], [0, 3e-8, 2e-8], [7, 7, 7], [1e4, 1, 0.1]]
    write_map_set(path, views, half=True)
    for name, pixels in read_map_set(path).maps.items():
        assert pixels.dtype == np.float32
        # As the format promises: 11 significant bits, below 2^-14 steps of 2^-24
        tolerance = np.maximum(2.0**-11 * np.abs(views.maps[name]), 2.0**-25)
        assert np.all(np.abs(pixels - views.maps[name]) <= tolerance)


@pytest.mark.parametrize(
    ("last", "half"), [(2.0**-24, True), (2.0**-25, False), (1.0 + 2.0**-11, False), (65520.0, False)]
)
def test_maps_that_half_floats_state_exactly_are_half(
    tmp_path: Path, make_views: MakeViews, last: float, half: bool
) -> None:
    path, views = tmp_path / "a.rsibr.exr", make_views()
    for pixels in views.maps.values():
        pixels[...] = pixels.astype(np.float16)
    views.maps["view000.glossy"][-1, -1] = (-0.0, 65504.0, last)
    write_map_set(path, views)
    with OpenEXR.File(str(path)) as file:
        stored = {part.name(): part.channels["RGB"].pixels.dtype for part in file.parts}
    assert stored == dict.fromkeys(stored, np.float16) | ({} if half else {"view000.glossy": np.float32})
    for name, pixels in read_map_set(path).maps.items():
        np.testing.assert_array_equal(pixels.view(np.uint32), views.maps[name].view(np.uint32))


@pytest.mark.parametrize("scale", [1e6, 1e-5, 1e-7])
def test_maps_that_half_floats_cannot_hold_are_told_and_kept(
    tmp_path: Path, make_views: MakeViews, scale: float
) -> None:
    path, views = tmp_path / "a.rsibr.exr", make_views()
    views.maps["view000.glossy"] *= np.float32(scale)
    with pytest.warns(RsibrWarning, match=r"1 of the 5 maps of .* too bright or too dark for 16-bit floats"):
        write_map_set(path, views, half=True)
    back = read_map_set(path).maps
    np.testing.assert_array_equal(back["view000.glossy"], views.maps["view000.glossy"])
    np.testing.assert_allclose(back["view001.glossy"], views.maps["view001.glossy"], rtol=2.0**-11)
    assert np.any(back["view001.glossy"] != views.maps["view001.glossy"])


def test_the_header_is_read_whole_without_the_pixels(tmp_path: Path, make_views: MakeViews) -> None:
    path, views = tmp_path / "a.rsibr.exr", make_views()
    write_map_set(path, views)
    header = read_map_set_header(path)
    assert (header["format"], header["kind"]) == (1, "radiance_views")
    for part, described in zip(header["parts"], views.header["parts"], strict=True):
        pixels = views.maps[part["name"]]
        digest = hashlib.sha256(pixels.astype("<f4").tobytes()).hexdigest()
        assert part == described | {"size": [pixels.shape[1], pixels.shape[0]], "sha256": digest}


def test_others_see_named_parts_with_the_top_row_first(tmp_path: Path, make_views: MakeViews) -> None:
    path, views = tmp_path / "a.rsibr.exr", make_views()
    write_map_set(path, views)
    with OpenEXR.File(str(path)) as file:
        cover, *parts = file.parts
        assert [part.name() for part in parts] == list(views.maps)
        assert ["rsibr" in part.header for part in file.parts] == [True] + [False] * 5
        # No part is wider or higher than the first, which some readers take for all
        shapes = [part.channels["RGB"].pixels.shape for part in parts]
        assert cover.name() == "cover"
        assert cover.channels["RGB"].pixels.shape == tuple(np.max(shapes, axis=0))
        for part in parts:
            assert part.compression() == OpenEXR.ZIP_COMPRESSION
            np.testing.assert_array_equal(part.channels["RGB"].pixels, views.maps[part.name()][::-1])


def test_equal_sets_give_equal_bytes(tmp_path: Path, make_views: MakeViews) -> None:
    for name in ("a.exr", "b.exr"):
        write_map_set(tmp_path / name, make_views(seed=3))
    assert (tmp_path / "a.exr").read_bytes() == (tmp_path / "b.exr").read_bytes()


def test_a_set_of_one_map_comes_back(tmp_path: Path, make_views: MakeViews) -> None:
    header = make_views().header | {"parts": [{"name": "environment", "role": "environment"}]}
    pixels = np.random.default_rng(0).random((12, 24, 3), dtype=np.float32)
    write_map_set(tmp_path / "a.exr", MapSet("reflection_tables", {"environment": pixels}, header))
    back = read_map_set(tmp_path / "a.exr", "reflection_tables")
    assert back.header == header
    np.testing.assert_array_equal(back.maps["environment"], pixels)


@pytest.mark.parametrize(
    ("kind", "fields"),
    [
        ("lobe_stack", {"lobe": 0, "elevations": [ELEVATION]}),
        ("mip_chain", {"mip": 0, "roughness": 0.0}),
    ],
)
def test_the_kinds_state_what_their_maps_are(
    tmp_path: Path, make_views: MakeViews, kind: str, fields: dict[str, Any]
) -> None:
    part = {"name": "first", "role": "prefiltered", **fields}
    header = make_views().header | {"parts": [part], "material": {"brdf": "ggx", "method": "joint"}}
    header["environment"] = header["environment"] | {"part": None}
    prefiltered = MapSet(kind, {"first": np.ones((4, 4, 3), np.float32)}, header)
    write_map_set(tmp_path / "a.exr", prefiltered)
    assert read_map_set(tmp_path / "a.exr").header == header
    for field in fields:
        lacking = header | {"parts": [{name: value for name, value in part.items() if name != field}]}
        with pytest.raises(MapSetError, match=rf"parts\[0\]\.{field} is missing"):
            write_map_set(tmp_path / "b.exr", replace(prefiltered, header=lacking))


def test_existing_sets_are_kept_unless_forced(tmp_path: Path, make_views: MakeViews) -> None:
    path = tmp_path / "a.rsibr.exr"
    write_map_set(path, make_views(seed=1))
    before = path.read_bytes()
    with pytest.raises(OutputFileError, match=r"a\.rsibr\.exr exists: .*--force"):
        write_map_set(path, make_views(seed=2))
    assert path.read_bytes() == before
    write_map_set(path, make_views(seed=2), force=True)
    assert path.read_bytes() != before


@pytest.mark.skipif(not Path("/dev/full").is_char_device(), reason="this system has no /dev/full")
def test_a_full_disk_leaves_nothing(
    tmp_path: Path, make_views: MakeViews, monkeypatch: pytest.MonkeyPatch
) -> None:
    real_open = Path.open
    monkeypatch.setattr(
        Path, "open", lambda path, mode: real_open(path if mode == "a" else Path("/dev/full"), mode)
    )
    with pytest.raises(OutputFileError, match=r"a\.rsibr\.exr was not written because the disk is full"):
        write_map_set(tmp_path / "a.rsibr.exr", make_views())
    assert os.listdir(tmp_path) == []


def test_maps_and_header_must_list_the_same(tmp_path: Path, make_views: MakeViews) -> None:
    views = make_views()
    fewer = {name: pixels for name, pixels in views.maps.items() if name != "view001.glossy"}
    with pytest.raises(ShapeError, match="its header lists"):
        write_map_set(tmp_path / "a.exr", replace(views, maps=fewer))
    assert os.listdir(tmp_path) == []


@pytest.mark.parametrize("shape", [(20, 20), (20, 20, 4), (0, 20, 3)])
def test_maps_are_pictures_in_three_colours(tmp_path: Path, make_views: MakeViews, shape: tuple) -> None:
    views = make_views()
    views.maps["view000.glossy"] = np.ones(shape, np.float32)
    with pytest.raises(ShapeError, match=r"Map view000\.glossy must have the shape"):
        write_map_set(tmp_path / "a.exr", views)


@pytest.mark.parametrize(
    ("value", "half", "sentence"),
    [
        (np.nan, False, "2 values that are NaN or infinite:"),
        (np.inf, True, "2 values that are NaN or infinite:"),
    ],
)
def test_radiance_that_cannot_be_stored_is_counted_and_refused(
    tmp_path: Path, make_views: MakeViews, value: float, half: bool, sentence: str
) -> None:
    views = make_views()
    views.maps["view000.glossy"][0, 0, :2] = value
    with pytest.raises(RangeError, match=rf"Map view000\.glossy holds {sentence}"):
        write_map_set(tmp_path / "a.exr", views, half=half)
    assert os.listdir(tmp_path) == []
