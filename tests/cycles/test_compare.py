"""Comparisons: right where the answer is known, whole on disk, and refused in words."""

import base64
import json
import re
from dataclasses import replace
from html.parser import HTMLParser
from pathlib import Path

import bpy
import numpy as np
import pytest
from rsibr.rsibr_addon.core.errors import InputFileError, MapSetError, OutputFileError, RangeError
from rsibr.rsibr_addon.core.kinds.radiance_views.shading import Mode
from rsibr.rsibr_addon.core.kinds.radiance_views.warping import Warping
from rsibr.rsibr_addon.core.progress import drain
from rsibr.rsibr_addon.files.map_set import write_map_set
from rsibr.rsibr_addon.host.materials import fingerprint, load_material
from rsibr.rsibr_addon.host.scenes import temporary_scene
from rsibr.rsibr_addon.settings.radiance_views import ViewsComparison
from rsibr.rsibr_addon.tasks.compare.compare import compare
from rsibr.rsibr_addon.tasks.compare.comparison import Comparison, random_directions
from rsibr.rsibr_addon.tasks.compare.pictures import BRIGHTER, DARKER, difference_picture
from rsibr.rsibr_addon.tasks.compare.radiance_views import ViewsWay
from rsibr.tests.mirror_capture import mirror_map_set

pytestmark = pytest.mark.needs("gl")

QUICK = ViewsComparison(views=2, size=32, samples=8, modes=(Mode.FRAGMENT,), warpings=(Warping.SPLIT,))

BOX = """
v -1 -2 -3
v 1 -2 -3
v -1 2 -3
v 1 2 -3
v -1 -2 3
v 1 -2 3
v -1 2 3
v 1 2 3
vn -1 0 0
vn 1 0 0
vn 0 -1 0
vn 0 1 0
vn 0 0 -1
vn 0 0 1
f 1//1 5//1 7//1 3//1
f 2//2 4//2 8//2 6//2
f 1//3 2//3 6//3 5//3
f 3//4 7//4 8//4 4//4
f 1//5 3//5 4//5 2//5
f 5//6 6//6 8//6 7//6
"""
"""A flat shaded box whose three extents differ, so that no turn of it looks the same."""


@pytest.fixture
def mirror_fingerprint() -> str:
    with temporary_scene():
        return fingerprint(load_material("mirror"))


@pytest.fixture
def capture(tmp_path: Path, mirror_fingerprint: str) -> Path:
    """A flawless capture of the preset mirror."""
    path = tmp_path / "mirror.rsibr.exr"
    write_map_set(path, mirror_map_set(fingerprint=mirror_fingerprint))
    return path


class OpenTags(HTMLParser):
    """Counts tags that were opened and not closed, and collects attributes that load something."""

    VOID = ("meta", "input")

    def __init__(self) -> None:
        super().__init__()
        self.open: list[str] = []
        self.loads: list[str] = []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        if tag not in self.VOID:
            self.open.append(tag)
        self.loads += [value or "" for name, value in attrs if name in ("src", "href")]

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag


def test_a_flawless_capture_is_close_to_cycles_and_all_is_written(tmp_path: Path, capture: Path) -> None:
    before = {repr(item) for item in bpy.data.all_ids}
    settings = ViewsComparison(views=3, size=32, samples=16)
    found = drain(compare(capture, settings, tmp_path / "out"))
    # A mirror has no noise but that of where a pixel is sampled: 16 points, on a slope.
    assert 0.0 < found.reference_noise < 0.02
    # Our own interpolation, see test_preview, is 1e-2 at worst and rare; the rest is that noise.
    assert len(found.errors) == len(Mode) * len(Warping)
    for error in found.errors:
        assert len(error.per_view) == 3
        assert min(error.per_view) <= error.median <= error.worst == max(error.per_view)
        assert min(error.per_view) <= error.pooled <= error.worst < 0.03
    assert {repr(item) for item in bpy.data.all_ids} == before

    written = json.loads((tmp_path / "out" / "comparison.json").read_text())
    assert [error["pooled"] for error in written["errors"]] == [error.pooled for error in found.errors]
    assert Comparison.from_json(written, ViewsComparison, ViewsWay) == found
    assert not [path for path in tmp_path.iterdir() if path.name.startswith(".")]

    page = (tmp_path / "out" / "index.html").read_text()
    parser = OpenTags()
    parser.feed(page)
    assert parser.open == []
    assert parser.loads == []
    embedded = {base64.b64decode(text) for text in re.findall(r"url\(data:image/png;base64,([^)]+)\)", page)}
    assert embedded == {path.read_bytes() for path in (tmp_path / "out" / "images").iterdir()}
    assert len(embedded) >= 1 + 2  # equal pictures are one
    assert "url(" not in re.sub(r"url\(data:", "", page)


def test_a_known_error_is_found(tmp_path: Path, mirror_fingerprint: str) -> None:
    map_set = mirror_map_set(fingerprint=mirror_fingerprint)
    for part in map_set.header["parts"]:
        if part["role"] == "glossy":
            map_set.maps[part["name"]] = np.float32(1.25) * map_set.maps[part["name"]]
    write_map_set(tmp_path / "bright.rsibr.exr", map_set)
    found = drain(compare(tmp_path / "bright.rsibr.exr", QUICK, tmp_path / "out"))
    # A quarter too bright, give or take what a flawless capture shows.
    assert found.errors[0].pooled == pytest.approx(0.25, abs=0.03)


