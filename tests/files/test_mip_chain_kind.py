"""Map sets of mip chains: what is written comes back, and everything else is named."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import OpenEXR
import pytest
from rsibr.rsibr_addon.core.environment import Environment
from rsibr.rsibr_addon.core.errors import MapSetError, RsibrWarning
from rsibr.rsibr_addon.core.geometry.near_room import Room
from rsibr.rsibr_addon.core.kinds.mip_chain.chain import MipChain
from rsibr.rsibr_addon.core.kinds.mip_chain.probes import Place, Probe
from rsibr.rsibr_addon.files.kinds.mip_chain import from_map_set, to_map_set
from rsibr.rsibr_addon.files.map_set import read_map_set, write_map_set
from rsibr.rsibr_addon.files.map_set_data import MapSet
from rsibr.rsibr_addon.files.map_set_header import Origin
from rsibr.rsibr_addon.files.textures import Up
from rsibr.rsibr_addon.tasks.export.format import textures_of

RNG = np.random.default_rng(41)


def make_chain(roughness: tuple[float, ...] | None = None) -> MipChain:
    mips = tuple(RNG.random((6, n, n, 3), dtype=np.float32) for n in (4, 2, 1))
    return MipChain(mips, RNG.normal(size=(9, 3)).astype(np.float32).astype(np.float64), roughness)


def make_map_set(chain: MipChain) -> MapSet:
    environment = Environment(RNG.random((8, 16, 3), dtype=np.float32), "somewhere")
    bound = {"relative_to_peak": 1e-3}
    return to_map_set(chain, Origin(environment, {"size": 4}, "a test", {"filter": "ggx"}, bound))


@pytest.mark.parametrize("roughness", [None, (0.0, 0.25, 1.0)])
def test_a_chain_comes_back_bit_by_bit(tmp_path: Path, roughness: tuple[float, ...] | None) -> None:
    chain = make_chain(roughness)
    path = tmp_path / "a.rsibr.exr"
    write_map_set(path, make_map_set(chain))
    back = from_map_set(path, read_map_set(path, "mip_chain"))
    assert back.roughness == roughness
    np.testing.assert_array_equal(back.harmonics, chain.harmonics)
    for mip, expected in zip(back.mips, chain.mips, strict=True):
        assert mip.dtype == np.float32
        np.testing.assert_array_equal(mip, expected)


def test_probes_come_back(tmp_path: Path) -> None:
    places = (
        Place((0.5, 0.25, -1.0), Room.BOX, (4.0, 5.0, 3.0), (1.0, 2.0, 3.0), 0.75),
        Place((0.0, 0.0, 0.0), Room.SPHERE, (1.0, 1.0, 1.0), (9.0, 0.0, 0.0), 2.0),
    )
    probes = tuple(Probe(place, make_chain().mips) for place in places)
    path = tmp_path / "a.rsibr.exr"
    write_map_set(path, make_map_set(replace(make_chain(), probes=probes)))
    map_set = read_map_set(path, "mip_chain")
    back = from_map_set(path, map_set).probes
    assert [each.place for each in back] == list(places)
    for found, expected in zip(back, probes, strict=True):
        for mip, there in zip(found.mips, expected.mips, strict=True):
            np.testing.assert_array_equal(mip, there)
    with pytest.warns(RsibrWarning, match="bake a mip chain of each"):
        textures_of(path, map_set, Up.Z)


def test_others_find_the_faces_in_opengl_s_order(tmp_path: Path) -> None:
    chain = make_chain()
    write_map_set(tmp_path / "a.rsibr.exr", make_map_set(chain))
    with OpenEXR.File(str(tmp_path / "a.rsibr.exr")) as file:
        pixels = {part.name(): part.channels["RGB"].pixels for part in file.parts}
    # From the file's first row on: all of +X, then all of -X, ..., each from its first row in memory.
    np.testing.assert_array_equal(pixels["mip00"].ravel(), chain.mips[0].ravel())
    np.testing.assert_allclose(pixels["harmonics"][0], chain.harmonics)


def test_what_is_no_mip_chain_is_named(tmp_path: Path) -> None:
    path = tmp_path / "a.rsibr.exr"

    def refusal(change) -> str:
        map_set = make_map_set(make_chain((0.0, 0.25, 1.0)))
        maps, header = dict(map_set.maps), dict(map_set.header)
        change(maps, header, {part["name"]: part for part in header["parts"]})
        header["parts"] = [part for part in header["parts"] if part["name"] in maps]
        write_map_set(path, MapSet("mip_chain", maps, header), force=True)
        with pytest.raises(MapSetError) as refused:
            from_map_set(path, read_map_set(path))
        assert str(path) in str(refused.value)
        return str(refused.value).removeprefix(f"{path} ")

    lacking = "lacks its coefficients or one of its mips: make it again."
    assert refusal(lambda maps, header, parts: maps.pop("mip01")) == lacking
    assert refusal(lambda maps, header, parts: maps.pop("harmonics")) == lacking
    assert refusal(lambda maps, header, parts: parts["mip02"].update(mip=1)) == lacking
    assert "some of its mips only" in refusal(
        lambda maps, header, parts: parts["mip02"].update(roughness=None)
    )
    assert "do not ascend" in refusal(lambda maps, header, parts: parts["mip02"].update(roughness=0.1))
    assert "laid out as octahedral" in refusal(lambda maps, header, parts: header.update(layout="octahedral"))
    strip = np.ones((6, 2, 3), np.float32)
    place = {"room": "box", "size": [1.0] * 3, "middle": [0.0] * 3, "captured_at": [0.0] * 3, "blend": 1.0}

    def with_probe(mip: int, **fields: object):
        def change(maps, header, parts) -> None:
            maps["probe01-mip00"] = maps["mip00"]
            header["parts"].append(
                {"name": "probe01-mip00", "role": "probe", "probe": 1, "mip": mip} | fields
            )

        return change

    assert "probe 1, or its place" in refusal(with_probe(0))
    assert "probe 1, or its place" in refusal(with_probe(1, place=place))
    assert "same sizes" in refusal(with_probe(0, place=place))
    assert "Mip 1 must have the shape" in refusal(lambda maps, header, parts: maps.update(mip01=strip))
    assert "2 coefficients are not those of any degree" in refusal(
        lambda maps, header, parts: maps.update(harmonics=strip[:1])
    )
