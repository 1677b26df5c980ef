"""Lobe stacks as files: what is written comes back, and everything else is named."""

import copy
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from rsibr.rsibr_addon.core.environment import Environment
from rsibr.rsibr_addon.core.errors import MapSetError
from rsibr.rsibr_addon.core.kinds.lobe_stack.stack import LAYOUTS, LobeStack
from rsibr.rsibr_addon.core.lobes.bake import BakedStack, bake_stack
from rsibr.rsibr_addon.core.lobes.bank import KernelBank
from rsibr.rsibr_addon.core.lobes.fit import Fit
from rsibr.rsibr_addon.core.maps.representation import FRONT
from rsibr.rsibr_addon.core.progress import drain
from rsibr.rsibr_addon.files.kinds.lobe_stack import (
    PROFILES,
    fit_of,
    from_map_set,
    in_turn,
    profiles,
    to_map_set,
)
from rsibr.rsibr_addon.files.map_set import read_map_set, read_map_set_header, write_map_set
from rsibr.rsibr_addon.files.map_set_data import MapSet
from rsibr.rsibr_addon.files.map_set_header import Origin
from rsibr.tests.lobe_stacks import random_fit, random_stack

LIGHT = Environment(np.random.default_rng(1).random((8, 16, 3), dtype=np.float32), "light")
MATERIAL = {"brdf": "ward:alpha=0.04,ks=0.8", "method": "joint"}


def map_set_of(stack: LobeStack) -> MapSet:
    return to_map_set(stack, Origin(LIGHT, {}, "test", MATERIAL, {"filter": [1e-5] * 3}))


@pytest.mark.parametrize("layout", LAYOUTS)
@pytest.mark.parametrize("shared", [False, True])
def test_a_stack_comes_back(tmp_path: Path, layout: str, shared: bool) -> None:
    stack, path = random_stack(layout, shared=shared), tmp_path / "a.rsibr.exr"
    write_map_set(path, map_set_of(stack))
    back = from_map_set(path, read_map_set(path, "lobe_stack"))
    assert back.layout == layout
    for name, expected in vars(stack).items():
        if name != "layout":
            # JSON holds the shortest decimals of a double, so nothing is lost.
            np.testing.assert_array_equal(getattr(back, name), expected)


def test_half_maps_keep_eleven_bits(tmp_path: Path) -> None:
    stack, path = random_stack("octahedral"), tmp_path / "a.rsibr.exr"
    write_map_set(path, map_set_of(stack), half=True)
    back = from_map_set(path, read_map_set(path))
    np.testing.assert_allclose(back.maps, stack.maps, rtol=2.0**-11, atol=2.0**-25)
    np.testing.assert_array_equal(back.offsets, stack.offsets)


def test_the_front_is_above_the_back() -> None:
    """By the words of docs/map-set-format.md, and nothing of core/maps."""
    stack = random_stack("dual_paraboloid", 16)
    picture = map_set_of(stack).maps["lobe01.slice002"]
    assert picture.shape == (32, 16, 3)
    # The texel at the row 5 from the bottom and the column 12 of the front.
    u, v = (12.5 / 16.0, 5.5 / 16.0)
    s, t = (2.0 * u - 1.0) * 16.0 / 15.0, (2.0 * v - 1.0) * 16.0 / 15.0
    x, y, z = np.array([2.0 * s, -2.0 * t, 1.0 - s**2 - t**2]) / (1.0 + s**2 + t**2)
    direction = np.array([x, -z, y])
    np.testing.assert_allclose(direction, FRONT @ (x, y, z))
    uv, sheet = stack.representation.uv_from_direction(direction)
    assert sheet == 0
    np.testing.assert_allclose(uv, (u, v))
    np.testing.assert_array_equal(picture[16 + 5, 12], stack.maps[1, 2, 0, 5, 12])
    np.testing.assert_array_equal(picture[5, 12], stack.maps[1, 2, 1, 5, 12])


