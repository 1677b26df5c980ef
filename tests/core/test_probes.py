"""Light of several rooms: which of it a point has, what is shaded from it, and its text."""

from contextlib import nullcontext
from dataclasses import replace

import numpy as np
import pytest
from rsibr.rsibr_addon.core.errors import RangeError, ShapeError
from rsibr.rsibr_addon.core.geometry.directions import normalize
from rsibr.rsibr_addon.core.geometry.near_room import Room
from rsibr.rsibr_addon.core.kinds.live_environment import chain_of_faces
from rsibr.rsibr_addon.core.kinds.mip_chain.chain import MipChain
from rsibr.rsibr_addon.core.kinds.mip_chain.probes import Place, Probe, shares
from rsibr.rsibr_addon.core.kinds.mip_chain.shading import MipLook, mip_chain_radiance
from rsibr.rsibr_addon.core.kinds.mip_chain.texture_space import tent_halved
from rsibr.rsibr_addon.settings.mip_chain import MipChainSettings
from rsibr.rsibr_addon.settings.probes import ProbeOptions, probes_from_text

RNG = np.random.default_rng(12)
NORMALS = normalize(RNG.normal(size=(40, 3)))
HALL = Place((1.0, 0.5, 0.0), Room.BOX, (4.0, 4.0, 3.0), (2.0, 0.0, 0.0), 0.5)
CELLAR = Place((-1.0, 0.0, 0.2), Room.SPHERE, (2.0, 4.0, 3.0), (-1.0, 0.0, 0.0), 1.0)
BESIDE = replace(HALL, middle=(-2.0, 0.0, 0.0), captured_at=(-2.0, 0.0, 0.0))


def chain() -> MipChain:
    return chain_of_faces(RNG.random((6, 8, 8, 3), dtype=np.float32), tent_halved)


@pytest.mark.parametrize(
    ("place", "position", "expected"),
    [
        (HALL, (0.1, 1.9, -1.4), 1.0),
        (HALL, (4.25, 0.0, 0.0), 0.5),
        (HALL, (4.3, 2.4, 0.0), 0.0),
        (HALL, (2.0, 0.0, 1.6), 0.8),
        (CELLAR, (-0.5, 0.0, 0.0), 1.0),
        (CELLAR, (-1.0, 2.25, 0.0), 0.75),
        (CELLAR, (-1.0, 0.0, 2.5), 0.0),
    ],
)
def test_a_probe_counts_in_its_room_and_fades_beyond(
    place: Place, position: tuple[float, float, float], expected: float
) -> None:
    assert place.weight(position) == pytest.approx(expected)


def test_shares_are_whole_and_pass_evenly_through_a_door() -> None:
    positions = RNG.uniform(-5.0, 5.0, (1000, 3))
    found = shares([HALL, CELLAR, BESIDE], positions)
    np.testing.assert_allclose(np.sum(found, axis=0), 1.0)
    assert min(share.min() for share in found) >= 0.0
    assert shares([HALL, BESIDE], [[0.0, 0.0, 0.0]])[1] == pytest.approx(0.5)
    through = np.linspace((-1.0, 0.0, 0.0), (1.0, 0.0, 0.0), 401)
    outside, hall, beside = shares([HALL, BESIDE], through)
    assert np.all(outside == 0.0)
    # Over both blends together, a step of 1/200 of which changes 1 / (1 + w) by 1/100 at most
    assert np.abs(np.diff(hall)).max() < 0.011
    np.testing.assert_allclose(hall, beside[::-1])
    assert shares([], positions)[0].shape == (1000,)


@pytest.mark.parametrize("kd", [0.0, 0.7])
def test_inside_a_room_its_probe_alone_shades(kd: float) -> None:
    world, hall = chain(), chain()
    both = replace(world, probes=(Probe(HALL, hall.mips),))
    look = MipLook(kd=(kd,) * 3, f0=(0.3,) * 3, mip=1.0)
    inside = RNG.uniform(-1.0, 1.0, NORMALS.shape) + HALL.middle
    views = normalize(NORMALS + 0.3 * RNG.normal(size=NORMALS.shape))
    found = mip_chain_radiance(both, NORMALS, views, look, position=inside)
    in_room = replace(look, room=HALL.room, room_size=HALL.size, room_middle=HALL.middle)
    in_room = replace(in_room, captured_at=HALL.captured_at)
    np.testing.assert_allclose(found, mip_chain_radiance(hall, NORMALS, views, in_room, position=inside))
    away = mip_chain_radiance(both, NORMALS, views, look, position=inside + (50.0, 0.0, 0.0))
    np.testing.assert_allclose(away, mip_chain_radiance(world, NORMALS, views, look))
    # Where nobody says where points are, there are no rooms
    np.testing.assert_allclose(mip_chain_radiance(both, NORMALS, views, look), away)


def test_a_probe_of_another_size_is_refused() -> None:
    with pytest.raises(ShapeError, match="same sizes"):
        replace(chain(), probes=(Probe(HALL, chain().mips[1:]),))


def test_probes_come_back_from_their_text() -> None:
    probes = (
        ProbeOptions(light="C:/a b/hall.exr", size=(4.0, 5.0, 3.0), at=(1.0, -2.5, 1e-3), blend=0.25),
        ProbeOptions(light="cellar.exr", room=Room.SPHERE, middle=(0.0, 0.0, -3.0)),
    )
    text = ";".join(each.text for each in probes)
    assert probes_from_text(text) == probes
    assert MipChainSettings(probes=text).rooms == probes
    assert probes[0].place == Place((1.0, -2.5, 1e-3), Room.BOX, (4.0, 5.0, 3.0), (0.0, 0.0, 0.0), 0.25)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("hall.exr", "give each of light"),
        ("box:size=4/4/4", "has no picture: write light=FILE"),
        ("ball:light=a.exr", "choose one of box, sphere"),
        ("distant:light=a.exr", "choose one of box, sphere"),
        ("box:light=a.exr,light=b.exr", "once, as KEY=VALUE"),
        ("box:light=a.exr,size=4/4", "Room Size of a probe"),
        ("box:light=a.exr,blend=0", "Blend cannot be 0"),
        ("box:light=a.exr,at=x/y/z", "Captured At of a probe"),
        (";".join(["box:light=a.exr"] * 40), "choose a size of at most 128"),
    ],
)
def test_a_text_that_is_no_probe_says_why(text: str, said: str) -> None:
    with pytest.raises(RangeError, match=said):
        MipChainSettings(probes=text)


@pytest.mark.parametrize(
    ("count", "size", "said"),
    [
        (61, 128, "61 probes of 128 texels do not fit into a texture: choose a size of at most 64."),
        (249, 32, "249 probes of 32 texels do not fit into a texture: choose a size of at most 16."),
        (256, 16, "at most 255 probes, not 256"),
        (59, 128, ""),
        (60, 128, "choose a size of at most 64"),
    ],
)
def test_more_probes_than_a_texture_or_a_map_set_holds_are_refused(count: int, size: int, said: str) -> None:
    room = "box:light=room.exr,size=6/5/3,middle=0/0/1.5,at=0/0/1.5,blend=0.5"
    refused = pytest.raises(RangeError, match=said) if said else nullcontext()
    with refused:
        MipChainSettings(size=size, probes=";".join([room] * count))
    # All rows of a texture: each mip of each chain has a row of texels more above and below
    mips = [size >> mip for mip in range(size.bit_length())]
    rows = (1 + count) * sum(each + 2 for each in mips)
    assert (rows <= 16384 and count <= 255) == (not said)
