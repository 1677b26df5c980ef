"""What every reflectance model promises, and closed forms of each."""

import numpy as np
import pytest
from rsibr.rsibr_addon.core.brdf.albedo import directional_albedo
from rsibr.rsibr_addon.core.brdf.car_paint import PAINTS, CarPaint
from rsibr.rsibr_addon.core.brdf.cook_torrance import CookTorrance
from rsibr.rsibr_addon.core.brdf.fresnel import Index, Schlick
from rsibr.rsibr_addon.core.brdf.ggx import Ggx, ggx_ndf, smith_visibility
from rsibr.rsibr_addon.core.brdf.he_torrance import HeTorrance
from rsibr.rsibr_addon.core.brdf.lambert import Lambert
from rsibr.rsibr_addon.core.brdf.layered import Beneath, Layered, Sum
from rsibr.rsibr_addon.core.brdf.metals import METALS
from rsibr.rsibr_addon.core.brdf.model import Brdf
from rsibr.rsibr_addon.core.brdf.phong import Phong
from rsibr.rsibr_addon.core.brdf.retroreflective import Retroreflective
from rsibr.rsibr_addon.core.brdf.ward import Ward
from rsibr.rsibr_addon.core.errors import RangeError

MIRROR = Schlick(f0=1.0)
GLASS = Index(eta=1.5)

MODELS: dict[str, Brdf] = {
    "lambert": Lambert(kd=(0.9, 0.5, 0.1)),
    "phong": Phong(n=40.0, ks=(0.6, 0.5, 0.4), kd=0.3),
    "ward": Ward(alpha=0.04, ks=0.8),
    "wide ward": Ward(alpha=0.5, ks=0.6, kd=0.2),
    "copper": Ggx(alpha=0.3, fresnel=METALS["copper"]),
    "narrow coat": Ggx(alpha=0.01, fresnel=GLASS),
    "roughest ggx": Ggx(alpha=1.0, fresnel=MIRROR),
    "cook-torrance": CookTorrance(alpha=0.2, fresnel=METALS["gold"], ks=(0.9, 0.8, 0.7)),
    "he-torrance": HeTorrance(sigma=0.18, tau=3.0, fresnel=METALS["aluminium"], kd=0.05),
    "retroreflective": Retroreflective(n=20.0, ks=0.7),
    "varnish": Layered(coat=Ggx(alpha=0.1, fresnel=GLASS), base=Lambert(kd=(1.0, 0.5, 0.0))),
    "sum": Sum(parts=(Lambert(kd=0.2), Retroreflective(n=5.0, ks=0.3))),
    "car paint": CarPaint(name="polaris_silber"),
}

by_model = pytest.mark.parametrize("brdf", MODELS.values(), ids=MODELS.keys())


def hemisphere(count: int, seed: int) -> np.ndarray:
    """Directions above the horizon, evenly by solid angle, with some at its very edge and one at the top."""
    rng = np.random.default_rng(seed)
    z = np.concatenate([rng.random(count - 6), [1e-9, 1e-6, 1e-4, 1e-2, 1.0 - 1e-12, 1.0]])
    phi = 2.0 * np.pi * rng.random(count)
    radius = np.sqrt(1.0 - z**2)
    return np.stack([radius * np.cos(phi), radius * np.sin(phi), z], axis=-1)


LIGHT, VIEW = hemisphere(400, 1)[:, None], hemisphere(60, 2)[None]


@by_model
def test_light_and_view_may_be_swapped(brdf: Brdf) -> None:
    forwards, backwards = brdf(LIGHT, VIEW), brdf(VIEW, LIGHT)
    # Rounding of cosines, 1e-16, times the steepest slope of a logarithm here: 2 / alpha^2 = 2e4
    np.testing.assert_allclose(forwards, backwards, rtol=1e-9, atol=1e-300)


@by_model
def test_reflectance_is_finite_and_not_negative(brdf: Brdf) -> None:
    values = brdf(LIGHT, VIEW)
    assert values.shape == (400, 60, 3)
    assert np.isfinite(values).all()
    assert values.min() >= 0.0
    # At the mirror and the view direction themselves, where cosines may round beyond 1
    exact = brdf(VIEW, VIEW * (-1.0, -1.0, 1.0)), brdf(VIEW, VIEW)
    assert np.isfinite(exact).all()


@by_model
def test_nothing_is_reflected_to_or_from_below(brdf: Brdf) -> None:
    up, down = hemisphere(9, 3), hemisphere(9, 4) * (1.0, 1.0, -1.0)
    horizon = np.array([1.0, 0.0, 0.0])
    for light_dir, view_dir in ((up, down), (down, up), (down, down), (up, horizon), (horizon, up)):
        assert not brdf(light_dir, view_dir).any()
    assert brdf(np.zeros((0, 3)), np.zeros((0, 3))).shape == (0, 3)


