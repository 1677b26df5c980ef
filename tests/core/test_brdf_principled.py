"""Cycles' Principled BSDF: what follows of its definition without a renderer."""

from dataclasses import replace

import numpy as np
import pytest
from rsibr.rsibr_addon.core.brdf.albedo import directional_albedo, hemisphere_quadrature
from rsibr.rsibr_addon.core.brdf.fresnel import Index
from rsibr.rsibr_addon.core.brdf.ggx import Ggx
from rsibr.rsibr_addon.core.brdf.oren_nayar import leaning_albedo, tilt
from rsibr.rsibr_addon.core.brdf.principled import ExactAlbedos, Principled, Surface, layers_of
from rsibr.rsibr_addon.core.brdf.sheen_polynomials import sheen_at

MU = np.array([0.1, 0.3, 0.7, 1.0])


@pytest.mark.parametrize("roughness", [0.3, 0.6, 1.0])
def test_a_white_metal_loses_nothing(roughness: float) -> None:
    white = Principled(base_color=1.0, metallic=1.0, roughness=roughness)
    # Albedos are interpolated between 33 elevations
    np.testing.assert_allclose(directional_albedo(white, MU), 1.0, atol=2e-3)


@pytest.mark.parametrize("coat_weight", [0.0, 1.0])
def test_white_plastic_loses_nothing(coat_weight: float) -> None:
    white = Principled(base_color=1.0, roughness=0.5, coat_weight=coat_weight, coat_roughness=0.3)
    # Every layer reflects what it takes from those below; sums of powers err by .2 % of dielectrics
    np.testing.assert_allclose(directional_albedo(white, MU), 1.0, atol=3e-3)


@pytest.mark.parametrize("roughness", [0.3, 1.0])
def test_rough_white_facets_lose_nothing(roughness: float) -> None:
    white = Principled(base_color=1.0, specular_level=0.0, diffuse_roughness=roughness)
    # Cycles' mean albedo has two digits after the point
    np.testing.assert_allclose(directional_albedo(white, MU), 1.0, atol=5e-3)


def test_a_smooth_base_without_boundary_is_lambert_s() -> None:
    matte = Principled(base_color=(0.2, 0.4, 0.6), specular_level=0.0)
    light_dir = np.array([[0.6, 0.0, 0.8], [0.0, -0.8, 0.6]])
    found = matte(light_dir, np.array([0.0, 0.6, 0.8]))
    np.testing.assert_allclose(found, np.array([[0.2, 0.4, 0.6]] * 2) / np.pi, rtol=1e-12)


@pytest.mark.parametrize("coated", [False, True])
def test_a_smooth_boundary_over_black_is_glass(coated: bool) -> None:
    boundary = {"coat_weight": 1.0, "coat_roughness": 0.2, "specular_level": 0.0} if coated else {}
    black = Principled(base_color=0.0, roughness=0.2, **boundary)
    glass = Ggx(alpha=0.04, fresnel=Index(eta=1.5))
    light_dir, _ = hemisphere_quadrature(0.5)
    view_dir = np.array([np.sqrt(0.75), 0.0, 0.5])
    # Four powers err by up to .5 % of glass, bounces between facets add .2 %
    np.testing.assert_allclose(black(light_dir, view_dir), glass(light_dir, view_dir), rtol=0.01)


def test_a_tinted_coat_colours_what_is_below() -> None:
    """From straight above, the way through the coat is 1."""
    tinted = Principled(base_color=1.0, coat_weight=1.0, coat_tint=(0.25, 0.5, 1.0))
    clear = Principled(base_color=1.0, coat_weight=1.0)
    coat = directional_albedo(Principled(base_color=0.0, specular_level=0.0, coat_weight=1.0), 1.0)
    below = (directional_albedo(tinted, 1.0) - coat) / (directional_albedo(clear, 1.0) - coat)
    np.testing.assert_allclose(below, [0.25, 0.5, 1.0], rtol=1e-9)


@pytest.mark.parametrize("index", [1.0, 1.5])
def test_a_coat_s_tint_above_1_brightens_and_stays_finite(index: float) -> None:
    """Of index 1 it has no end at grazing."""
    surface = Surface(metallic=1.0, coat_weight=1.0, coat_ior=index, coat_tint=(2.0, 20.0, 1e30))
    for mu in (1e-6, 0.01, 1.0):
        base = layers_of(surface, mu, ExactAlbedos()).base
        assert np.isfinite(base).all()
    clear = layers_of(replace(surface, coat_tint=(1.0, 1.0, 1.0)), 1.0, ExactAlbedos()).base
    np.testing.assert_allclose(base[0, :2] / clear[0, :2], [2.0, 20.0], rtol=1e-9)


@pytest.mark.parametrize("roughness", [0.0, 0.3, 1.0])
def test_white_fibres_on_black_reflect_their_albedo_and_none_above_white(roughness: float) -> None:
    fibres = {"specular_level": 0.0, "sheen_weight": 1.0, "sheen_roughness": roughness}
    albedo = sheen_at(roughness, MU).albedo[:, None] * np.ones(3)
    # The quadrature is made for smooth lobes
    found = directional_albedo(Principled(base_color=0.0, **fibres), MU)
    np.testing.assert_allclose(found, albedo, atol=2e-3)
    np.testing.assert_allclose(directional_albedo(Principled(base_color=1.0, **fibres), MU), 1.0, atol=2e-3)


def test_the_edge_of_a_metal_takes_its_tint() -> None:
    """At 82 degrees, whose cosine is 1/7, between light and half vector."""
    grazing = np.array([np.sqrt(48.0) / 7.0, 0.0, 1.0 / 7.0])
    shown = {
        tint: Principled(base_color=0.5, metallic=1.0, roughness=0.1, specular_tint=tint)(
            grazing, grazing * (-1.0, 1.0, 1.0)
        )
        for tint in (0.25, 1.0)
    }
    # Bounces differ by the mean reflectance; at alpha .01 they are as good as none
    np.testing.assert_allclose(shown[0.25] / shown[1.0], 0.25, rtol=2e-3)


@pytest.mark.parametrize("mu", [0.2, 0.9])
def test_the_albedo_of_leaning_facets_is_their_integral(mu: float) -> None:
    light_dir, weight = hemisphere_quadrature(mu)
    view_dir = np.array([np.sqrt(1.0 - mu**2), 0.0, mu])
    leaning = tilt(light_dir[:, 2], np.full(len(light_dir), mu), light_dir @ view_dir)
    assert weight @ (light_dir[:, 2] * leaning) == pytest.approx(leaning_albedo(mu), abs=1e-4)
