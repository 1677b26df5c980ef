"""Any map from any other: what is kept, and means over areas against brute force."""

import dataclasses

import numpy as np
import pytest
from rsibr.rsibr_addon.core import splat
from rsibr.rsibr_addon.core.conventions import texel_centres
from rsibr.rsibr_addon.core.errors import RangeError, ShapeError
from rsibr.rsibr_addon.core.geometry.directions import normalize
from rsibr.rsibr_addon.core.maps.representation import REPRESENTATIONS, Representation, representation
from rsibr.rsibr_addon.core.parallelograms import parts_beyond
from rsibr.rsibr_addon.core.resample import lookup, resample

SIZES = {"equirect": 128, "cube_map": 64, "dual_paraboloid": 96, "orthographic": 96}
"""Width of a sheet of a map of some 10,000 texels; of the others, 128."""


def with_texels(name: str) -> tuple[Representation, int]:
    parameters = {"dual_paraboloid": {"overscan": 1.2}}.get(name, {})
    return representation(name, **parameters), SIZES.get(name, 128)


def sky(some: Representation, size: int, seed: int = 0) -> np.ndarray:
    """A map with a wide range of radiance in every texel, and a small sun."""
    rng = np.random.default_rng(seed)
    image = np.exp(1.5 * rng.standard_normal((*some.shape(size), 3))).astype(np.float32)
    counting = np.flatnonzero(some.texel_solid_angle(size) > 0.0)
    image.reshape(-1, 3)[rng.choice(counting)] = (3e4, 2e4, 1e4)
    return image


def power(image: np.ndarray, some: Representation) -> np.ndarray:
    return np.einsum("shw,shwc->c", some.texel_solid_angle(image.shape[2]), image.astype(float))


def brute_force(
    image: np.ndarray, source: Representation, target: Representation, size: int, texels: np.ndarray
) -> np.ndarray:
    """Means over chosen texels by 96 x 96 samples each, nearest texel, shape (texels, channels)."""
    points = 96
    sheet, row, column = np.unravel_index(texels, target.shape(size))
    _, height, width = target.shape(size)
    offset = (np.arange(points) + 0.5) / points
    u = (column[:, None, None] + offset) / width
    v = (row[:, None, None] + offset[:, None]) / height
    uv = np.stack(np.broadcast_arrays(u, v), axis=-1)
    sheet = np.broadcast_to(sheet[:, None, None], uv.shape[:-1])
    direction = target.direction_from_uv(uv, sheet)
    # The area element by differences, whose error of 1e-6 is nothing beside the samples'
    step = 1e-6
    along = [target.direction_from_uv(uv + d, sheet) - direction for d in ((step, 0.0), (0.0, step))]
    density = np.linalg.norm(np.cross(*along), axis=-1)
    density *= np.linalg.norm(2.0 * uv - 1.0, axis=-1) < target.disk
    found, on = source.uv_from_direction(direction)
    height, width = image.shape[1:3]
    columns = np.minimum((found[..., 0] * width).astype(int), width - 1)
    rows = np.minimum((found[..., 1] * height).astype(int), height - 1)
    values = image[on, rows, columns]
    return np.einsum("nij,nijc->nc", density, values) / density.sum(axis=(1, 2))[:, None]