def test_meshes_stand_as_they_are_drawn(tmp_path: Path, capture: Path) -> None:
    (tmp_path / "box.obj").write_text(BOX)
    settings = ViewsComparison(
        views=3,
        mesh=str(tmp_path / "box.obj"),
        perspective=50.0,
        size=32,
        samples=16,
        modes=(Mode.FRAGMENT,),
        warpings=(Warping.SPLIT,),
    )
    found = drain(compare(capture, settings, tmp_path / "out"))
    # As for the sphere; where two faces meet within a pixel, both pictures average what they show.
    assert found.errors[0].worst < 0.05


def test_coarser_captures_share_their_references(tmp_path: Path, mirror_fingerprint: str) -> None:
    write_map_set(tmp_path / "m.rsibr.exr", mirror_map_set(42, 32, mirror_fingerprint))
    settings = ViewsComparison(
        views=1, size=24, samples=4, modes=(Mode.TEXEL,), warpings=(Warping.SINGLE,), captured_views=(12, 42)
    )
    found = drain(compare(tmp_path / "m.rsibr.exr", settings, tmp_path / "out"))
    assert [error.way.slug for error in found.errors] == ["12-texel-single", "42-texel-single"]


def test_equal_seeds_give_equal_numbers(tmp_path: Path, capture: Path) -> None:
    first, second = (drain(compare(capture, QUICK, tmp_path / name)) for name in "ab")
    assert first == second


def test_another_material_is_refused(tmp_path: Path) -> None:
    write_map_set(tmp_path / "old.rsibr.exr", mirror_map_set(fingerprint="of another mirror"))
    with pytest.raises(InputFileError, match="material mirror has changed since it was captured"):
        drain(compare(tmp_path / "old.rsibr.exr", QUICK, tmp_path / "out"))
    assert not (tmp_path / "out").exists()


def test_views_of_a_model_are_compared_with_a_material_of_cycles(tmp_path: Path) -> None:
    """They state no fingerprint that it could differ from."""
    map_set = mirror_map_set()
    map_set.header["material"] = {"spec": "ggx:alpha=0.001,fresnel=1", "name": "a model"}
    write_map_set(tmp_path / "model.rsibr.exr", map_set)
    found = drain(compare(tmp_path / "model.rsibr.exr", replace(QUICK, material="mirror"), tmp_path / "out"))
    # As of a flawless capture
    assert found.errors[0].pooled < 0.03


def test_a_map_set_without_its_environment_is_refused(tmp_path: Path) -> None:
    map_set = mirror_map_set()
    map_set.header["environment"]["part"] = None
    del map_set.header["parts"][0], map_set.maps["environment"]
    write_map_set(tmp_path / "bare.rsibr.exr", map_set)
    with pytest.raises(MapSetError, match=r"bare\.rsibr\.exr does not hold the environment"):
        drain(compare(tmp_path / "bare.rsibr.exr", QUICK, tmp_path / "out"))


def test_an_existing_folder_is_refused_before_anything_is_read(tmp_path: Path) -> None:
    (tmp_path / "out").mkdir()
    (tmp_path / "out" / "comparison.json").touch()
    with pytest.raises(OutputFileError, match="out exists"):
        next(compare(tmp_path / "absent.rsibr.exr", QUICK, tmp_path / "out"))


def test_a_cancelled_comparison_leaves_nothing(tmp_path: Path, capture: Path) -> None:
    before = {repr(item) for item in bpy.data.all_ids}
    steps = compare(capture, QUICK, tmp_path / "out")
    totals = [next(steps) for _ in range(3)]
    steps.close()
    assert [(step.done, step.total) for step in totals] == [(0, 4), (1, 4), (2, 4)]
    assert [path.name for path in tmp_path.iterdir()] == [capture.name]
    assert {repr(item) for item in bpy.data.all_ids} == before


@pytest.mark.parametrize(
    ("settings", "complaint"),
    [
        ({"views": 0}, "Views cannot be 0"),
        ({"samples": 3}, "Samples cannot be 3"),
        ({"size": 5000}, "choose 1 to 1024"),
    ],
)
def test_settings_have_limits(settings: dict[str, int], complaint: str) -> None:
    with pytest.raises(RangeError, match=complaint):
        ViewsComparison(**settings)


def test_directions_favour_no_side() -> None:
    directions = random_directions(4000, seed=8)
    np.testing.assert_allclose(np.linalg.norm(directions, axis=-1), 1.0, rtol=1e-12)
    # Components have variance 1/3: their means stay within five standard deviations, .0091 each.
    assert np.abs(directions.mean(axis=0)).max() < 0.046
    # Archimedes: each is uniform in [-1, 1], so its squares average 1/3; their deviation is .298.
    np.testing.assert_allclose((directions**2).mean(axis=0), 1.0 / 3.0, atol=5 * 0.298 / np.sqrt(4000))
    np.testing.assert_array_equal(random_directions(10, seed=8), directions[:10])
    assert not np.array_equal(random_directions(10, seed=9), directions[:10])


def test_differences_are_shown_by_sign_and_size() -> None:
    reference = np.array([[[1.0, 1.0, 1.0, 1.0]] * 4])
    grey = np.array([1.05, 0.9, 7.0, 1.0])
    ours = np.concatenate([np.repeat(grey[None, :, None], 3, axis=2), np.ones((1, 4, 1))], axis=2)
    ours[0, 3] = 0.0  # covers nothing
    shown = difference_picture(ours, reference, full=0.2)[0]
    np.testing.assert_allclose(shown[:, 3], [0.25, 0.5, 1.0, 0.0], atol=1e-12)
    np.testing.assert_allclose(shown[0, :3], 0.25 * np.array(BRIGHTER), atol=1e-12)
    np.testing.assert_allclose(shown[1, :3], 0.5 * np.array(DARKER), atol=1e-12)
    np.testing.assert_allclose(shown[2, :3], BRIGHTER, atol=1e-12)