def without_a_lobe(header: dict[str, Any]) -> None:
    header["parts"] = [part for part in header["parts"] if part.get("lobe") != 1]


def of_another_layout(header: dict[str, Any]) -> None:
    header["layout"] = "sphere_map"


def without_an_elevation(header: dict[str, Any]) -> None:
    del header["parts"][3]


def at_another_elevation(header: dict[str, Any]) -> None:
    header["parts"][3]["elevations"][0]["mu"] = 0.55


def with_one_map_of_a_lobe(header: dict[str, Any]) -> None:
    first, *others = [part for part in header["parts"] if part.get("lobe") == 1]
    first["elevations"] += [elevation for part in others for elevation in part["elevations"]]
    header["parts"] = [part for part in header["parts"] if part not in others]


def with_another_tap(header: dict[str, Any]) -> None:
    header["parts"][3]["elevations"][0]["taps"] *= 2


def of_another_size(header: dict[str, Any]) -> None:
    header["size"] = [12, 24]


@pytest.mark.parametrize(
    ("damage", "complaint"),
    [
        (without_a_lobe, "lacks one of its lobes: bake it again"),
        (of_another_layout, "holds no lobe stack. A lobe stack cannot be laid out as sphere_map"),
        (without_an_elevation, "holds lobes of different elevations, maps or taps: bake it again"),
        (at_another_elevation, "holds lobes of different elevations, maps or taps: bake it again"),
        (with_one_map_of_a_lobe, "holds lobes of different elevations, maps or taps: bake it again"),
        (with_another_tap, "holds lobes of different elevations, maps or taps: bake it again"),
        (of_another_size, "holds maps of another size than it says: bake it again"),
    ],
)
def test_what_is_no_stack_is_refused(damage: Callable[[dict[str, Any]], None], complaint: str) -> None:
    map_set = map_set_of(random_stack("dual_paraboloid"))
    damaged = MapSet(map_set.kind, map_set.maps, copy.deepcopy(map_set.header))
    damage(damaged.header)
    with pytest.raises(MapSetError, match=complaint) as caught:
        from_map_set(Path("a.rsibr.exr"), damaged)
    assert str(caught.value).startswith("a.rsibr.exr")


@pytest.mark.parametrize("field", ["mu", "taps", "scale", "albedo"])
def test_elevations_are_whole(tmp_path: Path, field: str) -> None:
    map_set = map_set_of(random_stack("octahedral"))
    del map_set.header["parts"][2]["elevations"][0][field]
    with pytest.raises(MapSetError, match=rf"parts\[2\]\.elevations\[0\]\.{field} is missing"):
        write_map_set(tmp_path / "a.rsibr.exr", map_set)


def test_taps_are_whole(tmp_path: Path) -> None:
    map_set = map_set_of(random_stack("octahedral"))
    map_set.header["parts"][2]["elevations"][0]["taps"][1]["tilt"] = "much"
    with pytest.raises(
        MapSetError, match=r"parts\[2\]\.elevations\[0\]\.taps\[1\]\.tilt is not a finite number"
    ):
        write_map_set(tmp_path / "a.rsibr.exr", map_set)


def map_set_of_fit(shared: bool = False) -> tuple[Fit, MapSet]:
    fit = random_fit(KernelBank((0.5, 2.0, 8.0, 32.0)), lobes=3, shared=shared)
    fit.weights[:, :, 2] = 0.0
    maps = random_stack("octahedral").maps[:, : fit.weights.shape[1]]
    stack = LobeStack("octahedral", fit.mu, maps, fit.scale, fit.offsets, fit.taps, fit.albedo)
    material = {"brdf": fit.brdf, "method": fit.method, PROFILES: profiles(fit)}
    return fit, to_map_set(stack, Origin(LIGHT, {}, "test", material))


