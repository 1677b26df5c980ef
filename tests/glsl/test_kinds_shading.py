"""How each kind of map sets is shaded without a driver, against what a driver draws."""

from pathlib import Path

import numpy as np
import pytest
from rsibr.rsibr_addon.core.geometry.camera import Camera
from rsibr.rsibr_addon.core.geometry.directions import reflect
from rsibr.rsibr_addon.core.pictures.sphere import sphere_pixels
from rsibr.rsibr_addon.device.preview import PreviewRenderer
from rsibr.rsibr_addon.files.kinds.registry import STORED
from rsibr.rsibr_addon.files.map_set_data import MapSet
from rsibr.rsibr_addon.tasks.methods.kinds import KINDS, opened_map_set
from rsibr.tests.faults.small_map_sets import map_sets
from rsibr.tests.glsl.test_preview_renderer import SIZE, SPHERE

CAMERA = Camera((0.3, -1.0, 0.4))

AT_ONCE = [each for each in map_sets() if not KINDS[each.kind].live]
"""Those that are not shaded by a draft first."""


@pytest.mark.parametrize("map_set", AT_ONCE, ids=lambda each: each.kind)
def test_a_sphere_is_shaded_as_it_is_drawn(map_set: MapSet) -> None:
    stored, path = STORED[map_set.kind], Path("map.rsibr.exr")
    renderer = PreviewRenderer(opened_map_set(path, map_set).drawable())
    drawn = renderer.draw(*SPHERE, CAMERA, SIZE, stored.look())
    seen = sphere_pixels(SIZE, CAMERA.view_dir)
    shaded = stored.shading(path, map_set)(
        seen.normal,
        np.broadcast_to(CAMERA.view_dir, seen.normal.shape),
        mirror_footprint=reflect(CAMERA.view_dir, seen.corner_normals),
    )
    whole = seen.coverage == 1.0
    error = np.abs(shaded - drawn[seen.inside][:, :3])[whole]
    # The maps are noise of a few texels: within a pixel, the one averages them in the middle alone, or by
    # other samples. Another direction, weight or look would be as far off as the noise, .3
    assert error.mean() < 0.02 * shaded[whole].mean()
