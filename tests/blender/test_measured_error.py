"""What the panel tells of a comparison is what its file says, while it is of this map set."""

import json
import math
from pathlib import Path
from typing import Any

import pytest
from rsibr.rsibr_addon.core.kinds.radiance_views.shading import Mode, ViewsLook
from rsibr.rsibr_addon.core.kinds.radiance_views.warping import Warping
from rsibr.rsibr_addon.settings.radiance_views import ViewsComparison
from rsibr.rsibr_addon.tasks.compare import comparison as comparisons
from rsibr.rsibr_addon.tasks.compare.comparison import Comparison, WayError
from rsibr.rsibr_addon.tasks.compare.measured_error import measured_facts, measured_sentence
from rsibr.rsibr_addon.tasks.compare.radiance_views import ViewsWay
from rsibr.rsibr_addon.tasks.report import facts
from rsibr.tests.flat_capture import write_flat_capture


@pytest.fixture
def path(tmp_path: Path) -> Path:
    return write_flat_capture(tmp_path / "flat.rsibr.exr", (0.5, 0.0, 0.25))


def test_ways_count_their_views_in_words() -> None:
    assert ViewsWay(1, Mode.PAPER, Warping.SINGLE).name == "1 view, paper, single warp"
    assert ViewsWay(12, Mode.PAPER, Warping.SINGLE).name == "12 views, paper, single warp"


def write_comparison(path: Path, content: str) -> None:
    ways = [ViewsWay(12, Mode.FRAGMENT, Warping.ALBEDO), ViewsWay(12, Mode.PAPER, Warping.SPLIT)]
    comparison = Comparison(
        map_set=path.name,
        content=content,
        environment="forest",
        material="copper",
        map_size=8,
        settings=ViewsComparison(views=2),
        view_dirs=((0.0, 0.0, 1.0), (1.0, 0.0, 0.0)),
        reference_noise=0.001,
        errors=tuple(WayError(way, (0.02, 0.04), 0.031) for way in ways),
    )
    folder = path.parent / "flat-compared"
    folder.mkdir(exist_ok=True)
    (folder / "comparison.json").write_text(json.dumps(comparison.to_json()))


def test_a_comparison_is_read_once(path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    write_comparison(path, facts.map_set_content(path))
    first = measured_facts(path)

    def refuse(*values: Any) -> None:
        raise AssertionError("it is read again")

    monkeypatch.setattr(comparisons, "decode", refuse)
    assert measured_facts(path) == first


def test_measured_errors_are_told_while_the_content_is_the_same(path: Path) -> None:
    assert measured_facts(path) == {}
    assert measured_sentence(path, ViewsLook("fragment", "albedo")) == ""
    write_comparison(path, facts.map_set_content(path))
    told, look = measured_facts(path), ViewsLook("fragment", "albedo")
    measured = [which for what, which in told.items() if what.startswith("Measured: 12 views")]
    assert measured == ["3.1 %, at worst 4 %"] * 2
    assert told["Against"] == "Cycles, 2 views"
    sentence = "On the whole 3.1 % off Cycles, 4 % in the worst of 2 views."
    assert measured_sentence(path, look) == sentence
    assert measured_sentence(path, ViewsLook("texel", "albedo")) == ""
    write_flat_capture(path, (0.5, 0.0, 0.5))
    again = "flat.rsibr.exr has changed since it was compared: compare again."
    assert measured_facts(path) == {"Measured": again}
    assert measured_sentence(path, look) == again


@pytest.mark.parametrize(
    ("change", "why"),
    [
        ({"settings": {}, "view_dirs": []}, "view_dirs is not 1 to 65536 long"),
        ({"settings": "x"}, "settings is not an object"),
        (
            {"settings": {"views": 0}},
            "settings is impossible: Views cannot be 0: choose 1 to 65536",
        ),
        ({"errors": [{"pooled": 10**400}]}, "the number 1000000000000000... is too large"),
        ({"reference_noise": None}, "reference_noise is not a finite number"),
        ({"view_dirs": [[0.0, 0.0, 1.0]]}, "errors are of 2 views, not 1"),
    ],
)
def test_a_comparison_of_another_version_is_told(path: Path, change: dict[str, Any], why: str) -> None:
    write_comparison(path, facts.map_set_content(path))
    file = path.parent / "flat-compared" / "comparison.json"
    file.write_text(json.dumps({**json.loads(file.read_text()), **change}))
    assert measured_facts(path) == {
        "Measured": f"{file} is no comparison of this version ({why}): compare again."
    }


def test_comparisons_of_version_0_1_are_read(path: Path) -> None:
    write_comparison(path, facts.map_set_content(path))
    file = path.parent / "flat-compared" / "comparison.json"
    told = json.loads(file.read_text())
    fields = ("views", "seed", "mesh", "size", "samples", "modes", "warpings", "captured_views")
    told["settings"] = {name: told["settings"][name] for name in fields} | {"field_of_view": math.pi / 3.0}
    file.write_text(json.dumps(told))
    read = Comparison.from_json(told, ViewsComparison, ViewsWay)
    assert read.settings.perspective == pytest.approx(60.0)
    assert measured_facts(path)["Against"] == "Cycles, 2 views"
