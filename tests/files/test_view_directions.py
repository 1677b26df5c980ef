"""View directions in files, and radiance views that are captured from them."""

import json
from pathlib import Path

import numpy as np
import pytest
from rsibr.rsibr_addon.command_line.main import run
from rsibr.rsibr_addon.core.errors import InputFileError
from rsibr.rsibr_addon.core.geometry.directions import normalize
from rsibr.rsibr_addon.core.kinds.radiance_views.shading import views_fragment
from rsibr.rsibr_addon.core.kinds.radiance_views.warping import Warping
from rsibr.rsibr_addon.files.kinds.radiance_views import from_map_set
from rsibr.rsibr_addon.files.map_set import read_map_set
from rsibr.rsibr_addon.files.radiance_pictures import write_radiance
from rsibr.rsibr_addon.files.view_directions import read_view_dirs

AXES = np.concatenate([np.eye(3), -np.eye(3)])
TEXTS = {
    "spaces": "\n".join(" ".join(map(str, row)) for row in 2.0 * AXES),
    "commas": "# from six sides\n" + "\n".join(",".join(map(str, row)) + "  # one" for row in AXES) + "\n\n",
    "json": json.dumps(AXES.tolist()),
}


@pytest.mark.parametrize("text", TEXTS.values(), ids=TEXTS)
@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16"])
def test_directions_are_read_as_people_write_them(tmp_path: Path, text: str, encoding: str) -> None:
    (tmp_path / "views.txt").write_bytes(text.encode(encoding))
    np.testing.assert_array_equal(read_view_dirs(tmp_path / "views.txt"), AXES)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "one or more of them"),
        ("0 0 1\n0 1", "no list of view directions"),
        ("0 0 north", "no list of view directions"),
        ('{"views": 12}', "no list of view directions"),
        ("[[0, 0, 1], 3]", "no list of view directions"),
        ("[[0, 0, 1e999]]", "no list of view directions"),
        ("0 0 1e999", "not finite"),
        ('[["0", "0", "1"]]', "no list of view directions"),
        ("[[true, false, 1]]", "no list of view directions"),
        ("[" * 100000, "no list of view directions"),
        ("0 0 1\n0 0 2", "directions 1 and 2 are nearer than 1 degree"),
    ],
)
def test_other_files_are_refused(tmp_path: Path, text: str, message: str) -> None:
    (tmp_path / "views.txt").write_text(text)
    with pytest.raises(InputFileError, match=message):
        read_view_dirs(tmp_path / "views.txt")


def test_a_model_is_captured_from_the_directions_of_a_file(tmp_path: Path) -> None:
    (tmp_path / "views.txt").write_text(TEXTS["spaces"])
    write_radiance(tmp_path / "white.exr", np.ones((32, 64, 3), np.float32))
    arguments = ["bake", "radiance-views", "--environment", str(tmp_path / "white.exr"), "--size", "16"]
    arguments += ["--material", "lambert:kd=0.5", "--view-file", str(tmp_path / "views.txt")]
    assert run([*arguments, "-o", str(tmp_path / "six.rsibr.exr")]) == 0
    map_set = read_map_set(tmp_path / "six.rsibr.exr", "radiance_views")
    views = from_map_set(tmp_path / "six.rsibr.exr", map_set)
    np.testing.assert_allclose(views.sphere.vertices, AXES, atol=1e-6)
    assert "views" not in map_set.header["settings"]
    view_dir = normalize(np.random.default_rng(2).normal(size=(200, 3)))
    shown = views_fragment(views, view_dir, view_dir, Warping.SPLIT)
    # White light sums to 1 but for its texels' width and single precision
    np.testing.assert_allclose(shown, 0.5, rtol=3e-3)
    assert views.left_out[Warping.SPLIT] < 3e-3


def test_one_view_is_shown_from_everywhere(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "view.txt").write_text("0 -1 0")
    write_radiance(tmp_path / "white.exr", np.ones((32, 64, 3), np.float32))
    arguments = ["bake", "radiance-views", "--environment", str(tmp_path / "white.exr"), "--size", "8"]
    arguments += ["--material", "lambert:kd=0.5", "--view-file", str(tmp_path / "view.txt")]
    assert run([*arguments, "-o", str(tmp_path / "one.rsibr.exr")]) == 0
    assert "do not surround the object" in capfd.readouterr().err
    views = from_map_set(tmp_path / "one", read_map_set(tmp_path / "one.rsibr.exr", "radiance_views"))
    assert views.left_out == {}
    shown = views_fragment(views, AXES, AXES, Warping.SPLIT)
    np.testing.assert_allclose(shown, 0.5, rtol=3e-3)
