"""Light probes that others captured and converted: maps must show the same rooms as theirs."""

from pathlib import Path

import numpy as np
import pytest
from rsibr.rsibr_addon.core.conventions import texel_centres
from rsibr.rsibr_addon.core.maps import equirect
from rsibr.rsibr_addon.core.maps.representation import Representation, representation
from rsibr.rsibr_addon.core.resample import resample
from rsibr.rsibr_addon.files.pictures import read_exr
from rsibr.rsibr_addon.files.radiance_hdr import read_hdr
from rsibr.rsibr_addon.files.radiance_pictures import write_radiance
from rsibr.tests.measurements import measurement
from rsibr.tests.synthetic_ball import surroundings


def logarithm(image: np.ndarray) -> np.ndarray:
    return np.log(np.maximum(image[..., 1], 1e-6))


def correlation(a: np.ndarray, b: np.ndarray, weight: np.ndarray) -> float:
    a, b = (x - np.average(x, weights=weight) for x in (a, b))
    return float(np.sum(weight * a * b) / np.sqrt(np.sum(weight * a * a) * np.sum(weight * b * b)))


def made(layout: str) -> np.ndarray:
    """Radiance in a room in closed form at the texels of a layout, by its inventors' formulas."""
    u = np.broadcast_to((2.0 * np.arange(200) + 1.0) / 200.0 - 1.0, (200, 200))
    v = u.T
    if layout == "angular_map":
        radius = np.hypot(u, v)
        sine = np.pi * np.sinc(radius)  # sin(pi r) / r
        return surroundings(np.stack([sine * u, np.cos(np.pi * radius), sine * v], axis=-1))[None]
    u, v = 1.2 * u, 1.2 * v
    front = np.stack([2.0 * u, u**2 + v**2 - 1.0, -2.0 * v], axis=-1) / (1.0 + u**2 + v**2)[..., None]
    return surroundings(np.stack([front, -front]))


@pytest.mark.parametrize(
    ("layout", "representation_of"),
    [
        ("angular_map", representation("angular_map")),
        ("dual_paraboloid", representation("dual_paraboloid", overscan=1.2)),
    ],
)
def test_pictures_of_a_known_room_show_it(
    tmp_path: Path, layout: str, representation_of: Representation
) -> None:
    sheets = []
    for number, sheet in enumerate(made(layout)):
        write_radiance(tmp_path / f"{number}.hdr", sheet)
        sheets.append(read_hdr(tmp_path / f"{number}.hdr"))
    ours = resample(np.stack(sheets), representation_of, representation("equirect"), 128)[0]
    expected = surroundings(equirect.direction_from_uv(texel_centres(128, 64)))
    # Mantissas are of eight bits for the brightest channel, and a texel is the mean over 3 degrees, of room
    # details of 15; those at the poles are narrower than the sheets' texels
    error = np.abs(ours - expected) / expected.max(axis=-1, keepdims=True)
    assert error[1:-1].max() < 0.05


@pytest.mark.slow
def test_an_angular_map_shows_the_same_room_as_a_latlong_of_others() -> None:
    # The file's first row, which should be the top, is the floor, and its unit is another one
    latlong = read_exr(measurement("probes/latlong/grace_latlong_pbrt2.exr"))[::-1, :, :3]
    angular = read_hdr(measurement("probes/angular/grace_probe.hdr"))
    # Its middle is the angular map's. Ours is +X and an angular map's is +Y, which is a quarter to the left
    turned = np.roll(latlong, -256, axis=1)
    ours = resample(angular[None], representation("angular_map"), representation("equirect"), 256)[0]
    theirs = resample(turned[None], representation("equirect"), representation("equirect"), 256)[0]
    weight = equirect.texel_solid_angle(256, 128)
    ours, theirs = logarithm(ours), logarithm(theirs)
    assert correlation(ours, theirs, weight) > 0.9999
    # One column more or less would be seen, and a mirror image is another room
    assert max(correlation(np.roll(ours, by, axis=1), theirs, weight) for by in (-1, 1)) < 0.98
    assert max(correlation(ours[:, ::-1], theirs, weight), correlation(ours[::-1], theirs, weight)) < 0.2
    # But for the unit, the typical texel agrees to a percent
    ratio = ours - theirs
    assert np.median(np.abs(ratio - np.median(ratio))) < 0.01


@pytest.mark.slow
@pytest.mark.parametrize("probe", ["kitchen", "galileo"])
def test_paraboloid_pairs_show_the_same_room_as_the_angular_maps(probe: str) -> None:
    angular = read_hdr(measurement(f"probes/angular/{probe}_probe.hdr"))[None]
    pair = np.stack(
        [read_hdr(measurement(f"probes/dual_paraboloid/{probe}-{side}.hdr")) for side in ("front", "back")]
    )
    octahedral, paraboloid = representation("octahedral"), representation("dual_paraboloid", overscan=1.2)
    weight = octahedral.texel_solid_angle(128)[0]
    expected = logarithm(resample(angular, representation("angular_map"), octahedral, 128)[0])

    def likeness(sheets: np.ndarray) -> float:
        return correlation(logarithm(resample(sheets, paraboloid, octahedral, 128)[0]), expected, weight)

    # Made by other hands and slightly blurred; upside down, mirrored or swapped it is another room
    assert likeness(pair) > 0.985
    assert max(likeness(pair[:, ::-1]), likeness(pair[:, :, ::-1]), likeness(pair[::-1])) < 0.5
