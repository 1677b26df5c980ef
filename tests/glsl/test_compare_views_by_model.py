"""Radiance views of a reflectance model: integrated, and compared with the model itself."""

from pathlib import Path

import numpy as np
import pytest
from rsibr.rsibr_addon.core.kinds.radiance_views.shading import Mode
from rsibr.rsibr_addon.core.kinds.radiance_views.warping import WarpChoice, Warping, chosen_warping
from rsibr.rsibr_addon.core.progress import drain
from rsibr.rsibr_addon.files.map_set import read_map_set_header
from rsibr.rsibr_addon.files.map_set_facts import told_facts
from rsibr.rsibr_addon.files.radiance_pictures import write_radiance
from rsibr.rsibr_addon.job import BakeJob
from rsibr.rsibr_addon.settings.light import Light
from rsibr.rsibr_addon.settings.radiance_views import RadianceViewsSettings, ViewsComparison
from rsibr.rsibr_addon.tasks.compare.compare import compare
from rsibr.rsibr_addon.tasks.methods.bake import bake
from rsibr.rsibr_addon.tasks.methods.kinds import open_map_set
from rsibr.rsibr_addon.tasks.report.report import map_set_report

COAT = "layered:coat=(ggx:alpha=0.3,f0=0.04),base=(lambert:kd=0.5/0.1/0.1)"
QUICK = ViewsComparison(views=6, size=32, modes=(Mode.FRAGMENT,))


@pytest.fixture(scope="module")
def capture(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A coat over paint in uneven light."""
    folder = tmp_path_factory.mktemp("views")
    light = np.random.default_rng(5).random((16, 32, 3), dtype=np.float32) ** 3
    write_radiance(folder / "light.exr", light)
    settings = RadianceViewsSettings(material=COAT, size=32)
    path = folder / "coat.rsibr.exr"
    drain(bake(BakeJob(settings, str(path), Light(environment=str(folder / "light.exr")))))
    return path


def test_a_capture_of_a_model_tells_what_it_is(capture: Path) -> None:
    header = read_map_set_header(capture)
    assert header["material"] == {"spec": COAT, "name": COAT}
    assert header["settings"] == {"views": 12, "size": 32}  # nothing was rendered
    views = open_map_set(capture).content
    stated = {name: header["error_bound"][f"left_out_{name}"] for name in Warping}
    assert views.left_out == stated
    assert header["error_bound"]["relative_noise"] == 0.0
    assert told_facts(header)["Best warp"] == chosen_warping(WarpChoice.AUTO, stated)


def test_what_is_stated_is_about_what_new_views_err(capture: Path, tmp_path: Path) -> None:
    found = drain(compare(capture, QUICK, tmp_path / "out"))
    errors = {error.way.warping: error.pooled for error in found.errors}
    stated = open_map_set(capture).content.left_out
    assert found.reference_noise == 0.0
    assert found.material == COAT
    # A new view lies half as far from its sources as a captured one from its neighbours, but shows its rim
    for warping, error in errors.items():
        assert 0.3 * stated[warping] < error < 1.5 * stated[warping]
    assert min(errors, key=errors.__getitem__) is chosen_warping(WarpChoice.AUTO, stated)
    page = (tmp_path / "out" / "index.html").read_text()
    assert "integrated exactly" in page


def test_another_model_is_another_truth(capture: Path, tmp_path: Path) -> None:
    other = ViewsComparison(views=2, size=24, modes=(Mode.FRAGMENT,), material="lambert:kd=0.9")
    found = drain(compare(capture, other, tmp_path / "out"))
    assert min(error.pooled for error in found.errors) > 0.3


def test_a_report_shows_three_sources_and_their_sum(capture: Path, tmp_path: Path) -> None:
    page = drain(map_set_report(capture, tmp_path / "report.html")).read_text()
    assert "How a new view is blended" in page
    assert page.count(", captured</figcaption>") == page.count("warped and weighted</figcaption>") == 3
    assert page.count("their sum, the new view</figcaption>") == 1