@by_model
def test_turning_and_mirroring_change_nothing(brdf: Brdf) -> None:
    cosine, sine = np.cos(2.0), np.sin(2.0)
    turn = np.array([[cosine, -sine, 0.0], [sine, cosine, 0.0], [0.0, 0.0, 1.0]])
    mirror = np.diag([1.0, -1.0, 1.0])
    expected = brdf(LIGHT, VIEW)
    for matrix in (turn, mirror):
        # As for swapped directions; 1e-12 of the lobe's height where it is down by many powers of ten
        np.testing.assert_allclose(
            brdf(LIGHT @ matrix.T, VIEW @ matrix.T), expected, rtol=1e-7, atol=1e-12 * expected.max()
        )


@by_model
def test_no_more_light_is_reflected_than_arrives(brdf: Brdf) -> None:
    albedo = directional_albedo(brdf, [1.0, 0.6, 0.3, 0.1, 0.03])
    # 1e-4: the quadrature's promise is 5e-4, and the models here that reflect nearly all are smooth
    assert albedo.max() <= 1.0 + 1e-4


@by_model
def test_layers_add_up_to_the_model(brdf: Brdf) -> None:
    total = sum(layer(LIGHT, VIEW) for layer in brdf.layers)
    np.testing.assert_allclose(total, brdf(LIGHT, VIEW), rtol=1e-12)


def test_layers_are_told_apart() -> None:
    assert MODELS["copper"].layers == (MODELS["copper"],)
    assert MODELS["phong"].layers == (Phong(n=40.0, ks=(0.6, 0.5, 0.4)), Lambert(kd=0.3))
    assert len(MODELS["car paint"].layers) == 4
    coat, base = MODELS["varnish"].layers
    assert isinstance(base, Beneath)
    assert coat == Ggx(alpha=0.1, fresnel=GLASS)


def normal_albedo(brdf: Brdf) -> np.ndarray:
    """Albedo at normal incidence by a plain sum over a hundred thousand angles: no quadrature of ours."""
    edges = np.linspace(0.0, 1.0, 100_001) ** 3 * (np.pi / 2.0)  # dense where lobes are narrow
    theta = (edges[1:] + edges[:-1]) / 2.0
    light_dir = np.stack([np.sin(theta), np.zeros_like(theta), np.cos(theta)], axis=-1)
    ring = 2.0 * np.pi * (np.cos(edges[:-1]) - np.cos(edges[1:]))
    return (ring * np.cos(theta)) @ brdf(light_dir, [0.0, 0.0, 1.0])


@by_model
def test_quadrature_agrees_with_a_plain_sum_at_normal_incidence(brdf: Brdf) -> None:
    expected = normal_albedo(brdf)
    # The promise of directional_albedo
    np.testing.assert_allclose(directional_albedo(brdf, 1.0), expected, rtol=5e-4)


def test_cosine_lobes_have_their_closed_form_albedo() -> None:
    for n in (0.0, 1.0, 7.5, 500.0, 1e5):
        for brdf in (Phong(n=n, ks=0.7), Retroreflective(n=n, ks=0.7)):
            np.testing.assert_allclose(directional_albedo(brdf, 1.0), 0.7, rtol=1e-5)
    # A narrow lobe that lies above the horizon as a whole has (n + 2) / (n + 2) of the cosine of its axis
    np.testing.assert_allclose(directional_albedo(Phong(n=1e5, ks=0.7), 0.25), 0.7 * 0.25, rtol=1e-4)


def test_ward_peaks_where_and_as_high_as_the_paper_says() -> None:
    brdf, theta = Ward(alpha=0.2, ks=0.5, kd=0.1), np.radians(50.0)
    view, mirror = [np.sin(theta), 0.0, np.cos(theta)], [-np.sin(theta), 0.0, np.cos(theta)]
    expected = 0.1 / np.pi + 0.5 / (4.0 * np.pi * 0.2**2 * np.cos(theta))
    np.testing.assert_allclose(brdf(mirror, view), expected, rtol=1e-12)
    # The half vector leans half as much as the light: by 0.1 from the normal
    tilted = [-np.sin(theta - 0.2), 0.0, np.cos(theta - 0.2)]
    gaussian = np.exp(-(np.tan(0.1) ** 2) / 0.2**2) / np.sqrt(np.cos(theta) * np.cos(theta - 0.2))
    expected = 0.1 / np.pi + 0.5 / (4.0 * np.pi * 0.2**2) * gaussian
    np.testing.assert_allclose(brdf(tilted, view), expected, rtol=1e-12)


