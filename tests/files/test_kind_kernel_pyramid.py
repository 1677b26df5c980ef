"""Kernel pyramids as files: what is written comes back, and everything else is named."""

import json
import re
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from rsibr.rsibr_addon.command_line.main import run
from rsibr.rsibr_addon.core.environment import Environment
from rsibr.rsibr_addon.core.errors import MapSetError
from rsibr.rsibr_addon.core.kinds.kernel_pyramid.bake import BakedPyramid, FilterErrors
from rsibr.rsibr_addon.core.kinds.kernel_pyramid.pyramid import Pyramid
from rsibr.rsibr_addon.core.lobes.bank import KernelBank
from rsibr.rsibr_addon.core.maps.equirect import direction_from_uv, texel_solid_angle
from rsibr.rsibr_addon.core.progress import drain
from rsibr.rsibr_addon.files.kinds.kernel_pyramid import from_map_set, to_map_set
from rsibr.rsibr_addon.files.map_set import read_map_set, write_map_set
from rsibr.rsibr_addon.files.map_set_data import MapSet
from rsibr.rsibr_addon.files.map_set_header import Origin
from rsibr.rsibr_addon.tasks.export.export import export
from rsibr.tests.files.test_export import read as read_ktx2

RNG = np.random.default_rng(4)
LIGHT = Environment(RNG.random((8, 16, 3), dtype=np.float32), "light")


def make_map_set() -> tuple[BakedPyramid, MapSet]:
    maps = tuple(RNG.random((1, n, n, 3), dtype=np.float32) for n in (4, 4, 8))
    mirror, diffuse, rings = (
        RNG.random((count, n, n, 3), dtype=np.float32) for count, n in ((1, 16), (2, 4), (3, 8))
    )
    errors = [FilterErrors(RNG.random(3), 1e-3 * number) for number in range(8)]
    pyramid = Pyramid(KernelBank((0.5, 1.0, 2.0)), mirror, maps, diffuse, rings)
    baked = BakedPyramid(pyramid, tuple(errors[:3]), tuple(errors[3:5]), tuple(errors[5:]))
    return baked, to_map_set(baked, Origin(LIGHT, {"size": 16}, "a test"))


def test_a_pyramid_comes_back_bit_by_bit(tmp_path: Path) -> None:
    baked, map_set = make_map_set()
    write_map_set(tmp_path / "a.rsibr.exr", map_set)
    held = read_map_set(tmp_path / "a.rsibr.exr", "kernel_pyramid")
    back = from_map_set(tmp_path / "a.rsibr.exr", held)
    assert back.bank == baked.pyramid.bank
    for found, written in zip(back.all_maps, baked.pyramid.all_maps, strict=True):
        np.testing.assert_array_equal(found, written)
    assert held.header["size"] == [16, 16]
    for name, maps in {"filter": (*baked.kernels, *baked.diffuse), "sheen": baked.rings}.items():
        largest = np.max([errors.bound for errors in maps], axis=0)
        np.testing.assert_array_equal(held.header["error_bound"][name], largest)
    assert held.header["error_bound"]["interpolation"] == 0.004
    stated = {part["name"]: part for part in held.header["parts"]}
    assert stated["kernel02"]["concentration"] == 2.0
    np.testing.assert_array_equal(stated["leaning"]["bound"], baked.diffuse[1].bound)


def test_suns_are_those_of_the_environment_that_the_file_holds() -> None:
    _, map_set = make_map_set()
    assert len(from_map_set(Path("a"), map_set).suns) == 0
    map_set.maps["environment"] = map_set.maps["environment"].copy()
    map_set.maps["environment"][3, 5] = 1000.0
    assert len(from_map_set(Path("a"), map_set).suns) == 1
    map_set.header["environment"]["part"] = None
    assert len(from_map_set(Path("a"), map_set).suns) == 0


