"""Light for three.js, as its physical material sees it in a browser."""

from pathlib import Path

import numpy as np
import pytest
from rsibr.rsibr_addon.core.progress import drain
from rsibr.rsibr_addon.tasks.export.engines.export import export_for_engine
from rsibr.rsibr_addon.tasks.export.engines.settings import CubeSettings
from rsibr.tests.engine_light import diffuse_truth, from_y_up, sky_file
from rsibr.tests.web.browser import asked
from rsibr.tests.web.shown import SIZE, check_shown, directions

ROUGHNESS = [float(1.0 - np.sqrt(1.0 - mip / 3)) for mip in range(4)]
"""The shader looks up at last (2 r - r^2), down to 8 texels."""


@pytest.mark.slow
@pytest.mark.parametrize(("ending", "relative"), [(".ktx2", 1e-3), (".dds", 0.02)])
def test_three_shows_the_light_of_every_mip(ending: str, relative: float, tmp_path: Path) -> None:
    drain(export_for_engine(sky_file(tmp_path), tmp_path / f"sky{ending}", "three", CubeSettings(size=SIZE)))
    normal = directions()
    question = {"file": f"/files/sky{ending}", "roughness": ROUGHNESS, "directions": normal.tolist()}
    said = asked("three.html", question, tmp_path)
    assert said["revision"] == "187"
    check_shown(said["radiance"], ROUGHNESS, relative)
    # White light that a matte surface reflects comes from the last mip
    wanted = diffuse_truth(from_y_up(normal))
    assert np.median(np.abs(np.array(said["diffuse"]) - wanted) / wanted) < relative
