"""Map sets: what is written comes back, and everything else is named."""

import copy
import hashlib
import json
import os
import re
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
from rsibr.rsibr_addon.files.pictures import write_exr
from rsibr.rsibr_addon.files.radiance_pictures import write_radiance

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


# ---- files that are no good map sets


def rewrite(
    path: Path, edit: Callable[[dict[str, Any], list[Any]], object], description: str | None = None
) -> None:
    """Change the description, or replace it, and the listed parts of a file, with the package alone."""
    with OpenEXR.File(str(path)) as file:
        header = json.loads(file.parts[0].header["rsibr"])
        # The package's own fields go; it writes them anew
        cover, *kept = [
            (
                {key: part.header[key] for key in ("type", "compression", "displayWindow")},
                {"RGB": part.channels["RGB"].pixels.copy()},
                part.name(),
            )
            for part in file.parts
        ]
    edit(header, kept)
    cover[0]["rsibr"] = json.dumps(header) if description is None else description
    OpenEXR.File([OpenEXR.Part(*part) for part in (cover, *kept)]).write(str(path))


def refusal(path: Path) -> str:
    """What reading says; the file is always named first."""
    with pytest.raises(MapSetError) as caught:
        read_map_set(path)
    sentence = str(caught.value)
    assert sentence.startswith(str(path))
    assert sentence.endswith((".", "`."))
    return sentence.removeprefix(str(path))


@pytest.fixture
def path(tmp_path: Path, make_views: MakeViews) -> Path:
    """A small, good map set."""
    path = tmp_path / "a.rsibr.exr"
    write_map_set(path, make_views())
    return path


def test_rewriting_alone_does_no_harm(path: Path, make_views: MakeViews) -> None:
    rewrite(path, lambda header, parts: None)
    assert read_map_set(path).header == make_views().header


def test_missing_files_and_other_files_are_refused(tmp_path: Path) -> None:
    path = tmp_path / "a.rsibr.exr"
    assert "does not exist: check the name" in refusal(path)
    path.write_text("no picture")
    assert "is not a map set: give one, or make one with `rsibr bake`" in refusal(path)
    path.unlink()
    path.mkdir()
    assert "is a folder" in refusal(path)


def test_a_picture_is_told_from_a_map_set(tmp_path: Path) -> None:
    write_exr(tmp_path / "a.exr", np.ones((2, 4, 4)))
    write_radiance(tmp_path / "a.hdr", np.ones((2, 4, 3)))
    (tmp_path / "a.jpg").write_bytes(b"\xff\xd8\xff\xe0 a photograph")
    for name in ("a.exr", "a.hdr", "a.jpg"):
        assert refusal(tmp_path / name) == " is a picture, not a map set: make one with `rsibr bake`."


@pytest.mark.parametrize("text", ["", "{", "[" * 100000, '{"format": 1', "{'format': 1}"])
def test_a_description_that_is_no_json_is_refused(path: Path, text: str) -> None:
    rewrite(path, lambda header, parts: None, text)
    assert "holds a description that cannot be read (it is not JSON: " in refusal(path)


@pytest.mark.parametrize(
    "text", ["null", "[]", "1", "{}", '{"format": "1"}', '{"format": 0}', '{"format": true}']
)
def test_a_description_without_a_version_is_refused(path: Path, text: str) -> None:
    rewrite(path, lambda header, parts: None, text)
    assert "states no format version" in refusal(path)


def test_a_newer_version_is_refused(path: Path) -> None:
    rewrite(path, lambda header, parts: header.update(format=2))
    assert "was written by a newer RSIBR (format 2; this one reads 1): update RSIBR" in refusal(path)


def test_another_kind_than_asked_is_refused(path: Path) -> None:
    with pytest.raises(MapSetError, match="holds radiance_views, but lobe_stack are needed here"):
        read_map_set(path, "lobe_stack")
    rewrite(path, lambda header, parts: header.update(kind="hologram"))
    assert "is a map set of unknown kind 'hologram'" in refusal(path)


FIELDS = ["layout", "size", "axes", "environment", "material", "parts", "error_bound", "settings", "software"]
FIELDS += [f"environment.{name}" for name in ("name", "sha256", "size", "part")]
FIELDS += [f"material.{name}" for name in ("spec", "name", "fingerprint")]
FIELDS += [f"parts[2].{name}" for name in ("name", "role", "view", "view_dir", "size", "sha256")]
OPTIONAL = ["material.fingerprint"]  # what a reflectance model was integrated of has none


def holder(header: dict[str, Any], field: str) -> tuple[dict[str, Any], str]:
    """The object that holds a field written as "parts[2].view", and the field's own name."""
    where, _, name = field.rpartition(".")
    if not where:
        return header, name
    return (header["parts"][2] if where == "parts[2]" else header[where]), name


def drop(path: Path, field: str) -> None:
    def drop(header: dict[str, Any], parts: list[Any]) -> None:
        fields, name = holder(header, field)
        del fields[name]

    rewrite(path, drop)


@pytest.mark.parametrize("field", OPTIONAL)
def test_an_optional_field_may_be_missing(path: Path, field: str) -> None:
    drop(path, field)
    fields, name = holder(read_map_set(path).header, field)
    assert name not in fields


