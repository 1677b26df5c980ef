"""A kind of map sets, a shading mode, an export format and an engine are added by own files and a row each.

Those of tests/toys stand outside the package, so that nothing in it can know them.
"""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from rsibr import rsibr_addon
from rsibr.rsibr_addon.command_line.main import run
from rsibr.rsibr_addon.core.environment import Environment
from rsibr.rsibr_addon.core.errors import MapSetError
from rsibr.rsibr_addon.core.geometry.camera import Camera
from rsibr.rsibr_addon.core.progress import drain
from rsibr.rsibr_addon.device.preview import SAMPLES_PER_AXIS, PreviewRenderer
from rsibr.rsibr_addon.files.kinds.registry import STORED, look_types
from rsibr.rsibr_addon.files.map_set import read_map_set, write_map_set
from rsibr.rsibr_addon.files.pictures import read_exr
from rsibr.rsibr_addon.files.radiance_pictures import read_radiance, write_radiance
from rsibr.rsibr_addon.job import BakeJob
from rsibr.rsibr_addon.settings.light import Light
from rsibr.rsibr_addon.tasks.export.engines.engine import PanoramaEngine
from rsibr.rsibr_addon.tasks.export.engines.engines import ENGINES
from rsibr.rsibr_addon.tasks.export.formats import FORMATS
from rsibr.rsibr_addon.tasks.methods.bake import METHODS, bake
from rsibr.rsibr_addon.tasks.methods.kinds import KINDS, open_map_set
from rsibr.rsibr_addon.tasks.report.facts import map_set_facts
from rsibr.rsibr_addon.tasks.report.pictures import map_set_pictures
from rsibr.rsibr_addon.tasks.report.report import map_set_report
from rsibr.tests.glsl.test_preview_renderer import BY_CAMERA, SIZE, SPHERE, samples
from rsibr.tests.toys import disk_files, disk_method, means_format
from rsibr.tests.toys.disk_core import Disk, DiskLook, disk_radiance
from rsibr.tests.toys.toon_mode import GpuToon, ToonLook, toon_radiance

pytestmark = pytest.mark.needs("gl")

DISK = Disk(np.array([1.0, 0.5, 0.25]), np.array([0.125, 0.25, 2.0]))
LIGHT = Environment(np.ones((2, 4, 3), dtype=np.float32), "white")


