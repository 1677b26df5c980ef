"""Both lights of a mip chain are what Cycles shows of the surfaces that they stand for."""

from collections.abc import Callable

import numpy as np
import pytest
from rsibr.rsibr_addon.core.conventions import texel_centres
from rsibr.rsibr_addon.core.filtering.harmonics.analysis import analyse_environment
from rsibr.rsibr_addon.core.geometry.directions import reflect
from rsibr.rsibr_addon.core.kinds.mip_chain.chain import MipChain
from rsibr.rsibr_addon.core.kinds.mip_chain.lobe_mips import environment_faces
from rsibr.rsibr_addon.core.kinds.mip_chain.shading import Borders, diffuse_radiance, glossy_radiance
from rsibr.rsibr_addon.core.maps import sphere_map
from rsibr.tests.cycles.test_reflection_tables import CAMERA, FINE, SIZE, rendered, shader
from rsibr.tests.mirror_capture import environment


def chain() -> MipChain:
    radiance = environment().radiance
    faces = environment_faces(radiance, 128).astype(np.float32)
    return MipChain((faces,), analyse_environment(radiance, 2).real(2))


def mirrored(normal: np.ndarray) -> np.ndarray:
    mirror_dir = reflect(np.broadcast_to(CAMERA.view_dir, normal.shape), normal)
    return glossy_radiance(chain(), mirror_dir, 0.0, Borders.SEAMLESS)


def diffuse(normal: np.ndarray) -> np.ndarray:
    return diffuse_radiance(chain(), normal, (1.0, 1.0, 1.0))


@pytest.mark.parametrize(
    ("kind", "values", "samples", "shaded", "error"),
    [
        # Texels of 3 degrees, looked up in the faces' own: some thousandths
        ("Glossy", {"Roughness": 0.0}, 64, mirrored, 0.02),
        # Nine harmonics leave out degree 4 of the light, with a 24th of its weight
        ("Diffuse", {}, 256, diffuse, 0.03),
    ],
    ids=["mirrored", "diffuse"],
)
def test_a_light_is_what_cycles_renders(
    kind: str,
    values: dict[str, float],
    samples: int,
    shaded: Callable[[np.ndarray], np.ndarray],
    error: float,
) -> None:
    reference, noise = rendered(shader(kind, **values), samples)
    normal = sphere_map.normal_from_uv(texel_centres(FINE, FINE)) @ CAMERA.frame.T
    shown = shaded(normal).reshape(SIZE, 4, SIZE, 4, 3).mean(axis=(1, 3))
    inside = np.linalg.norm(2.0 * texel_centres(SIZE, SIZE) - 1.0, axis=-1) < 0.9
    scale = np.sqrt(np.mean(reference[inside] ** 2))
    # The largest of a thousand values has four standard errors.
    assert np.abs(shown - reference)[inside].max() < (4.0 * noise + error) * scale
    assert np.std(shown[inside]) > 0.1 * scale
