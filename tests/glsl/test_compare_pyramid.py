"""`rsibr compare` of kernel pyramids: right for what they show, and told of that material alone."""

from pathlib import Path

import numpy as np
import pytest
from rsibr.rsibr_addon.core.environment import Environment
from rsibr.rsibr_addon.core.errors import RangeError
from rsibr.rsibr_addon.core.kinds.kernel_pyramid.bake import bake_pyramid
from rsibr.rsibr_addon.core.kinds.kernel_pyramid.look import PrincipledLook
from rsibr.rsibr_addon.core.progress import drain
from rsibr.rsibr_addon.files.kinds.kernel_pyramid import to_map_set
from rsibr.rsibr_addon.files.map_set import write_map_set
from rsibr.rsibr_addon.files.map_set_header import Origin
from rsibr.rsibr_addon.files.output_paths import comparison_beside
from rsibr.rsibr_addon.settings.kernel_pyramid import PyramidComparison
from rsibr.rsibr_addon.tasks.compare.compare import compare
from rsibr.rsibr_addon.tasks.compare.measured_error import measured_facts, measured_sentence

pytestmark = pytest.mark.needs("gl")

LIGHT = np.random.default_rng(61).random((64, 128, 3), dtype=np.float32) ** 2
METAL = {"metallic": 1.0, "roughness": 0.7, "base_color": (0.9, 0.6, 0.3)}
QUICK = {"views": 2, "size": 32, "rings": 24}


@pytest.fixture
def path(tmp_path: Path) -> Path:
    baked = drain(bake_pyramid(LIGHT, 128))
    origin = Origin(Environment(LIGHT, "noise"), {}, "test")
    write_map_set(tmp_path / "noise.rsibr.exr", to_map_set(baked, origin))
    return tmp_path / "noise.rsibr.exr"


def test_a_metal_is_as_close_as_spheres_are_and_told_of_itself_alone(path: Path) -> None:
    found = drain(compare(path, PyramidComparison(**METAL, **QUICK), comparison_beside(path)))
    assert found.material == "principled:base_color=0.9/0.6/0.3,metallic=1.0,roughness=0.7"
    (error,) = found.errors
    # What is asked of textured spheres
    assert 0.0 < error.worst < 0.03
    pooled, worst = f"{100.0 * error.pooled:.2g} %", f"{100.0 * error.worst:.2g} %"
    assert measured_facts(path) == {
        "Measured": f"{pooled}, at worst {worst}",
        "Against": "the model itself, 2 views",
    }
    assert measured_sentence(path, PrincipledLook(own=False, **METAL)) == (
        f"On the whole {pooled} off the model itself, {worst} in the worst of 2 views."
    )
    assert measured_sentence(path, PrincipledLook(own=True, **METAL)) == ""
    assert measured_sentence(path, PrincipledLook(own=False)) == ""


def test_a_mirror_is_refused(tmp_path: Path, path: Path) -> None:
    with pytest.raises(RangeError, match="roughness is 0, but it must be greater than 0"):
        drain(compare(path, PyramidComparison(roughness=0.0, **QUICK), tmp_path / "out"))
