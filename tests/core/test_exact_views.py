"""Radiance views of reflectance models, against closed forms."""

import numpy as np
import pytest
from rsibr.rsibr_addon.core.brdf.lobe_width import is_resolved, narrowest_alpha
from rsibr.rsibr_addon.core.brdf.spec import brdf_from_spec
from rsibr.rsibr_addon.core.conventions import texel_centres
from rsibr.rsibr_addon.core.geometry.geodesic import geodesic_sphere
from rsibr.rsibr_addon.core.kinds.radiance_views.exact import (
    exact_maps,
    parts_of,
    ring_count,
)
from rsibr.rsibr_addon.core.maps import equirect
from rsibr.rsibr_addon.core.progress import drain
from rsibr.tests.synthetic_views import environment_radiance, lambert_maps

LIGHT = environment_radiance(equirect.direction_from_uv(texel_centres(64, 32))).astype(np.float32)
RNG = np.random.default_rng(8)


def model(spec: str):
    return brdf_from_spec(spec, lambda name, path: pytest.fail(path))


def test_a_lambert_sphere_is_what_its_harmonics_say() -> None:
    size, view_dirs = 16, list(geodesic_sphere(12).vertices)
    maps = drain(exact_maps(model("lambert:kd=1"), LIGHT, view_dirs, size))
    uv = texel_centres(size, size)
    inside = np.linalg.norm(2.0 * uv - 1.0, axis=-1) < 1.0 - 3.0 / size
    # The closed form is of a texel's centre, and ours its mean; the light is a map of 64 texels.
    np.testing.assert_allclose(np.stack(maps)[:, inside], lambert_maps(12, size)[:, inside], rtol=0.02)


@pytest.mark.parametrize(
    ("spec", "has"),
    [
        ("lambert:kd=0.5", (True, False)),
        ("ward:alpha=0.2,ks=0.3", (False, True)),
        ("ward:alpha=0.2,ks=0.3,kd=0.4", (True, True)),
        ("layered:coat=(ggx:alpha=0.2,f0=0.04),base=(lambert:kd=0.5)", (True, True)),
    ],
)
def test_a_model_is_the_sum_of_its_diffuse_and_its_glossy_part(spec: str, has: tuple[bool, bool]) -> None:
    parts = parts_of(model(spec))
    assert tuple(part is not None for part in parts) == has
    directions = RNG.normal(size=(2, 50, 3))
    directions[..., 2] = np.abs(directions[..., 2])
    directions /= np.linalg.norm(directions, axis=-1, keepdims=True)
    whole = sum(part(*directions) for part in parts if part)
    np.testing.assert_allclose(whole, model(spec)(*directions), rtol=1e-12)


@pytest.mark.parametrize(
    ("spec", "alpha"),
    [
        ("lambert:kd=0.5", 1.0),
        ("layered:coat=(ggx:alpha=0.02,f0=0.04),base=(ward:alpha=0.3,ks=0.5,kd=0.1)", 0.02),
        ("principled:roughness=0.5,coat_weight=0.5,coat_roughness=0.2", 0.04),
        ("principled:roughness=0.5", 0.25),
        # 0.05 of directions is half as much of normals
        ("phong:n=798,ks=0.3,kd=0.2", 0.025),
        ("retroreflective:n=798,ks=0.3", 0.025),
    ],
)
def test_a_narrow_lobe_takes_many_rings_and_fine_light(spec: str, alpha: float) -> None:
    assert narrowest_alpha(model(spec)) == pytest.approx(alpha)
    assert ring_count(16, 1024, alpha) == max(64, int(np.ceil(np.pi / alpha)))
    assert ring_count(16, 100, alpha) <= 100
    assert is_resolved(alpha, 1024)
    assert is_resolved(alpha, 64) is (alpha > 0.05)