@pytest.mark.parametrize("shared", [False, True])
def test_a_fit_is_told(tmp_path: Path, shared: bool) -> None:
    path = tmp_path / "a.rsibr.exr"
    fit, map_set = map_set_of_fit(shared)
    write_map_set(path, map_set)
    told = fit_of(path, read_map_set_header(path))
    assert told.bank.concentrations == (0.5, 2.0, 32.0)  # one has no weight
    directions = np.random.default_rng(2).normal(size=(100, 3))
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    # Six digits of every weight; signed lobes cancel a little of their sum
    for mu in (0.05, 0.5, 1.0):
        expected = fit.evaluate_lobes(directions, mu)
        np.testing.assert_allclose(told.evaluate_lobes(directions, mu), expected, atol=2e-6 * expected.max())


def test_stacks_without_profiles_tell_no_fit() -> None:
    assert fit_of(Path("a.exr"), map_set_of(random_stack("octahedral")).header) is None


@pytest.mark.parametrize("profiles", [3, {}, {"concentrations": [1.0], "weights": [[1.0]]}])
def test_profiles_of_other_lobes_are_refused(profiles: Any) -> None:
    _, map_set = map_set_of_fit()
    map_set.header["material"][PROFILES] = profiles
    with pytest.raises(MapSetError, match=r"a\.exr describes no lobes .*: bake it again"):
        fit_of(Path("a.exr"), map_set.header)


def sunny() -> Environment:
    """Even light, and a sun whose squared radiance is nearly all of it."""
    radiance = np.full((32, 64, 3), 0.2, np.float32)
    radiance[22, 30] = 2000.0, 1500.0, 1000.0
    return Environment(radiance, "sunny")


def with_suns(path: Path, half: bool = False) -> tuple[BakedStack, LobeStack]:
    """A stack with kernels beyond what its light resolves, and as it is read again."""
    fit = random_fit(KernelBank((2.0, 256.0, 512.0)))
    baked = drain(bake_stack(sunny().radiance, fit, "octahedral", 32))
    write_map_set(path, in_turn(baked, Origin(sunny(), {}, "test")), half=half)
    return baked, from_map_set(path, read_map_set(path))


@pytest.mark.parametrize("half", [False, True])
def test_suns_are_taken_apart_when_a_stack_is_read(tmp_path: Path, half: bool) -> None:
    baked, back = with_suns(tmp_path / "a.rsibr.exr", half)
    stated = read_map_set_header(tmp_path / "a.rsibr.exr")["material"][PROFILES]
    assert stated["sharpest_in_maps"] == baked.sharpest < 512.0
    assert len(back.sunlight.suns) == 1
    # Of the sun, what is left in maps is what the broad kernel makes of it, to the digits of the file
    broad = replace(baked.fit, weights=baked.fit.weights * [[1.0], [0.0], [0.0]])
    weights = baked.fit.weights[:, :, 1:].sum(axis=2)[:, :, None, None, None]
    expected = drain(bake_stack(sunny().radiance, broad, "octahedral", 32)).stack.maps + 0.2 * weights
    digits = 2.0**-10 if half else 1e-5
    # A kernel's sum over so few texels is off by some percents of even light
    np.testing.assert_allclose(back.maps, expected, atol=0.01 + digits * baked.stack.maps.max())
    assert baked.stack.maps.max() > 20.0 * expected.max()


def test_without_environment_or_profiles_suns_stay_in_maps(tmp_path: Path) -> None:
    path = tmp_path / "a.rsibr.exr"
    baked, _ = with_suns(path)
    lightless, shapeless = read_map_set(path), read_map_set(path)
    lightless.header["environment"]["part"] = None
    del shapeless.header["material"][PROFILES]
    for map_set in (lightless, shapeless):
        back = from_map_set(path, map_set)
        assert back.sunlight is None
        np.testing.assert_array_equal(back.maps, baked.stack.maps)


def test_profiles_of_other_maps_are_refused() -> None:
    _, map_set = map_set_of_fit()
    told = map_set.header["material"][PROFILES]
    told["weights"] = [lobe[:1] for lobe in told["weights"]]
    with pytest.raises(MapSetError, match=r"holds no lobe stack\. Its profiles are not those of its maps"):
        from_map_set(Path("a.exr"), map_set)