@pytest.mark.parametrize("field", [field for field in FIELDS if field not in OPTIONAL])
def test_a_missing_field_is_named(path: Path, field: str) -> None:
    drop(path, field)
    assert f"is not a whole map set ({field} is missing)" in refusal(path)


@pytest.mark.parametrize("field", FIELDS)
def test_a_field_of_another_type_is_named(path: Path, field: str) -> None:
    def spoil(header: dict[str, Any], parts: list[Any]) -> None:
        fields, name = holder(header, field)
        fields[name] = 1.5

    rewrite(path, spoil)
    assert re.search(rf"is not a whole map set \({re.escape(field)} is not ", refusal(path))


@pytest.mark.parametrize(
    ("edit", "problem"),
    [
        (lambda parts: parts[1].update(view_dir=[1, 1, 0]), "parts[1].view_dir is not a unit vector"),
        (
            lambda parts: parts[1].update(view_dir=[[], 0, 0]),
            "parts[1].view_dir[0] is not a finite number",
        ),
        (lambda parts: parts[1].update(view=-1), "parts[1].view is not a number from 0 to 161"),
        (lambda parts: parts[1].update(view=True), "parts[1].view is not a whole number"),
        (lambda parts: parts[1].update(view=7), "not each there with a diffuse and a glossy part"),
        (
            lambda parts: parts[1].update(role="other"),
            "not each there with a diffuse and a glossy part",
        ),
        (lambda parts: parts[3].update(view=0), "view 0 has two diffuse parts"),
        (lambda parts: parts[1].update(view_dir=[1.0, 0.0, 0.0]), "parts state different directions"),
        (lambda parts: parts[2].update(name="environment"), "two parts have one name"),
        (lambda parts: parts[0].update(role="sky"), "names 'environment', which is no part with that role"),
        (
            lambda parts: parts[0].update(size=[24, 13]),
            "has another size than environment.size",
        ),
        (lambda parts: parts[2].update(size=[20, 0]), "parts[2].size[1] is not a number from 1 to 131072"),
        (lambda parts: parts[2].update(size=[20, 21]), "'view000.glossy' has another size than the views"),
        (lambda parts: parts[2].update(size=[20]), "parts[2].size is not 2 long"),
        (lambda parts: parts[2].update(role="../a"), "parts[2].role is not a word"),
        (lambda parts: parts[0].update(sha256="F" * 64), "parts[0].sha256 is not 64 hexadecimal digits"),
    ],
)
def test_contradictions_in_the_description_are_named(path: Path, edit: Callable, problem: str) -> None:
    rewrite(path, lambda header, parts: edit(header["parts"]))
    assert "is not a whole map set (" in refusal(path)
    assert problem in refusal(path)


def test_parts_that_are_listed_and_missing_or_the_reverse_are_named(path: Path) -> None:
    original = path.read_bytes()
    rewrite(path, lambda header, parts: parts.pop(2))
    assert "(part 'view000.glossy': 20x20 in its list, missing in fact)" in refusal(path)
    path.write_bytes(original)
    rewrite(path, lambda header, parts: parts.append((dict(parts[1][0]), dict(parts[1][1]), "extra")))
    assert "(part 'extra': missing in its list, 20x20 in fact)" in refusal(path)


def test_parts_of_another_size_than_listed_are_named(path: Path) -> None:
    def shrink(header: dict[str, Any], parts: list[Any]) -> None:
        parts[2][1]["RGB"] = parts[2][1]["RGB"][:19].copy()

    rewrite(path, shrink)
    assert "(part 'view000.glossy': 20x20 in its list, 20x19 in fact)" in refusal(path)


def test_channels_other_than_colour_are_refused(path: Path) -> None:
    def recolour(header: dict[str, Any], parts: list[Any]) -> None:
        parts[2][1]["XYZ"] = parts[2][1].pop("RGB")

    rewrite(path, recolour)
    assert "has no R, G and B in float or half in part 'view000.glossy'" in refusal(path)


def test_changed_pixels_are_refused(path: Path) -> None:
    def change(header: dict[str, Any], parts: list[Any]) -> None:
        parts[2][1]["RGB"][5, 5, 1] += 1e-6

    rewrite(path, change)
    assert "is damaged: part 'view000.glossy' is not as written" in refusal(path)


def test_radiance_that_is_not_finite_is_counted_and_refused(path: Path) -> None:
    def poison(header: dict[str, Any], parts: list[Any]) -> None:
        pixels = parts[2][1]["RGB"]
        pixels[5, 5] = (np.nan, np.inf, 1)
        header["parts"][2]["sha256"] = hashlib.sha256(pixels[::-1].tobytes()).hexdigest()

    rewrite(path, poison)
    assert "holds 2 values that are NaN or infinite in part 'view000.glossy'" in refusal(path)


def test_what_a_later_version_adds_is_kept(path: Path) -> None:
    def add(header: dict[str, Any], parts: list[Any]) -> None:
        header["more"] = [1, {"a": None}]
        header["parts"][1]["noise"] = 0.25

    rewrite(path, add)
    back = read_map_set(path)
    assert back.header["more"] == [1, {"a": None}]
    assert back.header["parts"][1]["noise"] == 0.25


def test_reading_changes_nothing_that_it_was_given(path: Path, make_views: MakeViews) -> None:
    views = make_views()
    header = copy.deepcopy(views.header)
    write_map_set(path, views, force=True)
    assert views.header == header
