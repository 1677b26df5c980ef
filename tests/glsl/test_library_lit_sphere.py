"""Lit spheres on the GPU against `LitSphere.at`."""

import numpy as np
import pytest
from rsibr.rsibr_addon.core.geometry.camera import Camera
from rsibr.rsibr_addon.core.geometry.directions import camera_frame, dot
from rsibr.rsibr_addon.core.geometry.lit_sphere import LitSphere
from rsibr.rsibr_addon.device import buffers
from rsibr.rsibr_addon.device.context import ensure_context
from rsibr.rsibr_addon.device.lit_sphere import GpuLitSphere
from rsibr.rsibr_addon.device.preview import SAMPLES_PER_AXIS, PreviewRenderer
from rsibr.tests.glsl.evaluation import evaluate
from rsibr.tests.glsl.test_preview_renderer import SIZE, SPHERE, samples
from rsibr.tests.glsl.twins import unit_vectors

TWINS: dict[str, object] = {}
VIEW = (1.0, -0.7, 0.4)


def random_sphere() -> LitSphere:
    frame = camera_frame(np.array(VIEW) / np.linalg.norm(VIEW))
    return LitSphere(frame, np.random.default_rng(41).random((12, 32, 3)))


def test_lit_sphere_radiance() -> None:
    ensure_context()
    sphere = random_sphere()
    texels = np.ones((12, 34, 4), np.float32)
    texels[..., :3] = sphere.radiance[:, np.arange(-1, 33) % 32]
    matrix = ", ".join(repr(float(value)) for value in sphere.frame.T.ravel())
    normal = unit_vectors(42)
    # Straight at the camera's pole the azimuth is a matter of rounding.
    normal = normal[np.abs(dot(normal, sphere.frame[:, 2])) < 1.0 - 1e-9]
    code = f"result_0.rgb = lit_sphere_radiance(rings, mat3({matrix}), in_0.xyz);"
    samplers = {"rings": ("FLOAT_2D", buffers.texture(texels))}
    found = evaluate("lit_sphere_lib.glsl", code, [normal], samplers=samplers)[:, 0, :3]
    # Weights of texels may be rounded to 8 bits, 1 / 512 along a ring of differences up to 1; the four
    # rings' weights sum to at most 1.25 without their signs.
    assert np.abs(found - sphere.at(normal)).max() < 4e-3


@pytest.mark.parametrize("view_dir", [VIEW])
def test_a_picture_is_what_the_sphere_shows(view_dir: tuple[float, float, float]) -> None:
    ensure_context()
    sphere = random_sphere()
    camera = Camera(view_dir)
    normal, _, cosine = samples(camera)
    blocks = (SIZE, SAMPLES_PER_AXIS, SIZE, SAMPLES_PER_AXIS)
    inside = (cosine > 0.2).reshape(blocks).all(axis=(1, 3))
    expected = sphere.at(normal).reshape(*blocks, 3).mean(axis=(1, 3))
    picture = PreviewRenderer(GpuLitSphere(sphere)).draw(*SPHERE, camera, SIZE, None)
    # As above; facets turn normals by up to 2e-4, a thousandth of the rings' distance.
    assert np.abs(picture[..., :3] - expected)[inside].max() < 8e-3
    assert np.all(picture[inside, 3] == 1.0)
