"""Lobes for engines, as three.js shades with them in a browser."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from rsibr.rsibr_addon.command_line.main import run
from rsibr.rsibr_addon.core.brdf.principled import Surface
from rsibr.rsibr_addon.core.kinds.kernel_pyramid.bake import bake_pyramid
from rsibr.rsibr_addon.core.kinds.kernel_pyramid.shading import principled_radiance
from rsibr.rsibr_addon.core.progress import drain
from rsibr.rsibr_addon.files.kinds.kernel_pyramid import shipped_families
from rsibr.tests.engine_light import from_y_up, sky, sky_file
from rsibr.tests.web.browser import asked

MATERIALS: list[dict[str, Any]] = [
    {"color": (0.9, 0.6, 0.3), "metalness": 1.0, "roughness": 0.15},
    {"color": (0.9, 0.6, 0.3), "metalness": 1.0, "roughness": 0.6},
    {"color": (0.9, 0.6, 0.3), "metalness": 1.0, "roughness": 1.0},
    {"color": (0.5, 0.1, 0.05), "metalness": 0.0, "roughness": 0.3},
    {"color": (0.2, 0.4, 0.6), "metalness": 0.4, "roughness": 0.5},
]


def points() -> tuple[np.ndarray, np.ndarray]:
    """Normals and views of a world with Y up, the latter from 5 degrees above the surface on."""
    rng = np.random.default_rng(4)
    normal, view_dir = rng.normal(size=(2, 400, 3))
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    view_dir /= np.linalg.norm(view_dir, axis=1, keepdims=True)
    seen = np.einsum("ij,ij->i", normal, view_dir) > 0.09
    return normal[seen][:60], view_dir[seen][:60]


@pytest.mark.slow
def test_three_shades_with_lobes_as_core_does(tmp_path: Path) -> None:
    """Half floats and 8-bit weights of texels cost less than 1 %; the lookups are core's own."""
    light = str(sky_file(tmp_path))
    assert run(["export", light, "--for", "lobes", "--widest", "128", "-o", str(tmp_path / "sky.ktx2")]) == 0
    normal, view_dir = points()
    question = {
        "name": "/files/sky",
        "materials": MATERIALS,
        "points": np.stack([normal, view_dir], axis=1).tolist(),
    }
    said = asked("lobes.html", question, tmp_path)
    pyramid, families = drain(bake_pyramid(sky(), 128)).pyramid, shipped_families()
    for material, shown in zip(MATERIALS, said["radiance"], strict=True):
        surface = Surface(
            base_color=np.array(material["color"]),
            metallic=np.array(material["metalness"]),
            roughness=np.array(material["roughness"]),
        )
        wanted = principled_radiance(pyramid, families, surface, from_y_up(normal), from_y_up(view_dir))
        error = np.array(shown) - wanted
        assert np.sqrt(np.mean(error**2) / np.mean(wanted**2)) < 0.01, material
