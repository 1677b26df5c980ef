"""Light for Babylon.js, as its physical material sees it in a browser."""

from pathlib import Path

import numpy as np
import pytest
from rsibr.rsibr_addon.core.progress import drain
from rsibr.rsibr_addon.tasks.export.engines.export import export_for_engine
from rsibr.rsibr_addon.tasks.export.engines.settings import CubeSettings
from rsibr.tests.engine_light import diffuse_truth, from_y_up, sky_file
from rsibr.tests.web.browser import asked
from rsibr.tests.web.shown import SIZE, check_shown, directions

ALPHA = [0.0, *(2.0 ** (mip / 0.8) / SIZE for mip in range(1, 5))]
"""The shader looks up at 0.8 log2(alpha times width): never as far as the fifth mip, at alpha 1 at 4.8."""


LOOK = {
    # It takes alpha to be roughness^2 + 0.0005
    "roughness": [max(alpha - 0.0005, 0.0) ** 0.5 for alpha in ALPHA],
    "linear": False,
}
HANDS = [(False, (-1.0, 1.0, 1.0)), (True, (1.0, 1.0, 1.0))]
"""Babylon's own world is left-handed, and shows glTF's (x, y, z) at (-x, y, z)."""


@pytest.mark.slow
@pytest.mark.parametrize(("right_handed", "shown_at"), HANDS)
def test_babylon_shows_the_light_of_every_mip(
    right_handed: bool, shown_at: tuple[float, float, float], tmp_path: Path
) -> None:
    drain(export_for_engine(sky_file(tmp_path), tmp_path / "sky.env", "babylon", CubeSettings(size=SIZE)))
    at = (directions() * shown_at).tolist()
    question = {**LOOK, "file": "/files/sky.env", "directions": at, "rightHanded": right_handed}
    said = asked("babylon.html", question, tmp_path)
    # A byte of gamma 2.2 is 0.4 % of half the light; the rule leaves the widest lobes four and two texels
    check_shown(said["radiance"], [alpha**0.5 for alpha in ALPHA], 5e-3, between=0.03)
    check_diffuse(said["diffuse"])


@pytest.mark.slow
@pytest.mark.parametrize("ending", [".glb", ".gltf"])
def test_babylon_shows_the_light_of_gltf(ending: str, tmp_path: Path) -> None:
    drain(export_for_engine(sky_file(tmp_path), tmp_path / f"sky{ending}", "gltf", CubeSettings(size=SIZE)))
    at = (directions() * (-1.0, 1.0, 1.0)).tolist()
    roughness = [0.0, 0.5, 1.0]
    question = {"roughness": roughness, "linear": True, "rightHanded": False, "directions": at}
    said = asked("babylon.html", {**question, "file": f"/files/sky{ending}"}, tmp_path)
    check_shown(said["radiance"], roughness, 5e-3)
    check_diffuse(said["diffuse"])


def check_diffuse(shown: list[list[float]]) -> None:
    wanted = diffuse_truth(from_y_up(directions()))
    # Degree 2 leaves at most a few per cent of the mean [Ramamoorthi2001]
    assert np.abs(np.array(shown) - wanted).max() < 0.06 * wanted.mean()
