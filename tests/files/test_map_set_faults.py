"""Files that are no good map sets: each is refused, and what is wrong with it named."""

import copy
import hashlib
import json
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import OpenEXR
import pytest
from rsibr.rsibr_addon.core.errors import MapSetError
from rsibr.rsibr_addon.files.map_set import read_map_set, write_map_set
from rsibr.rsibr_addon.files.map_set_data import MapSet
from rsibr.rsibr_addon.files.pictures import write_exr
from rsibr.rsibr_addon.files.radiance_pictures import write_radiance

MakeViews = Callable[..., MapSet]


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
