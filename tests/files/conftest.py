"""Data that several tests of files need."""

from collections.abc import Callable
from importlib.util import find_spec
from pathlib import Path

import numpy as np
import pytest
from rsibr.rsibr_addon.core.conventions import WORLD_AXES
from rsibr.rsibr_addon.files.map_set_data import MapSet


@pytest.fixture
def blender_worlds() -> Path:
    """The folder of Blender's own environments: mark what uses it with ``needs("bpy")``."""
    spec = find_spec("bpy")
    assert spec is not None
    assert spec.origin is not None
    (folder,) = Path(spec.origin).parent.glob("*/datafiles/studiolights/world")
    return folder


@pytest.fixture
def make_views() -> Callable[..., MapSet]:
    """A function that makes a small set of radiance views with random pixels."""
    return _make_views


def _make_views(views: int = 2, size: int = 20, seed: int = 0) -> MapSet:
    rng = np.random.default_rng(seed)
    view_dirs = rng.standard_normal((views, 3))
    view_dirs /= np.linalg.norm(view_dirs, axis=1, keepdims=True)
    parts = [{"name": "environment", "role": "environment"}] + [
        {"name": f"view{i:03d}.{role}", "role": role, "view": i, "view_dir": view_dirs[i].tolist()}
        for i in range(views)
        for role in ("diffuse", "glossy")
    ]
    shapes = [(12, 24, 3)] + [(size, size, 3)] * (2 * views)
    # Smooth plus a little noise, as renders are, so that the compression has something to do
    maps = {
        part["name"]: (1.0 + 1e-3 * rng.standard_normal(shape)).astype(np.float32)
        for part, shape in zip(parts, shapes, strict=True)
    }
    header = {
        "layout": "sphere_map",
        "size": [size, size],
        "axes": WORLD_AXES,
        "environment": {"name": "Wald über.exr", "sha256": "0" * 64, "size": [24, 12], "part": "environment"},
        "material": {"spec": "copper", "name": "copper", "fingerprint": "f"},
        "parts": parts,
        "error_bound": None,
        "settings": {"views": views, "size": size, "samples": 1, "denoise": False, "seed": seed},
        "software": "rsibr 0.1.0, Blender 5.2.0",
    }
    return MapSet("radiance_views", maps, header)