@pytest.fixture
def path(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A map set of the toy kind, whose rows are there while the test runs."""
    monkeypatch.setitem(STORED, disk_files.KIND, disk_files.STORED)
    monkeypatch.setitem(METHODS, disk_files.KIND, disk_method.METHOD)
    monkeypatch.setitem(KINDS, disk_files.KIND, disk_method.KIND)
    write_map_set(tmp_path / "disk.rsibr.exr", disk_files.to_map_set(DISK, LIGHT, 0.5))
    return tmp_path / "disk.rsibr.exr"


def test_every_kind_has_its_rows_and_its_modules() -> None:
    assert list(KINDS) == list(look_types()) == [*STORED, "environment"]
    package = Path(rsibr_addon.__file__).parent
    for kind in STORED:
        rooms = ("core/kinds", "files/kinds", "settings", "tasks/methods")
        assert all([*package.glob(f"{room}/{kind}*")] for room in rooms)


def test_it_is_baked_by_a_job(path: Path) -> None:
    write_radiance(path.parent / "light.exr", np.full((2, 4, 3), (1.0, 2.0, 4.0)))
    settings, light = disk_method.DiskSettings(shine=0.25), Light(environment=str(path.parent / "light.exr"))
    baked = drain(bake(BakeJob(settings, str(path.parent / "b.rsibr.exr"), light)))
    np.testing.assert_array_equal(open_map_set(baked.path).content.rim, [0.25, 0.5, 1.0])


def test_it_comes_back_from_its_file_and_is_checked(path: Path) -> None:
    opened = open_map_set(path)
    assert opened.kind == "disk"
    np.testing.assert_array_equal(opened.content.middle, DISK.middle)
    np.testing.assert_array_equal(opened.content.rim, DISK.rim)
    broken = read_map_set(path)
    broken.header["material"]["shine"] = "much"
    with pytest.raises(MapSetError, match=r"material\.shine is not a finite number"):
        write_map_set(path, broken, force=True)
    broken.header["material"]["shine"] = 0.5
    del broken.header["parts"][1]["cosine"]
    with pytest.raises(MapSetError, match=r"parts\[1\]\.cosine is missing"):
        write_map_set(path, broken, force=True)


def test_its_facts_are_told_everywhere(path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    facts = {"Kind": "Disk", "Light": "White", "Material": "Paper", "Maps": "3, 2 x 2", "Shine": "50%"}
    assert map_set_facts(path) == {**facts, "Error": "none stated"}
    assert run(["info", str(path)]) == 0
    lines = [line.split(maxsplit=1) for line in capfd.readouterr().out.splitlines()[1:]]
    assert facts.items() <= dict(lines[:5]).items()
    text = drain(map_set_report(path, path.with_suffix(".html"))).read_text()
    assert "<dt>Shine</dt><dd>50%</dd>" in text
    assert "Colour at n\N{DOT OPERATOR}v 1" in text
    titles = [picture.title for picture in map_set_pictures(path)]
    assert titles == ["Colour at n\N{DOT OPERATOR}v 0", "Colour at n\N{DOT OPERATOR}v 1", "Light"]


@BY_CAMERA
def test_it_is_drawn_as_its_reference_says(path: Path, camera: Camera) -> None:
    picture = PreviewRenderer(open_map_set(path).drawable()).draw(*SPHERE, camera, SIZE, DiskLook(0.5))
    normal, view_dir, cosine = samples(camera)
    expected = means(disk_radiance(DISK, normal, view_dir, DiskLook(0.5)))
    inside = (cosine > 0.3).reshape(SIZE, SAMPLES_PER_AXIS, SIZE, SAMPLES_PER_AXIS).all(axis=(1, 3))
    # Facets turn normals by up to 4e-4
    np.testing.assert_allclose(picture[inside, :3], expected[inside], atol=2e-3)


@BY_CAMERA
def test_a_mode_is_added_by_its_look_and_its_shader(
    path: Path, camera: Camera, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(STORED, "disk", replace(STORED["disk"], look=ToonLook))
    monkeypatch.setitem(KINDS, "disk", replace(KINDS["disk"], drawable=GpuToon))
    renderer, look = PreviewRenderer(open_map_set(path).drawable()), look_types()["disk"](gain=2.0)
    picture = renderer.draw(*SPHERE, camera, SIZE, look)
    normal, view_dir, cosine = samples(camera)
    expected = means(toon_radiance(DISK, normal, view_dir, look))
    blocks = np.abs(cosine).reshape(SIZE, SAMPLES_PER_AXIS, SIZE, SAMPLES_PER_AXIS)
    # Away from the silhouette and from the edge between the tones
    sure = (blocks > 0.3).all(axis=(1, 3)) & (np.abs(blocks - look.edge) > 0.01).all(axis=(1, 3))
    assert np.unique(expected[sure], axis=0).shape == (2, 3)
    np.testing.assert_allclose(picture[sure, :3], expected[sure], rtol=1e-6)
    assert renderer.draw(*SPHERE, camera, SIZE, DiskLook()).max() == pytest.approx(2.0, abs=0.6)


def test_the_commands_preview_and_compare_it(path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    assert run(["preview", str(path), "--size", "32", "--gain", "2", "-o", str(path.parent / "a.exr")]) == 0
    middle = read_exr(path.parent / "a.exr")[16, 16]
    np.testing.assert_allclose(middle[:3], 2.0 * DISK.middle, atol=0.06)
    limits = ["--views", "2", "--size", "16", "--brighter", "1.25"]
    assert run(["compare", str(path), *limits, "-o", str(path.parent / "out")]) == 0
    # 1 is a fifth less than 1.25
    assert "0.2000  as it is\n" in capfd.readouterr().out
    told = json.loads((path.parent / "out" / "comparison.json").read_text())
    assert told["settings"]["brighter"] == 1.25
    assert "drawn brighter" in (path.parent / "out" / "index.html").read_text()


def test_it_is_exported_and_in_a_format_of_ones_own(path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    assert run(["export", str(path), "-o", str(path.parent / "a.ktx2")]) == 0
    monkeypatch.setitem(FORMATS, "means", means_format.FORMAT)
    assert run(["export", str(path), "--digits", "2", "-o", str(path.parent / "a.means")]) == 0
    mean = 0.5 * (DISK.middle + DISK.rim)
    np.testing.assert_allclose(np.loadtxt(path.parent / "a.means"), mean, atol=0.5e-2)


def test_light_is_exported_for_an_engine_of_ones_own(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    write_radiance(tmp_path / "light.exr", np.arange(24.0).reshape(2, 4, 3))
    engine = PanoramaEngine(label="Toy", use="play with it", quarters=1)
    monkeypatch.setitem(ENGINES, "toy", engine)
    out = tmp_path / "toy.exr"
    assert run(["export", str(tmp_path / "light.exr"), "--for", "toy", "-o", str(out)]) == 0
    np.testing.assert_array_equal(read_radiance(out)[0, :, 0], [3.0, 6.0, 9.0, 0.0])


def means(shaded: np.ndarray) -> np.ndarray:
    """The mean of each pixel's samples, shape (SIZE, SIZE, 3)."""
    return shaded.reshape(SIZE, SAMPLES_PER_AXIS, SIZE, SAMPLES_PER_AXIS, 3).mean(axis=(1, 3))
