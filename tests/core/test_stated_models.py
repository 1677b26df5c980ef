"""What reflection tables and mip chains are compared with: reflectances against their energy."""

import numpy as np
import pytest
from rsibr.rsibr_addon.core.brdf.fresnel import Schlick, fresnel_schlick
from rsibr.rsibr_addon.core.brdf.ggx import Ggx
from rsibr.rsibr_addon.core.brdf.model import BrdfFunction
from rsibr.rsibr_addon.core.conventions import texel_centres
from rsibr.rsibr_addon.core.errors import RangeError
from rsibr.rsibr_addon.core.kinds.mip_chain.model import glossy_model
from rsibr.rsibr_addon.core.kinds.reflection_tables.integral import lobes_reflectance, mirrors
from rsibr.rsibr_addon.core.kinds.reflection_tables.material import material_from_texts
from rsibr.rsibr_addon.core.kinds.reflection_tables.tables import Role
from rsibr.rsibr_addon.core.kinds.reflection_tables.weights import share_above_horizon, table_weights
from rsibr.rsibr_addon.core.maps import equirect

COSINES = np.array([0.1, 0.5, 0.95])
LIGHT = equirect.direction_from_uv(texel_centres(360, 180)).reshape(-1, 3)
AREA = equirect.texel_solid_angle(360, 180).reshape(-1, 1)


def reflected(model: BrdfFunction, cosine: float) -> np.ndarray:
    """Radiance in even light of radiance 1, summed over texels of a degree."""
    view = np.array([np.sqrt(1.0 - cosine**2), 0.0, cosine])
    return (model(LIGHT, view) * AREA * np.maximum(LIGHT[:, 2:], 0.0)).sum(axis=0)


@pytest.mark.parametrize("role", ["specular", "retro"])
def test_lobes_reflect_what_of_them_is_above_the_horizon(role: str) -> None:
    parts = {
        "diffuse": "lambert:kd=0.5/0.4/0.3",
        role: "phong:n=20,ks=0.3/0.2/0.1",
        "weights": "constant:k=0.6",
    }
    model = lobes_reflectance(material_from_texts(parts, None))
    lobe = 0.6 if role == "specular" else 0.4
    for cosine in COSINES:
        share = share_above_horizon(np.array([cosine]), 20.0)[0]
        expected = 0.4 * np.array([0.5, 0.4, 0.3]) + lobe * share * np.array([0.3, 0.2, 0.1])
        # A lobe is cut within a texel of the horizon: there a degree of its width of ten or so
        np.testing.assert_allclose(reflected(model, cosine), expected, rtol=0.01)


def test_mirrors_are_the_environment_and_have_weights_of_their_own() -> None:
    radiance = np.random.default_rng(3).random((8, 16, 3), dtype=np.float32)
    parts = {"diffuse": "luminous:kd=0.5", "emission": "1/0/0", "coat": "fresnel:eta=1.5"}
    material = material_from_texts(parts, None)
    assert lobes_reflectance(material) is None
    found = mirrors(material, radiance)
    np.testing.assert_array_equal(found.maps[Role.COAT], radiance)
    mean = np.average(
        radiance, axis=(0, 1), weights=np.broadcast_to(equirect.texel_solid_angle(16, 8), (8, 16))
    )
    np.testing.assert_allclose(found.maps[Role.DIFFUSE][0, 0], 0.5 * mean + (1.0, 0.0, 0.0), rtol=1e-6)
    cosines = (np.arange(found.weights.shape[1]) + 0.5) / found.weights.shape[1]
    np.testing.assert_allclose(found.weights, table_weights(material, cosines=cosines), rtol=1e-6)
    assert mirrors(material_from_texts({"diffuse": "lambert:kd=1"}, None), radiance) is None


def test_a_phong_mip_reflects_its_share_of_the_view() -> None:
    f0, kd = (0.04, 0.5, 0.9), (0.8, 0.4, 0.1)
    model = glossy_model(f0, kd, None, 30.0)
    for cosine in COSINES:
        fresnel = fresnel_schlick(cosine, f0)
        share = share_above_horizon(np.array([cosine]), 30.0)[0]
        expected = (1.0 - fresnel) * kd + fresnel * share
        np.testing.assert_allclose(reflected(model, cosine), expected, rtol=0.01)


def test_a_rough_mip_is_microfacets_over_what_their_fresnel_term_leaves() -> None:
    rng = np.random.default_rng(4)
    light, view = rng.normal(size=(2, 200, 3)) + (0.0, 0.0, 1.0)
    light, view = (each / np.linalg.norm(each, axis=1, keepdims=True) for each in (light, view))
    found = glossy_model((0.2, 0.2, 0.2), (0.5, 0.5, 0.5), 0.5, None)(light, view)
    above = (light[:, 2] > 0.0) & (view[:, 2] > 0.0)
    assert 50 < above.sum() < 200
    facets = Ggx(alpha=0.25, fresnel=Schlick(f0=0.2))(light, view)
    diffuse = (1.0 - fresnel_schlick(view[:, 2], 0.2)) * 0.5 / np.pi
    np.testing.assert_allclose(found[above], (facets + diffuse[:, None])[above])
    np.testing.assert_array_equal(found[~above], 0.0)


def test_a_mirror_has_no_reflectance() -> None:
    with pytest.raises(RangeError, match="give a roughness above 0"):
        glossy_model((1.0, 1.0, 1.0), (0.0, 0.0, 0.0), 0.0, None)
