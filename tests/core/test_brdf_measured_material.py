"""Tables of a renderer's material: neither reciprocal nor steep towards grazing."""

import numpy as np
from rsibr.rsibr_addon.core.brdf.albedo import directional_albedo
from rsibr.rsibr_addon.core.brdf.fresnel import Index
from rsibr.rsibr_addon.core.brdf.ggx import Ggx
from rsibr.rsibr_addon.core.brdf.lambert import Lambert
from rsibr.rsibr_addon.core.brdf.measured_material import (
    MeasuredMaterial,
    measured_material,
    measured_pairs,
)
from rsibr.rsibr_addon.core.brdf.model import BrdfFunction
from rsibr.rsibr_addon.core.brdf.spec import spec_from_brdf
from rsibr.rsibr_addon.core.brdf.tabulated import tabulate
from rsibr.rsibr_addon.core.geometry.directions import dot, normalize

LEAST = 1e-3
SPEC = "blend:red.blend:Paint"


def black(light_dir: np.ndarray, view_dir: np.ndarray) -> np.ndarray:
    return np.zeros(light_dir.shape)


def brighter_face_on(light_dir: np.ndarray, view_dir: np.ndarray) -> np.ndarray:
    """Not reciprocal: as by a node that mixes by the angle of view."""
    return (view_dir[..., 2:] ** 2 + 0.2 * light_dir[..., 2:]) * (1.0, 0.5, 0.2)


def measured(diffuse: BrdfFunction, glossy: BrdfFunction) -> MeasuredMaterial:
    light_dir, view_dir, wanted = measured_pairs(LEAST)
    tables = [np.full(light_dir.shape, np.nan) for _ in range(2)]
    for table, brdf in zip(tables, (diffuse, glossy), strict=True):
        table[wanted] = brdf(light_dir[wanted], view_dir[wanted])
    return measured_material(*tables, SPEC)


def directions(count: int, lowest: float) -> tuple[np.ndarray, np.ndarray]:
    rng = np.random.default_rng(40)
    z = rng.uniform(lowest, 1.0, (2, count))
    azimuth = rng.uniform(0.0, 2.0 * np.pi, (2, count))
    radius = np.sqrt(1.0 - z**2)
    light_dir, view_dir = np.stack([radius * np.cos(azimuth), radius * np.sin(azimuth), z], axis=-1)
    return light_dir, view_dir


def test_pairs_of_a_slice_enclose_one_angle() -> None:
    light_dir, view_dir, wanted = measured_pairs(0.1)
    cosine = dot(light_dir, view_dir)
    np.testing.assert_allclose(cosine, np.broadcast_to(cosine[:1, :, :1], cosine.shape), atol=1e-12)
    assert light_dir[wanted][:, 2].min() >= 0.1
    assert view_dir[wanted][:, 2].min() >= 0.1
    assert np.all((light_dir[~wanted][:, 2] < 0.1) | (view_dir[~wanted][:, 2] < 0.1))


def test_what_was_measured_comes_back() -> None:
    light_dir, view_dir, wanted = measured_pairs(LEAST)
    light_dir, view_dir = light_dir[wanted], view_dir[wanted]
    glossy = Ggx(alpha=0.2, fresnel=Index(eta=1.5))
    found = measured(brighter_face_on, glossy)(light_dir, view_dir)
    expected = brighter_face_on(light_dir, view_dir) + glossy(light_dir, view_dir)
    # Angles come back from directions with 1e-7 at worst, of cells some 0.02 wide.
    np.testing.assert_allclose(found, expected, rtol=1e-4)


def test_light_and_view_may_not_change_places() -> None:
    brdf = measured(brighter_face_on, black)
    light_dir, view_dir = directions(2000, 0.1)
    # Lines through what is quadratic, over cells of 2 degrees; next to the horizon, only the nearest azimuth.
    np.testing.assert_allclose(brdf(light_dir, view_dir), brighter_face_on(light_dir, view_dir), atol=0.01)
    np.testing.assert_allclose(brdf(view_dir, light_dir), brighter_face_on(view_dir, light_dir), atol=0.01)
    mirrored = (1.0, -1.0, 1.0)
    np.testing.assert_allclose(
        brdf(light_dir * mirrored, view_dir * mirrored), brdf(light_dir, view_dir), rtol=1e-9
    )


def test_highlights_keep_their_light_towards_grazing() -> None:
    coat = Ggx(alpha=0.1, fresnel=Index(eta=1.5))
    grazing = np.array([0.03, 0.07, 0.13, 0.5])
    expected = directional_albedo(coat, grazing)
    found = directional_albedo(measured(black, coat), grazing)
    np.testing.assert_allclose(found, expected, rtol=0.02)
    # Lines between the values themselves lie far above the curve.
    assert np.max(directional_albedo(tabulate(coat, "table"), grazing) / expected) > 1.05


def test_only_parts_that_reflect_are_layers() -> None:
    coat, base = Ggx(alpha=0.1, fresnel=Index(eta=1.5)), Lambert(kd=0.5)
    light_dir = normalize([(0.3, 0.2, 0.9)])
    view_dir = normalize([(-0.3, 0.1, 0.5)])
    both = measured(base, coat)
    assert both.layers == (both.diffuse, both.glossy)
    total = sum(layer(light_dir, view_dir) for layer in both.layers)
    np.testing.assert_allclose(both(light_dir, view_dir), total, rtol=1e-12)
    matte, metal, soot = measured(base, black), measured(black, coat), measured(black, black)
    assert matte.layers == (matte.diffuse,)
    assert metal.layers == (metal.glossy,)
    assert soot.layers == (soot.diffuse,)


def test_its_text_is_what_it_was_measured_from() -> None:
    assert spec_from_brdf(measured(black, black)) == SPEC