@pytest.mark.parametrize("alpha", [0.01, 0.3, 1.0])
def test_ggx_facets_cover_the_surface_as_every_view_sees_it(alpha: float) -> None:
    # Smith's masking is made so that the visible facets, projected, have the area of the surface
    # [Heitz2014 Eq. 19]; without shadowing (light from all around, below the horizon too) a mirror is white
    theta = np.linspace(0.0, 1.0, 4001) ** 3 * (np.pi / 2.0)
    theta_h = (theta[1:] + theta[:-1])[:, None] / 2.0
    ring = (np.cos(theta[:-1]) - np.cos(theta[1:]))[:, None]
    phi = (np.arange(720) + 0.5) / 720 * 2.0 * np.pi
    density = ggx_ndf(np.sin(theta_h) ** 2, alpha) * ring * (2.0 * np.pi / phi.size)
    assert np.sum(density * phi.size * np.cos(theta_h)) == pytest.approx(1.0, rel=1e-4)
    for mu in (1.0, 0.5, 0.1):
        sine = np.sqrt(1.0 - mu**2)
        h_dot_v = np.maximum(np.sin(theta_h) * np.cos(phi) * sine + np.cos(theta_h) * mu, 0.0)
        # G1 out of G2 / (4 n.l n.v) with the light at the top, where nothing is shadowed
        masking = 4.0 * mu * smith_visibility(np.array(1.0), np.array(mu), alpha)
        assert masking * np.sum(density * h_dot_v) / mu == pytest.approx(1.0, rel=1e-3)


def test_cook_torrance_of_a_mirror_is_white_where_no_groove_is_in_the_way() -> None:
    # Narrow facets at steep views hide nothing: all light comes back, which fixes the factor 1/4 for 1/pi
    np.testing.assert_allclose(
        directional_albedo(CookTorrance(alpha=0.02, fresnel=MIRROR), 0.8), 1.0, rtol=1e-3
    )


def test_microfacet_models_agree_where_facets_are_narrow() -> None:
    # Peak heights at the mirror direction: F / (4 pi alpha^2 cos^2), of Ward ks / (4 pi alpha^2 cos)
    theta, alpha = np.radians(30.0), 0.02
    view, mirror = [np.sin(theta), 0.0, np.cos(theta)], [-np.sin(theta), 0.0, np.cos(theta)]
    peak = 1.0 / (4.0 * np.pi * alpha**2 * np.cos(theta) ** 2)
    np.testing.assert_allclose(Ggx(alpha=alpha, fresnel=MIRROR)(mirror, view), peak, rtol=1e-3)
    np.testing.assert_allclose(CookTorrance(alpha=alpha, fresnel=MIRROR)(mirror, view), peak, rtol=1e-12)
    np.testing.assert_allclose(Ward(alpha=alpha, ks=1.0)(mirror, view), peak * np.cos(theta), rtol=1e-12)


def test_a_coat_takes_its_albedo_twice_from_the_base() -> None:
    coat, mu = Ggx(alpha=0.1, fresnel=GLASS), 0.5
    varnish = Layered(coat=coat, base=Lambert(kd=(1.0, 0.5, 0.0)))
    through = 1.0 - directional_albedo(coat, mu)
    # What comes in under all angles: a cosine-weighted mean of the coat's transmittance
    node, weight = np.polynomial.legendre.leggauss(16)
    mus, weight = (node + 1.0) / 2.0, weight * (node + 1.0) / 2.0
    mean = weight @ (1.0 - directional_albedo(coat, mus)) / weight.sum()
    expected = (1.0 - through) + (1.0, 0.5, 0.0) * through * mean
    # The coat's albedo is interpolated in 32 steps
    np.testing.assert_allclose(directional_albedo(varnish, mu), expected, rtol=1e-3)


@pytest.mark.parametrize("name", PAINTS)
def test_car_paints_are_paints(name: str) -> None:
    # Darkest and lightest of the eight in the published table: none is black, none white
    albedo = directional_albedo(CarPaint(name=name), [1.0, 0.5])
    assert 0.001 < albedo.min() < albedo.max() < 0.7


@pytest.mark.parametrize(
    ("make", "sentence"),
    [
        (lambda: Lambert(kd=1.1), "kd is 1.1, but it must be from 0 to 1."),
        (lambda: Lambert(kd=(0.1, 0.2, -1.0)), "kd is -1, but it must be from 0 to 1."),
        (lambda: Lambert(kd=float("nan")), "kd is nan, but"),
        (lambda: Ward(alpha=0.0, ks=1.0), "alpha is 0, but it must be greater than 0 and at most 1."),
        (lambda: Phong(n=-1.0, ks=1.0), "n is -1, but it must be from 0 to 1e"),
        (lambda: Index(eta=0.0), "eta is 0, but it must be greater than 0"),
        (lambda: Schlick(f0=2.0), "f0 is 2, but"),
        (lambda: HeTorrance(sigma=3.0, tau=1.0, fresnel=MIRROR), "sigma is 3, but"),
        (lambda: CarPaint(name="ford"), 'no car paint "ford" (did you mean ford_f8?): choose one of ford_f8'),
        (lambda: Sum(parts=()), "at least one part"),
    ],
)
def test_parameters_out_of_range_are_refused_in_words(make, sentence: str) -> None:
    with pytest.raises(RangeError) as caught:
        make()
    assert sentence in str(caught.value)


def test_a_grey_is_kept_as_a_colour() -> None:
    assert Lambert(kd=0.25) == Lambert(kd=(0.25, 0.25, 0.25))
    assert Lambert(kd=np.array([0.1, 0.2, 0.3])).kd == (0.1, 0.2, 0.3)
    with pytest.raises(ValueError, match="broadcast"):
        Lambert(kd=(0.1, 0.2))
