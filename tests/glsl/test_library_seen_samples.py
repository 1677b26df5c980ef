"""Samples that are stored first and shaded afterwards, against a mesh that is shaded as it is drawn."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from rsibr.rsibr_addon.core.geometry.camera import Camera
from rsibr.rsibr_addon.core.kinds.environment import EnvironmentLook
from rsibr.rsibr_addon.core.kinds.radiance_views.shading import Mode, ViewsLook
from rsibr.rsibr_addon.device import preview
from rsibr.rsibr_addon.device.deferred import DeferredMesh
from rsibr.rsibr_addon.device.drawing import GpuMapSet
from rsibr.rsibr_addon.device.kinds.environment import GpuEnvironment
from rsibr.rsibr_addon.device.preview import PreviewRenderer
from rsibr.rsibr_addon.files.kinds.registry import STORED
from rsibr.rsibr_addon.tasks.methods.kinds import opened_map_set
from rsibr.tests.faults.small_map_sets import LIGHT, map_sets
from rsibr.tests.glsl.test_preview_renderer import Mesh, fine_sphere

SIZE = 16
CAMERA = Camera((0.3, -1.0, 0.4), 0.9)
KINDS = [*STORED, "environment", Mode.PAPER, Mode.TEXEL]


def drawable(kind: str) -> tuple[GpuMapSet, Any]:
    """A small map set of a kind, and a look; radiance views by any of their modes."""
    if kind == "environment":
        return GpuEnvironment(LIGHT), EnvironmentLook()
    views = kind in tuple(Mode)
    (map_set,) = (each for each in map_sets() if each.kind == ("radiance_views" if views else kind))
    look = ViewsLook(mode=Mode(kind)) if views else STORED[kind].look()
    return opened_map_set(Path("map.rsibr.exr"), map_set).drawable(), look


def open_shell() -> Mesh:
    """A bumpy sphere in a larger one that is open: outlines, both sides, and what others hide."""
    positions, normals, triangles = fine_sphere(48)
    bumpy = normals + 0.3 * np.sin(20.0 * positions[:, ::-1])
    opened = triangles[positions[triangles].mean(axis=1)[:, 1] > -0.3]
    return (
        np.concatenate([0.5 * positions, positions]),
        np.concatenate([bumpy, normals]),
        np.concatenate([triangles, opened + len(positions)]),
    )


@pytest.mark.filterwarnings("ignore:Maps of 4 texels blur")
@pytest.mark.parametrize("kind", KINDS)
def test_seen_samples(kind: str, monkeypatch: pytest.MonkeyPatch) -> None:
    content, look = drawable(kind)
    renderer = PreviewRenderer(content)
    drawn = renderer.draw(*open_shell(), CAMERA, SIZE, look)
    stored, store = [], DeferredMesh.store
    monkeypatch.setattr(DeferredMesh, "store", lambda *given: stored.append(store(*given)))
    monkeypatch.setattr(preview, "BLOCK", 10**6)
    deferred = renderer.draw(*open_shell(), CAMERA, SIZE, look)
    assert stored
    np.testing.assert_array_equal(deferred[..., 3], drawn[..., 3])
    error = np.abs(deferred - drawn)[drawn[..., 3] > 0.0]
    # Both are the same sums of single precision; where rounding decides how many lookups a sample takes, the
    # maps' noise is averaged otherwise.
    assert np.quantile(error, 0.9) < 1e-5
    assert error.max() < 0.05
