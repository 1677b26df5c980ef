"""Reflectance models as text."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from rsibr.rsibr_addon.core.brdf.car_paint import PAINTS, CarPaint
from rsibr.rsibr_addon.core.brdf.cook_torrance import CookTorrance
from rsibr.rsibr_addon.core.brdf.fresnel import Fresnel, Index, Schlick
from rsibr.rsibr_addon.core.brdf.ggx import Ggx
from rsibr.rsibr_addon.core.brdf.he_torrance import HeTorrance
from rsibr.rsibr_addon.core.brdf.lambert import Lambert
from rsibr.rsibr_addon.core.brdf.layered import Beneath, Layered, Sum
from rsibr.rsibr_addon.core.brdf.metals import METALS
from rsibr.rsibr_addon.core.brdf.model import Brdf
from rsibr.rsibr_addon.core.brdf.phong import Phong
from rsibr.rsibr_addon.core.brdf.retroreflective import Retroreflective
from rsibr.rsibr_addon.core.brdf.spec import MEASURED, brdf_from_spec, spec_from_brdf
from rsibr.rsibr_addon.core.brdf.tabulated import Tabulated
from rsibr.rsibr_addon.core.brdf.ward import Ward
from rsibr.rsibr_addon.core.errors import RangeError


def read_flat(measured_format: str, path: str) -> Brdf:
    return Tabulated(np.ones((1, 1, 1, 3)), f"{measured_format}:path={path}")


def make(spec: str) -> Brdf:
    return brdf_from_spec(spec, read_flat)


@pytest.mark.parametrize(
    ("spec", "brdf"),
    [
        ("lambert:kd=0.5", Lambert(kd=0.5)),
        ("lambert:kd=0.8/0.2/0.1", Lambert(kd=(0.8, 0.2, 0.1))),
        ("phong:n=50,ks=0.5,kd=0.1", Phong(n=50.0, ks=0.5, kd=0.1)),
        ("ward:alpha=0.04,ks=0.8", Ward(alpha=0.04, ks=0.8)),
        ("ggx:alpha=0.3,metal=copper", Ggx(alpha=0.3, fresnel=METALS["copper"])),
        (
            "ggx:alpha=0.3,eta=0.2/0.924/1.102,k=3.912/2.452/2.142",
            Ggx(alpha=0.3, fresnel=Index(eta=(0.2, 0.924, 1.102), k=(3.912, 2.452, 2.142))),
        ),
        ("ggx:alpha=0.1,f0=0.04", Ggx(alpha=0.1, fresnel=Schlick(f0=0.04))),
        ("ggx:alpha=0.1,eta=1.5", Ggx(alpha=0.1, fresnel=Index(eta=1.5))),
        ("cook_torrance:alpha=0.2,f0=0.9,f90=0.95,ks=0.5", CookTorrance(
            alpha=0.2, fresnel=Schlick(f0=0.9, f90=0.95), ks=0.5)),
        ("he_torrance:sigma=0.18,tau=3,metal=aluminium", HeTorrance(
            sigma=0.18, tau=3.0, fresnel=METALS["aluminium"])),
        ("retroreflective:n=20,ks=0.7", Retroreflective(n=20.0, ks=0.7)),
        ("car_paint:name=blue", CarPaint(name="blue")),
        ("layered:coat=(ggx:alpha=0.1,eta=1.5),base=(lambert:kd=0.3/0.2/0.1)", Layered(
            coat=Ggx(alpha=0.1, fresnel=Index(eta=1.5)), base=Lambert(kd=(0.3, 0.2, 0.1)))),
        ("sum:parts=(lambert:kd=0.1)+(sum:parts=(lambert:kd=0.2)+(phong:n=1,ks=0.5))", Sum(
            parts=(Lambert(kd=0.1), Sum(parts=(Lambert(kd=0.2), Phong(n=1.0, ks=0.5)))))),
    ],
)  # fmt: skip
def test_every_model_is_made_of_its_text_and_told_by_it(spec: str, brdf: Brdf) -> None:
    assert make(spec) == brdf
    assert spec_from_brdf(brdf) == spec


@pytest.mark.parametrize(
    ("loose", "canonical"),
    [
        ("ward:alpha=0.04,ks=0.8,kd=0", "ward:alpha=0.04,ks=0.8"),
        (" ward : ks = .8 , alpha = 4e-2 ", "ward:alpha=0.04,ks=0.8"),
        ("lambert:kd=0.50/0.5/.5", "lambert:kd=0.5"),
        ("ggx:alpha=1,f90=1,f0=1/0/0", "ggx:alpha=1,f0=1/0/0"),
        ("layered:base=( lambert: kd=1 ),coat=(ggx:alpha=0.1,eta=1.5,k=0)",
         "layered:coat=(ggx:alpha=0.1,eta=1.5),base=(lambert:kd=1)"),
        ("merl:path= gold (1), new.binary ", "merl:path=gold (1), new.binary"),
        ("sum:parts=(rgl:path=a=b.bsdf)+(lambert:kd=0)", "sum:parts=(rgl:path=a=b.bsdf)+(lambert:kd=0)"),
    ],
)  # fmt: skip
def test_texts_for_the_same_model_become_one(loose: str, canonical: str) -> None:
    assert spec_from_brdf(make(loose)) == canonical
    assert spec_from_brdf(make(canonical)) == canonical


number = st.floats(0.0, 1.0)
positive = st.floats(1e-3, 1.0)
color = st.one_of(number, st.tuples(number, number, number))
fresnel: st.SearchStrategy[Fresnel] = st.one_of(
    st.sampled_from(list(METALS.values())),
    st.builds(Schlick, f0=color, f90=color),
    st.builds(Index, eta=st.floats(0.01, 10.0), k=color),
)
leaf: st.SearchStrategy[Brdf] = st.one_of(
    st.builds(Lambert, kd=color),
    st.builds(Phong, n=st.floats(0.0, 1e5), ks=color, kd=color),
    st.builds(Ward, alpha=positive, ks=color, kd=color),
    st.builds(Ggx, alpha=positive, fresnel=fresnel),
    st.builds(CookTorrance, alpha=positive, fresnel=fresnel, ks=color),
    st.builds(HeTorrance, sigma=positive, tau=positive, fresnel=fresnel, kd=color),
    st.builds(CarPaint, name=st.sampled_from(list(PAINTS))),
)
models = st.recursive(
    leaf,
    lambda inner: st.one_of(
        st.builds(Layered, coat=inner, base=inner),
        st.builds(Sum, parts=st.lists(inner, min_size=1, max_size=3).map(tuple)),
    ),
    max_leaves=5,
)


@given(models)
@settings(derandomize=True, max_examples=100, deadline=None)
def test_any_model_survives_its_text(brdf: Brdf) -> None:
    text = spec_from_brdf(brdf)
    assert make(text) == brdf
    assert spec_from_brdf(make(text)) == text


@pytest.mark.parametrize(
    ("spec", "sentence"),
    [
        ("", 'no BRDF model "": choose one of lambert, phong, ward'),
        ("wood:grain=1", 'no BRDF model "wood"'),
        ("ward", "ward: alpha is missing; it must be a number greater than 0 and at most 1."),
        (
            "ward:alpha=0.1",
            "ward: ks is missing; it must be one number, or three as red/green/blue, from 0 to 1.",
        ),
        ("ward:alpha=2,ks=1", "ward: alpha is 2, but it must be greater than 0 and at most 1."),
        (
            "ward:alpha=wide,ks=1",
            'ward: alpha is "wide", but it must be a number greater than 0 and at most 1.',
        ),
        ("ward:alpha=nan,ks=1", "ward: alpha is nan, but it must be"),
        ("ward:alpha=0.1/0.1/0.1,ks=1", 'ward: alpha is "0.1/0.1/0.1", but it must be a number'),
        ("ward:alpha=0.1,ks=1/2", 'ward: ks is "1/2", but it must be one number, or three'),
        ("ward:alpha=0.1,beta=2", "ward: it has no parameter beta: choose from alpha, ks, kd."),
        ("ward:alpha=0.1,alpha=0.2", "ward: alpha appears twice"),
        ("ward:alpha", 'ward: "alpha" is not of the form key=value.'),
        ("ward:alpha=,ks=1", 'ward: "alpha=" is not of the form key=value.'),
        ("ward:alpha=0.1,,ks=1", 'ward: "" is not of the form key=value.'),
        ("ward:alpha=2", "ward: alpha is 2, but it must be greater than 0 and at most 1."),
        ("ggx:alpha=7", "ggx: alpha is 7, but it must be greater than 0 and at most 1."),
        ("ggx:alpha=0.1", "ggx: its reflectance must be one of metal=NAME, eta and k"),
        ("ggx:alpha=0.1,metal=tin", 'ggx: metal is "tin", but it must be one of aluminium, chromium, copper'),
        ("ggx:alpha=0.1,metal=gold,f0=1", "ggx: its reflectance must be one of"),
        ("ggx:alpha=0.1,k=1", "ggx: its reflectance must be one of"),
        ("ggx:alpha=0.1,f0=2", "ggx: f0 is 2, but it must be from 0 to 1."),
        ("car_paint:name=pink", 'car_paint: There is no car paint "pink": choose one of ford_f8'),
        (
            "layered:coat=lambert:kd=1,base=(lambert:kd=1)",
            'coat is "lambert:kd=1", but it must be a model in par',
        ),
        (
            "layered:coat=(lambert:kd=2),base=(lambert:kd=1)",
            "layered: lambert: kd is 2, but it must be from 0 to 1.",
        ),
        ("layered:coat=(lambert:kd=1", "parentheses in"),
        ("layered:coat=lambert:kd=1)", "parentheses in"),
        ("sum:parts=()", 'sum: There is no BRDF model ""'),
        ("sum:parts=(lambert:kd=1)(lambert:kd=1)", "sum: "),
        ("merl:", "merl takes one key, path: write merl:path=FILE."),
        ("rgl:file=a", "rgl takes one key, path"),
    ],
)
def test_what_is_wrong_is_said_with_its_key_and_range(spec: str, sentence: str) -> None:
    with pytest.raises(RangeError) as caught:
        make(spec)
    assert sentence in str(caught.value)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize("name", MEASURED)
def test_measured_models_are_asked_for_by_format_and_path(name: str) -> None:
    asked = []

    def read(*arguments: str) -> Brdf:
        asked.append(arguments)
        return read_flat(*arguments)

    brdf = brdf_from_spec(f"layered:coat=({name}:path=a/b.c),base=({name}:path=d)", read)
    assert asked == [(name, "a/b.c"), (name, "d")]
    assert spec_from_brdf(brdf) == f"layered:coat=({name}:path=a/b.c),base=({name}:path=d)"


def test_what_has_no_text_is_refused() -> None:
    with pytest.raises(RangeError, match="A Beneath cannot be written as text"):
        spec_from_brdf(Beneath(Lambert(kd=0.1), Lambert(kd=0.2)))
