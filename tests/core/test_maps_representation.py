"""Every representation through the one interface, in world coordinates."""

from dataclasses import replace

import numpy as np
import pytest
from rsibr.rsibr_addon.core.errors import RangeError
from rsibr.rsibr_addon.core.geometry.camera import Camera
from rsibr.rsibr_addon.core.geometry.directions import normalize, reflect
from rsibr.rsibr_addon.core.maps import sphere_map
from rsibr.rsibr_addon.core.maps.representation import (
    AHEAD,
    FRONT,
    REPRESENTATIONS,
    Representation,
    representation,
)
from rsibr.rsibr_addon.core.resample import lookup

ALL = [
    *(representation(name) for name in REPRESENTATIONS),
    representation("mirror_ball", distance=5.0),
    representation("dual_paraboloid", overscan=1.2),
]
DIRECTIONS = normalize(np.random.default_rng(0).standard_normal((2000, 3)))


def names(some: Representation) -> str:
    return f"{some.name}{'-blind' if some.blind_angle else ''}{'-overscan' if 0 < some.disk < 1 else ''}"


@pytest.mark.parametrize("some", ALL, ids=names)
def test_directions_come_back_in_the_world(some: Representation) -> None:
    uv, sheet = some.uv_from_direction(DIRECTIONS)
    shown = some.shows(DIRECTIONS)
    back = some.direction_from_uv(uv, sheet)
    np.testing.assert_allclose(back[shown], DIRECTIONS[shown], atol=1e-7)
    assert uv.min() >= 0.0
    assert uv.max() <= 1.0
    assert set(np.unique(sheet)) == set(range(len(some.sheets)))
    inside = np.linalg.norm(2.0 * uv - 1.0, axis=-1) <= some.disk * (1.0 + 1e-12)
    assert np.all(inside)


@pytest.mark.parametrize("some", ALL, ids=names)
def test_texels_are_where_their_directions_say(some: Representation) -> None:
    sheets, height, width = some.shape(12)
    assert (sheets, width) == (len(some.sheets), 12)
    assert width == some.aspect * height
    directions, solid_angle = some.texel_directions(12), some.texel_solid_angle(12)
    assert directions.shape == (sheets, height, width, 3)
    np.testing.assert_allclose(np.linalg.norm(directions, axis=-1), 1.0, rtol=1e-14)
    assert solid_angle.shape == (sheets, height, width)
    cap = 2.0 * np.pi * (1.0 - np.cos(some.blind_angle))
    assert solid_angle.sum() == pytest.approx(4.0 * np.pi - cap, rel=1e-13)
    # The centre of a texel that counts in full looks up that texel
    uv, sheet = some.uv_from_direction(directions)
    column, row = np.moveaxis((uv * (width, height)).astype(int), -1, 0)
    j, i = np.indices((height, width))
    radius = np.hypot(2.0 * (i + 0.5) / width - 1.0, 2.0 * (j + 0.5) / height - 1.0)
    whole = np.broadcast_to(radius < some.disk - 1e-6, solid_angle.shape)
    found = np.stack([sheet, row, column])[:, whole]
    np.testing.assert_array_equal(found, np.stack(np.indices(solid_angle.shape))[:, whole])


def test_unknown_names_parameters_and_sizes_are_refused() -> None:
    with pytest.raises(RangeError, match="no maps of kind hexagon: choose one of equirect, sphere_map,"):
        representation("hexagon")
    with pytest.raises(RangeError, match="is in the ball"):
        representation("mirror_ball", distance=1.0)
    with pytest.raises(RangeError, match="give 1 or more"):
        representation("dual_paraboloid", overscan=0.5)
    for size in (0, 7):
        with pytest.raises(
            RangeError, match=rf"kind equirect cannot be {size} texels wide: choose a multiple"
        ):
            representation("equirect").shape(size)


def test_frames() -> None:
    # x right, y up, z towards the viewer, who looks along +Y; and ahead for cube pictures
    np.testing.assert_array_equal(FRONT @ (1, 2, 3), (1, -3, 2))
    np.testing.assert_array_equal(AHEAD @ (1, 2, 3), (1, 3, 2))


def test_a_sphere_map_is_the_front_views() -> None:
    frame = Camera((0.0, -1.0, 0.0)).frame
    uv = np.random.default_rng(1).random((500, 2))
    normal = sphere_map.normal_from_uv(uv) @ frame.T
    mirrored = reflect(np.broadcast_to((0.0, -1.0, 0.0), normal.shape), normal)
    for name in ("sphere_map", "mirror_ball"):
        found = representation(name).direction_from_uv(uv, np.zeros(500, dtype=int))
        np.testing.assert_allclose(found, mirrored, atol=1e-7)


@pytest.mark.parametrize("name", ["equirect", "cube_map", "octahedral"])
@pytest.mark.parametrize("size", [2, 6])
def test_lookups_are_continuous_across_every_seam(name: str, size: int) -> None:
    some = representation(name)
    rng = np.random.default_rng(2)
    image = rng.random((*some.shape(size), 2))
    # Directions on the seams' planes: the edges of cubes and octahedra and the date line are on these
    planes = normalize(
        [(1, -1, 0), (1, 1, 0), (1, 0, -1), (1, 0, 1), (0, 1, -1), (0, 1, 1), (1, 0, 0), (0, 1, 0), (0, 0, 1)]
    )
    for plane in planes:
        on = normalize(DIRECTIONS - (DIRECTIONS @ plane)[:, None] * plane)
        if name == "equirect":
            on = on[np.abs(on[:, 2]) < 0.99]  # at its poles it shows another value from every side
        below, above = (lookup(image, normalize(on + away * plane), some) for away in (-1e-7, 1e-7))
        # Neighbouring texels differ by up to 1, and a texel is 0.01 or more across where these fall
        np.testing.assert_allclose(below, above, atol=2e-7 / 0.01)


def test_the_cubes_corner_is_the_mean_of_its_three_texels() -> None:
    cube = representation("cube_map")
    image = np.random.default_rng(3).random((6, 4, 4, 3))
    corner = normalize((1.0, 1.0, 1.0))
    uv, _ = cube.uv_from_direction(normalize([(1.0, 0.99, 0.99), (0.99, 1.0, 0.99), (0.99, 0.99, 1.0)]))
    columns, rows = (uv * 4).astype(int).T
    np.testing.assert_allclose(
        lookup(image, corner, cube), image[[0, 2, 4], rows, columns].mean(axis=0), rtol=1e-12
    )


def test_another_frame_turns_the_map() -> None:
    cube = representation("cube_map")
    as_picture = replace(cube, frame=AHEAD)
    # World up is the cube's +Z, but the picture's py; +Y, ahead, is the picture's pz
    for direction, own, picture in (
        ((0, 0, 1), "pz", "py"),
        ((0, 1, 0), "py", "pz"),
        ((-1, 0, 0), "nx", "nx"),
    ):
        assert cube.sheets[int(cube.uv_from_direction(direction)[1])] == own
        assert cube.sheets[int(as_picture.uv_from_direction(direction)[1])] == picture