@pytest.mark.slow
@pytest.mark.parametrize("target_name", REPRESENTATIONS)
@pytest.mark.parametrize("source_name", REPRESENTATIONS)
def test_shrinking_keeps_power_and_constants(source_name: str, target_name: str) -> None:
    source, size = with_texels(source_name)
    target, target_size = with_texels(target_name)
    image = sky(source, size)
    # A constant, for a fourth channel
    image = np.concatenate([image, np.full_like(image[..., :1], 0.7)], axis=-1)
    made = resample(image, source, target, target_size // 4)
    assert made.shape == (*target.shape(target_size // 4), 4)
    assert made.min() > 0.0
    # The last digits of sums of 10,000 numbers
    np.testing.assert_allclose(power(made, target), power(image, source), rtol=1e-12)
    np.testing.assert_allclose(made[..., 3], np.float32(0.7), rtol=1e-12)


@pytest.mark.parametrize("target_name", REPRESENTATIONS)
@pytest.mark.parametrize("source_name", ["equirect", "dual_paraboloid"])
def test_means_agree_with_brute_force(source_name: str, target_name: str) -> None:
    source, size = with_texels(source_name)
    target, target_size = with_texels(target_name)
    target_size //= 4
    image = sky(source, size)
    np.minimum(image, 50.0, out=image)
    solid_angle = target.texel_solid_angle(target_size).ravel()
    # Texels that the rim does not cut, and that are not drawn out by a pole or a disk's rim
    whole = np.flatnonzero(solid_angle > 0.6 * np.median(solid_angle[solid_angle > 0.0]))
    some = np.random.default_rng(1).choice(whole, 60, replace=False)
    expected = brute_force(image, source, target, target_size, some)
    found = resample(image, source, target, target_size).reshape(-1, 3)[some]
    error = np.abs(found / expected - 1.0)
    # 96 samples a side over some 4 texels place a texel's outline within 1/48 of it: with neighbours that
    # differ by factors, 1 percent in the mean and a few at worst
    assert np.sqrt(np.mean(error**2)) < 0.02
    assert error.max() < 0.15


@pytest.mark.parametrize(("name", "factor"), [("equirect", 4), ("cube_map", 4), ("sphere_map", 2)])
def test_whole_texels_are_averaged_exactly(name: str, factor: int) -> None:
    some, size = with_texels(name)
    image = sky(some, size)
    made = resample(image, some, some, size // factor)
    sheets, height, width = some.shape(size // factor)
    blocks = (sheets, height, factor, width, factor)
    weight = some.texel_solid_angle(size).reshape(blocks)
    total = np.einsum("shawb,shawbc->shwc", weight, image.reshape(*blocks, 3))
    counting = weight.sum(axis=(2, 4))[..., None]
    expected = total / np.where(counting > 0.0, counting, 1.0)
    if name == "sphere_map":
        # Texels that the rim cuts are laid down in parts: farther in, these show in the total alone
        inner = np.linalg.norm(2.0 * texel_centres(width, height) - 1.0, axis=-1) < 0.9
        np.testing.assert_allclose(made[0, inner], expected[0, inner], rtol=1e-3)
    else:
        np.testing.assert_allclose(made, expected, rtol=1e-11)


def test_a_sun_is_laid_where_it_stands() -> None:
    source, target = representation("equirect"), representation("cube_map")
    image = np.zeros((1, 128, 256, 1), dtype=np.float32)
    image[0, 75, 37] = 1e4
    direction = source.texel_directions(256)[0, 75, 37]
    made = resample(image, source, target, 16)
    weight = target.texel_solid_angle(16)[..., None] * made
    mean = normalize(np.einsum("shwc,shwi->i", weight, target.texel_directions(16)))
    # It lies in one texel or across a few: its mean direction is within a texel, 1/8 at the face's middle
    assert np.linalg.norm(mean - direction) < 0.08
    assert np.count_nonzero(made) <= 4


@pytest.mark.parametrize(
    ("name", "size", "width"), [("cube_map", 16, 128), ("octahedral", 24, 104), ("equirect", 24, 104)]
)
def test_one_sector_is_divided_for_all(name: str, size: int, width: int) -> None:
    source, target = representation("equirect"), representation(name)
    image = sky(source, width)
    sectors, whole = (
        splat.Splat(some, size, 3) for some in (target, dataclasses.replace(target, symmetric=False))
    )
    for each in (sectors, whole):
        each.lay_down(image, source)
    # An octahedral map is bent where its octants meet: which neighbours a texel's edges there are known from
    # depends on the sector
    apart = np.ones(target.shape(size), dtype=bool)
    if name == "octahedral":
        apart[:, size // 2 - 1 : size // 2 + 1] = apart[..., size // 2 - 1 : size // 2 + 1] = False
    apart = apart.ravel()
    np.testing.assert_allclose(sectors.solid_angle[apart], whole.solid_angle[apart], rtol=1e-11)
    np.testing.assert_allclose(sectors.power[:, apart], whole.power[:, apart], rtol=1e-11)
    np.testing.assert_allclose(sectors.power.sum(axis=1), whole.power.sum(axis=1), rtol=1e-12)


@pytest.mark.parametrize("name", ["cube_map", "octahedral", "equirect"])
def test_texels_turn_as_their_directions(name: str) -> None:
    some = representation(name)
    direction = some.texel_directions(12).reshape(-1, 3)
    matrices = np.array([matrix for matrix, _ in representation("equirect").sectors(np.empty((1, 4, 8, 1)))])
    turned = some.turned_texels(np.arange(len(direction)), 12, matrices)
    np.testing.assert_allclose(direction[turned], direction @ matrices.mT, atol=1e-14)


def test_sectors_of_an_equirect_map_are_turned_views() -> None:
    some = representation("equirect")
    direction = some.texel_directions(24)
    sectors = some.sectors(direction)
    assert len(sectors) == len({matrix.tobytes() for matrix, _ in sectors}) == 16
    for matrix, view in sectors:
        assert np.shares_memory(view, direction)
        np.testing.assert_allclose(view, sectors[0][1] @ matrix.T, atol=1e-14)


def test_blocks_do_not_show(monkeypatch: pytest.MonkeyPatch) -> None:
    source, target = representation("cube_map"), representation("octahedral")
    image = sky(source, 32)
    whole = resample(image, source, target, 20)
    monkeypatch.setattr(splat, "TILE", 7)
    monkeypatch.setattr(splat, "BLOCK", 100)
    np.testing.assert_allclose(resample(image, source, target, 20), whole, rtol=1e-12)


@pytest.mark.parametrize("target_name", REPRESENTATIONS)
def test_growing_interpolates(target_name: str) -> None:
    source, target = representation("equirect"), representation(target_name)
    image = sky(source, 32)
    made = resample(image, source, target, 64)
    np.testing.assert_array_equal(made, lookup(image, target.texel_directions(64), source))


@pytest.mark.parametrize("name", REPRESENTATIONS)
def test_the_same_size_is_the_same_map(name: str) -> None:
    some, size = with_texels(name)
    image = sky(some, size)
    counting = some.texel_solid_angle(size) > 0.0
    j, i = np.indices(counting.shape[1:])
    radius = np.hypot(
        *(2.0 * (k + 0.5) / n - 1.0 for k, n in zip((i, j), counting.shape[:0:-1], strict=True))
    )
    inside = counting & (radius < some.disk)
    made = resample(image, some, some, size)
    # Texel centres come back to 1e-13 of a texel, at a disk's rim to 1e-9; neighbours differ by up to 1e6
    np.testing.assert_allclose(made[inside], image[inside], rtol=1e-3 if some.disk == 1.0 else 1e-6)


@pytest.mark.parametrize("name", REPRESENTATIONS)
def test_there_and_back_is_nearly_the_same(name: str) -> None:
    source, some = representation("equirect"), with_texels(name)[0]
    directions = source.texel_directions(64)
    # Light that varies slowly: 1.5 + x + y z
    image = (1.5 + directions[..., :1] + directions[..., 1:2] * directions[..., 2:]).astype(np.float32)
    back = resample(resample(image, source, some, 256), some, source, 64)
    error = np.abs(back - image)
    # Bilinear interpolation errs by h^2 / 8 of the second derivative, at most 4, with h = 2 pi / 64 there,
    # and the means back by a third of it. In a pole's row a texel's mean is not its centre's value but
    # that of a point h / 6 off, where slopes are up to 1.5. At the rims of some maps texels are sqrt(4 / 256)
    # long, or twice as long as that, and hold one value for it: slope 1.5 times a quarter of the length
    in_pole_rows = np.abs(directions[..., 2]) > np.cos(1.1 * np.pi / 32)
    of_long_texels = {"orthographic": 0.125, "sphere_map": 0.25, "mirror_ball": 0.25}.get(name, 0.0)
    tolerance = 0.01 + 1.5 * of_long_texels / 4
    assert error[~in_pole_rows].max() < tolerance
    assert error[in_pole_rows].max() < tolerance + 1.5 * 0.098 / 6


def test_texels_outside_a_disk_show_what_lookups_need() -> None:
    source, target = representation("equirect"), representation("dual_paraboloid", overscan=1.25)
    directions = source.texel_directions(256)
    made = resample((2.0 + directions).astype(np.float32), source, target, 32)
    # Beyond the rim a sheet goes on with the other hemisphere: smooth light is found there too. Texels that
    # the rim cuts hold the mean of the part within, at most half a texel's diagonal off their centres,
    # on which directions move by up to 2 radii
    assert np.count_nonzero(target.texel_solid_angle(32) == 0.0) > 600
    np.testing.assert_allclose(made, 2.0 + target.texel_directions(32), atol=2.0 * 1.25 / 32 * np.sqrt(2.0))


@pytest.mark.parametrize("name", ["sphere_map", "angular_map", "orthographic"])
def test_texels_outside_a_disk_repeat_its_rim(name: str) -> None:
    source, target = representation("equirect"), representation(name)
    rng = np.random.default_rng(5)
    image = rng.random((1, 128, 256, 1)).astype(np.float32)
    made = resample(image, source, target, 32)
    outside = target.texel_solid_angle(32) == 0.0
    for sheet, row, column in np.argwhere(outside):
        towards = np.array([row, column]) - 15.5
        # The last texel inside, on the way from the middle
        steps = 15.5 + towards * np.linspace(0.0, 1.0, 2000)[:, None]
        way = [tuple(step) for step in np.floor(steps + 0.5).astype(int)]
        inside = [texel for texel in way if not outside[sheet, *texel]]
        found = made[sheet, row, column, 0]
        assert found in [made[sheet, *texel, 0] for texel in dict.fromkeys(inside[-200:])]


def test_a_blind_spot_lays_nothing_down_and_shows_its_edge() -> None:
    source, ball = representation("equirect"), representation("mirror_ball", distance=3.0)
    directions = source.texel_directions(256)
    # Bright in the blind spot, but for the two texels at its edge that lookups there mix in
    hidden = directions[..., 1] > np.cos(ball.blind_angle - 2.0 * np.pi / 128)
    image = np.where(hidden, 1e6, 1.0)[..., None].astype(np.float32)
    photograph = resample(image, source, ball, 64)
    np.testing.assert_allclose(photograph, 1.0, rtol=1e-12)
    unwrapped = resample(photograph, ball, source, 64)
    np.testing.assert_allclose(unwrapped, 1.0, rtol=1e-12)


def test_wrong_layouts_and_sizes_are_refused() -> None:
    equirect, cube = representation("equirect"), representation("cube_map")
    with pytest.raises(ShapeError, match="equirect map cannot have the shape"):
        resample(np.zeros((1, 8, 8, 3)), equirect, cube, 4)
    with pytest.raises(ShapeError, match="cube_map map cannot have the shape"):
        resample(np.zeros((5, 8, 8, 3)), cube, equirect, 4)
    with pytest.raises(RangeError, match="choose a multiple of 2"):
        resample(np.zeros((6, 8, 8, 3)), cube, equirect, 5)


def test_parts_of_a_parallelogram() -> None:
    rng = np.random.default_rng(4)
    edges = rng.uniform(-0.6, 0.6, (2, 2, 200))
    edges[:, :, :4] = np.moveaxis(
        [[(1, 0), (0, 1)], [(0.5, 0), (0, 0.2)], [(0, 0.5), (0.3, 0)], [(0, 0), (0, 0)]], 0, -1
    )
    distance = rng.uniform(0.0, 0.5, (2, 200))
    # Points evenly in each parallelogram, by its own coordinates
    inside = (np.arange(400) + 0.5) / 400 - 0.5
    x, y = (
        edges[0, k][:, None, None] * inside[:, None] + edges[1, k][:, None, None] * inside for k in (0, 1)
    )
    right, above = x > distance[0][:, None, None], y > distance[1][:, None, None]
    expected = [(part).mean(axis=(1, 2)) for part in (right & ~above, above & ~right, right & above)]
    # A line cuts some 400 of 160,000 cells, each counted whole: half of these at worst
    np.testing.assert_allclose(parts_beyond(distance, edges), expected, atol=2.0 / 400)
