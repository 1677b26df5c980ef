"""Changes of a material against tables that are baked of the changed one, and what needs a bake."""

import numpy as np
import pytest
from rsibr.rsibr_addon.core.conventions import texel_centres
from rsibr.rsibr_addon.core.errors import RangeError
from rsibr.rsibr_addon.core.geometry.directions import normalize
from rsibr.rsibr_addon.core.kinds.reflection_tables.bake import TableSizes, bake_tables
from rsibr.rsibr_addon.core.kinds.reflection_tables.material import material_from_texts
from rsibr.rsibr_addon.core.kinds.reflection_tables.shading import TablesLook, reflect_tables
from rsibr.rsibr_addon.core.kinds.reflection_tables.tables import ReflectionTables
from rsibr.rsibr_addon.core.kinds.reflection_tables.weights import (
    share_above_horizon,
    table_weights,
    weight_cosines,
)
from rsibr.rsibr_addon.core.maps import equirect
from rsibr.rsibr_addon.core.progress import drain
from rsibr.tests.synthetic_views import environment_radiance

RNG = np.random.default_rng(5)
LIGHT = environment_radiance(equirect.direction_from_uv(texel_centres(64, 32))).astype(np.float32)
NORMAL = normalize(RNG.normal(size=(300, 3)))
VIEW = normalize(NORMAL + 0.9 * normalize(RNG.normal(size=(300, 3))))

BAKED = {
    "diffuse": "lambert:kd=0.5/0.4/0.3",
    "emission": "0.2/0.1/0",
    "specular": "phong:n=20,ks=0.3/0.2/0.1",
    "coat": "fresnel:eta=1.5",
    "retro": "mirror:ks=0.2",
    "refraction": "clear:eta=1.5",
    "weights": "fresnel:eta=1.5",
}

CHANGES = {
    "scales": {"diffuse": "lambert:kd=0.1/0.2/0.9", "specular": "phong:n=20,ks=0.9", "retro": "mirror:"},
    "no diffuse part": {"diffuse": "none"},
    "more emission": {"emission": "1/2/3"},
    "no emission": {"emission": "none"},
    "a constant coat": {"coat": "constant:k=0.5/0.2/0"},
    "no coat": {"coat": "none", "retro": "none"},
    "another index": {"refraction": "clear:eta=1.1,tint=1/0.5/0"},
    "constant weights": {"weights": "constant:k=0.25"},
    "curves": {"weights": "curve:wd=0:0.2/1:1,ws=0:1/0.5:0.1/1:0.04"},
    "no weights": {"weights": "none"},
}


def baked(parts: dict[str, str]) -> ReflectionTables:
    sizes = TableSizes(16, 32)
    there = {part: text for part, text in parts.items() if text != "none"}
    made = drain(bake_tables(LIGHT, material_from_texts(there, None), sizes)).tables
    return ReflectionTables(made.maps, made.weights, made.eta, there)


@pytest.mark.parametrize("change", CHANGES.values(), ids=CHANGES)
def test_a_change_without_a_bake_is_what_a_bake_gives(change: dict[str, str]) -> None:
    before, after = baked(BAKED), baked(BAKED | change)
    shown = reflect_tables(before, NORMAL, VIEW, TablesLook(**change))
    expected = reflect_tables(after, NORMAL, VIEW, TablesLook())
    np.testing.assert_allclose(shown, expected, rtol=0.0, atol=1e-5 * expected.max())  # floats of the maps
    assert np.abs(shown - reflect_tables(before, NORMAL, VIEW, TablesLook())).max() > 0.01


@pytest.mark.parametrize(
    ("change", "table"),
    [
        ({"specular": "phong:n=21,ks=0.3"}, "specular"),
        ({"specular": "mirror:"}, "specular"),
        ({"diffuse": "luminous:kd=0.5"}, "diffuse"),
        ({"retro": "phong:n=5,ks=0.2"}, "retro"),
    ],
)
def test_what_needs_another_table_is_refused_by_its_name(change: dict[str, str], table: str) -> None:
    with pytest.raises(RangeError, match=f"The {table} table"):
        reflect_tables(baked(BAKED), NORMAL, VIEW, TablesLook(**change))