def test_what_is_told_of_suns(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    """By `rsibr info`, and by the note of textures, whose kernels are without them."""
    baked, _ = make_map_set()
    dark = np.full((8, 16, 3), 0.5, np.float32)
    dark[3, 5] = 1000.0, 600.0, 200.0
    path, textures = tmp_path / "a.rsibr.exr", tmp_path / "a.ktx2"
    write_map_set(path, to_map_set(baked, Origin(Environment(dark, "light"), {}, "a test")))
    assert run(["info", str(path), "--json"]) == 0
    told = json.loads(capfd.readouterr().out)["suns"]
    texel = float(texel_solid_angle(16, 8)[3, 5])
    assert told["ceiling"] == [0.5, 0.5, 0.5]
    (sun,) = told["each"]
    np.testing.assert_allclose(sun["irradiance"], texel * np.array([999.5, 599.5, 199.5]))
    np.testing.assert_allclose(sun["direction"], direction_from_uv([5.5 / 16, 3.5 / 8]))
    assert sun["share"] == pytest.approx(texel * 1798.5 / (texel * 1798.5 + 6.0 * np.pi))
    assert run(["info", str(path)]) == 0
    assert re.search(r"Sun 1 +direction .*, irradiance .* % of the light", capfd.readouterr().out)
    sunless = from_map_set(path, read_map_set(path)).sunless
    for written in drain(export(path, textures)):
        texture = read_ktx2(written)
        assert texture.note["suns"] == told
        for layer, shown in zip(texture.note["layers"], texture.levels[0], strict=True):
            if layer["role"] == "prefiltered":
                wanted = sunless[int(layer["name"].removeprefix("kernel"))][0]
                np.testing.assert_allclose(shown[1:-1, 1:-1, :3], wanted, rtol=1e-3, atol=1e-6)
    write_map_set(path, to_map_set(baked, Origin(LIGHT, {}, "a test")), force=True)
    for written in drain(export(path, textures, force=True)):
        assert "suns" not in read_ktx2(written).note


@pytest.mark.parametrize(
    ("spoil", "sentence"),
    [
        (lambda header, parts: header.update(layout="cube_map"), "laid out as cube_map, not as octahedral"),
        (lambda header, parts: parts["kernel01"].update(concentration=0.5), "ascending order"),
        (lambda header, parts: parts["kernel01"].update(concentration=0.75), "not those that materials are"),
        (lambda header, parts: parts["kernel00"].update(role="other"), "not those that materials are"),
        (lambda header, parts: parts["mirror"].update(role="other"), "0 maps of the role mirror"),
        (lambda header, parts: parts["leaning"].update(role="diffuse"), "2 maps of the role diffuse"),
        (lambda header, parts: parts["ring01"].update(width=0.3), "lacks the rings that sheen is made of"),
        (lambda header, parts: parts["ring02"].update(role="other"), "lacks the rings that sheen is made of"),
    ],
)
def test_what_is_no_pyramid_is_named(tmp_path: Path, spoil: Callable, sentence: str) -> None:
    _, map_set = make_map_set()
    spoil(map_set.header, {part["name"]: part for part in map_set.header["parts"]})
    path = tmp_path / "a.rsibr.exr"
    write_map_set(path, map_set)
    with pytest.raises(MapSetError, match=f"{path} .*{sentence}"):
        from_map_set(path, read_map_set(path))


@pytest.mark.parametrize(
    ("name", "shape", "sentence"),
    [
        ("kernel01", (4, 5, 3), "a square map for each of its kernels"),
        ("mirror", (8, 4, 3), "a square map for each of its kernels"),
        ("leaning", (2, 2, 3), "diffuse maps differ in size"),
        ("ring01", (4, 4, 3), "ring maps differ in size"),
    ],
)
def test_maps_of_other_shapes_are_named(
    tmp_path: Path, name: str, shape: tuple[int, ...], sentence: str
) -> None:
    _, map_set = make_map_set()
    map_set.maps[name] = np.ones(shape, dtype=np.float32)
    path = tmp_path / "a.rsibr.exr"
    write_map_set(path, map_set)
    with pytest.raises(MapSetError, match=f"{path} holds no light for own materials. .*{sentence}"):
        from_map_set(path, read_map_set(path))
