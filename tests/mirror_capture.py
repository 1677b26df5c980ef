"""A capture known in closed form: a perfect mirror in a smooth environment with one bright side."""

from pathlib import Path

import numpy as np
from rsibr.rsibr_addon.core.conventions import WORLD_AXES, texel_centres
from rsibr.rsibr_addon.core.environment import Environment
from rsibr.rsibr_addon.core.geometry.directions import camera_frame, reflect
from rsibr.rsibr_addon.core.geometry.geodesic import geodesic_sphere
from rsibr.rsibr_addon.core.maps import equirect, sphere_map
from rsibr.rsibr_addon.files.map_set import write_map_set
from rsibr.rsibr_addon.files.map_set_data import MapSet

BRIGHT_DIR = np.array([0.48, -0.6, 0.64])
"""Where most light comes from: nothing else about the environment is symmetric about an axis."""


def radiance_from(direction: np.ndarray) -> np.ndarray:
    """Radiance of the environment, shape (..., 3): it changes by at most 1.7 a radian."""
    lobe = np.exp(4.0 * (direction @ BRIGHT_DIR - 1.0))[..., None]
    return (
        0.05
        + lobe * np.array([1.0, 0.5, 0.25])
        + 0.1 * (1.0 + direction[..., :1]) * np.array([0.0, 0.0, 1.0])
    )


def environment(height: int = 64) -> Environment:
    """The environment as a map."""
    radiance = radiance_from(equirect.direction_from_uv(texel_centres(2 * height, height)))
    return Environment(radiance.astype(np.float32), "one bright side")


def mirror_map_set(view_count: int = 12, size: int = 64, fingerprint: str = "none") -> MapSet:
    """What a flawless capture of the mirror would hold."""
    normals = sphere_map.normal_from_uv(texel_centres(size, size))
    light = environment()
    maps = {"environment": light.radiance}
    parts: list[dict] = [{"name": "environment", "role": "environment"}]
    for view, view_dir in enumerate(geodesic_sphere(view_count).vertices):
        reflect_dir = reflect(np.broadcast_to(view_dir, normals.shape), normals @ camera_frame(view_dir).T)
        seen = {"diffuse": np.zeros_like(normals), "glossy": radiance_from(reflect_dir)}
        for role, radiance in seen.items():
            name = f"view{view:03d}.{role}"
            maps[name] = radiance.astype(np.float32)
            parts.append({"name": name, "role": role, "view": view, "view_dir": view_dir.tolist()})
    header = {
        "layout": "sphere_map",
        "size": [size, size],
        "axes": WORLD_AXES,
        "environment": {
            "name": light.name,
            "sha256": light.sha256,
            "size": [light.radiance.shape[1], light.radiance.shape[0]],
            "part": "environment",
        },
        "material": {"spec": "mirror", "name": "mirror", "fingerprint": fingerprint},
        "parts": parts,
        "error_bound": None,
        "settings": {"views": view_count, "size": size, "samples": 0, "denoise": False, "seed": 0},
        "software": "tests",
    }
    return MapSet("radiance_views", maps, header)


def write_mirror_capture(path: Path, view_count: int = 12, size: int = 64, fingerprint: str = "none") -> Path:
    """Write `mirror_map_set` and return its path."""
    write_map_set(path, mirror_map_set(view_count, size, fingerprint))
    return path