def test_a_table_that_is_missing_or_was_black_is_refused() -> None:
    plain = baked({"diffuse": "lambert:kd=0.5/0/0.5"})
    with pytest.raises(RangeError, match="The specular table"):
        reflect_tables(plain, NORMAL, VIEW, TablesLook(specular="mirror:"))
    with pytest.raises(RangeError, match="The diffuse table"):
        reflect_tables(plain, NORMAL, VIEW, TablesLook(diffuse="lambert:kd=0.5"))


def test_emission_needs_no_table() -> None:
    mirror = baked({"specular": "mirror:"})
    glowing = reflect_tables(mirror, NORMAL, VIEW, TablesLook(emission="1/2/3"))
    dark = reflect_tables(mirror, NORMAL, VIEW, TablesLook())
    np.testing.assert_allclose(glowing - dark, np.broadcast_to((1.0, 2.0, 3.0), dark.shape), rtol=1e-6)


@pytest.mark.parametrize("n", [1.0, 20.0, 500.0])
def test_the_share_above_the_horizon_is_that_of_brute_force(n: float) -> None:
    """Sums over texels of a sphere of 512 x 256."""
    directions = equirect.direction_from_uv(texel_centres(512, 256)).reshape(-1, 3)
    area = equirect.texel_solid_angle(512, 256).reshape(-1)
    for cosine in (0.02, 0.2, 0.7, 1.0):
        axis = np.array([np.sqrt(1.0 - cosine**2), 0.0, cosine])
        lobe = area * np.maximum(directions @ axis, 0.0) ** n
        expected = lobe[directions[:, 2] > 0.0].sum() / lobe.sum()
        # The lobes are up to ten texels wide: their edge at the horizon is a texel wide
        assert abs(share_above_horizon(np.array([cosine]), n)[0] - expected) < 3e-3


def test_a_fade_takes_from_lobes_alone() -> None:
    material = material_from_texts(BAKED, None)
    plain, faded = table_weights(material), table_weights(material, fade=True)
    share = share_above_horizon(weight_cosines(), 20.0)[:, None]
    np.testing.assert_allclose(faded[1], plain[1] * share)
    np.testing.assert_array_equal(np.delete(faded, 1, axis=0), np.delete(plain, 1, axis=0))


def test_curves_are_straight_between_their_points() -> None:
    parts = {"diffuse": "lambert:kd=1", "specular": "mirror:", "weights": "curve:wd=0.5:1,ws=0:1/0.5:0.5/1:0"}
    diffuse, specular, *_ = table_weights(material_from_texts(parts, None))
    np.testing.assert_array_equal(diffuse, 1.0)
    np.testing.assert_allclose(specular, np.repeat(1.0 - weight_cosines()[:, None], 3, axis=1))


@pytest.mark.parametrize("text", ["1:0/0:1", "0:a", "0", "0:1/2:1", "0:-1", "0:nan", "nan:0", "0:1/0:1"])
def test_what_is_no_curve_is_refused(text: str) -> None:
    with pytest.raises(RangeError, match="weights: curve: ws: a curve"):
        material_from_texts({"specular": "mirror:", "weights": f"curve:ws={text}"}, None)


def test_a_constant_weight_leaves_the_rest_to_diffuse_light() -> None:
    parts = {"diffuse": "lambert:kd=1", "specular": "mirror:", "weights": "constant:k=0.2/0.5/0.9"}
    diffuse, specular, *_ = table_weights(material_from_texts(parts, None))
    np.testing.assert_allclose(specular, np.broadcast_to((0.2, 0.5, 0.9), specular.shape))
    np.testing.assert_allclose(diffuse + specular, 1.0)
