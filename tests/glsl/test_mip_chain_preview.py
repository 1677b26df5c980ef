"""Pictures drawn from mip chains against core/kinds/mip_chain/shading.py at every sample."""

from dataclasses import replace

import gpu
import numpy as np
import pytest
from rsibr.rsibr_addon.core.errors import RangeError
from rsibr.rsibr_addon.core.geometry.camera import Camera
from rsibr.rsibr_addon.core.geometry.directions import reflect
from rsibr.rsibr_addon.core.geometry.near_room import Room
from rsibr.rsibr_addon.core.kinds.live_environment import chain_of_faces
from rsibr.rsibr_addon.core.kinds.mip_chain.chain import MipChain
from rsibr.rsibr_addon.core.kinds.mip_chain.probes import Place, Probe
from rsibr.rsibr_addon.core.kinds.mip_chain.shading import Borders, MipLook, mip_chain_radiance
from rsibr.rsibr_addon.core.kinds.mip_chain.texture_space import box_halved, filtered_mips, tent_halved
from rsibr.rsibr_addon.core.light.lamps import directions_in_cap
from rsibr.rsibr_addon.core.maps.representation import representation
from rsibr.rsibr_addon.device.context import ensure_context
from rsibr.rsibr_addon.device.kinds.mip_chain import GpuMipChain, atlas_texels
from rsibr.rsibr_addon.device.kinds.mip_chain_shaders import mip_chain_shader
from rsibr.rsibr_addon.device.preview import PreviewRenderer
from rsibr.tests.glsl.test_preview_renderer import BY_CAMERA, SIZE, SPHERE, reference_pixels

MIPS = pytest.mark.parametrize("mip", [0.0, 1.6, 9.4])


def smooth_chain(halved) -> MipChain:
    """Light that varies slowly, with nine coefficients of which the higher are small, as light's are."""
    direction = representation("cube_map").texel_directions(64)
    faces = np.float32(0.5 + 0.2 * np.sin(3.0 * direction + (0.0, 1.0, 2.0)))
    mips = tuple(mip.astype(np.float32) for mip in filtered_mips(faces, halved))
    nine = np.random.default_rng(5).uniform(-0.3, 0.3, size=(9, 3))
    nine[0] = 2.0
    return MipChain(mips, nine, (0.0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6))


@pytest.fixture(scope="module", params=[box_halved, tent_halved])
def smooth(request: pytest.FixtureRequest) -> tuple[MipChain, PreviewRenderer]:
    ensure_context()
    chain = smooth_chain(request.param)
    return chain, PreviewRenderer(GpuMipChain(chain))


def reference(chain: MipChain, camera: Camera, look: MipLook) -> tuple[np.ndarray, np.ndarray]:
    """Radiance of every pixel, and those all of whose samples see the sphere at n.v > 0.2."""
    return reference_pixels(
        camera, lambda normal, view_dir, seen: mip_chain_radiance(chain, normal, view_dir, look, seen)
    )


@MIPS
@BY_CAMERA
def test_a_picture_is_what_the_reference_says(smooth, mip: float, camera: Camera) -> None:
    chain, renderer = smooth
    look = MipLook(f0=(0.3, 0.5, 0.9), kd=(0.9, 0.5, 0.1), mip=mip)
    expected, inside = reference(chain, camera, look)
    picture = renderer.draw(*SPHERE, camera, SIZE, look)
    assert np.all(picture[inside, 3] == 1.0)
    assert np.count_nonzero(inside) > 0.6 * SIZE**2
    # Facets turn a normal by 2e-4 and its mirror direction by 4e-4, light changes by up to 0.6 a radian; the
    # weights of texels may be rounded to 8 bits, 2 / 512 of their difference, 0.7 in the last mips at most.
    assert np.abs(picture[..., :3] - expected)[inside].max() < 2e-3 * expected.max()


@pytest.mark.parametrize("look", [MipLook(borders=Borders.CLAMPED, mip=9.4), MipLook(roughness=0.25)])
def test_clamped_borders_and_roughness(smooth, look: MipLook) -> None:
    chain, renderer = smooth
    camera = Camera((1.0, -0.7, 0.4))
    expected, inside = reference(chain, camera, look)
    picture = renderer.draw(*SPHERE, camera, SIZE, look)
    # Where faces meet, a sample may fall on either side: one of 16, of a difference below 1.
    assert np.abs(picture[..., :3] - expected)[inside].max() < 2.0 / 16.0
    assert np.quantile(np.abs(picture[..., :3] - expected)[inside], 0.8) < 2e-3 * expected.max()


WIDTHS, AROUND, CAPTURED_AT = (5.0, 4.4, 4.0), (0.4, 0.2, -0.3), (0.5, -0.4, 0.3)
"""A room, its middle, and where its light was captured; the sphere is at the origin."""


def wall_light(points: np.ndarray) -> np.ndarray:
    """Radiance of a point of the walls, which changes slowly along them."""
    return 0.5 + 0.4 * np.sin(1.5 * points + (0.0, 1.0, 2.0))


def met(position: np.ndarray, direction: np.ndarray, room: Room) -> np.ndarray:
    """Where rays from inside meet the room, by walking on until they are out, and halving the last step."""
    inside, outside = np.zeros(direction.shape[:-1]), np.full(direction.shape[:-1], 10.0)
    for _ in range(40):
        middle = 0.5 * (inside + outside)
        place = np.abs(position + middle[..., None] * direction - AROUND) / np.multiply(0.5, WIDTHS)
        is_in = (place.max(axis=-1) if room is Room.BOX else np.linalg.norm(place, axis=-1)) < 1.0
        inside, outside = np.where(is_in, middle, inside), np.where(is_in, outside, middle)
    return position + inside[..., None] * direction


@pytest.mark.parametrize("room", [Room.BOX, Room.SPHERE])
def test_a_mirror_in_a_room_shows_the_walls_where_they_are(room: Room) -> None:
    ensure_context()
    at = np.array(CAPTURED_AT)
    seen = met(at, representation("cube_map").texel_directions(128), room)
    chain = MipChain((np.float32(wall_light(seen)),), np.zeros((9, 3)))
    renderer = PreviewRenderer(GpuMipChain(chain))
    camera = Camera((0.8, -0.9, 0.4))
    look = MipLook(
        f0=(1.0, 1.0, 1.0),
        kd=(0.0, 0.0, 0.0),
        room=room,
        room_size=WIDTHS,
        room_middle=AROUND,
        captured_at=CAPTURED_AT,
    )

    def of_reference(normal: np.ndarray, view_dir: np.ndarray, footprint: np.ndarray) -> np.ndarray:
        return mip_chain_radiance(chain, normal, view_dir, look, footprint, position=normal)

    def of_walls(normal: np.ndarray, view_dir: np.ndarray, footprint: np.ndarray) -> np.ndarray:
        return wall_light(met(normal, reflect(view_dir, normal), room))

    expected, inside = reference_pixels(camera, of_reference)
    truth, _ = reference_pixels(camera, of_walls)
    found = renderer.draw(*SPHERE, camera, SIZE, look)[..., :3]
    distant = renderer.draw(*SPHERE, camera, SIZE, replace(look, room=Room.DISTANT))[..., :3]
    # As in distant surroundings; light changes up to three times as fast by direction
    assert np.abs(found - expected)[inside].max() < 6e-3 * expected.max()
    error, before = (np.sqrt(np.mean((picture - truth)[inside] ** 2)) for picture in (found, distant))
    assert before > 0.05
    assert error < 0.05 * before


DIRECTIONS = directions_in_cap((0.0, 0.0, 1.0), np.pi, 1500)
"""So many tell the irradiance of smooth walls to 1e-3."""


def wall_irradiance(normal: np.ndarray, position: np.ndarray, room: Room) -> np.ndarray:
    """Irradiance over pi of points in the room, as a sum over directions."""
    cosines = normal @ DIRECTIONS.T
    light = np.zeros(normal.shape)
    for number, direction in enumerate(DIRECTIONS):
        facing = cosines[:, number] > 0.0
        towards = np.broadcast_to(direction, (np.count_nonzero(facing), 3))
        shown = wall_light(met(position[facing], towards, room))
        light[facing] += 4.0 / len(DIRECTIONS) * cosines[facing, number, None] * shown
    return light


@pytest.mark.parametrize("room", [Room.BOX, Room.SPHERE])
def test_diffuse_light_in_a_room_shifts_too(room: Room) -> None:
    ensure_context()
    seen = met(np.array(CAPTURED_AT), representation("cube_map").texel_directions(64), room)
    chain = chain_of_faces(np.float32(wall_light(seen)), tent_halved)
    look = MipLook(f0=(0.0, 0.0, 0.0), kd=(1.0, 1.0, 1.0), room=room)
    look = replace(look, room_size=WIDTHS, room_middle=AROUND, captured_at=CAPTURED_AT)
    normal = directions_in_cap((0.0, 0.0, 1.0), np.pi, 60)
    truth = wall_irradiance(normal, normal, room)

    def error(look: MipLook) -> float:
        shaded = mip_chain_radiance(chain, normal, normal, look, position=normal)
        return float(np.sqrt(np.mean((shaded - truth) ** 2)))

    assert error(replace(look, room=Room.DISTANT)) > 0.05
    assert error(look) < error(replace(look, room=Room.DISTANT)) / 3.0

    def of_reference(normal: np.ndarray, view_dir: np.ndarray, footprint: np.ndarray) -> np.ndarray:
        return mip_chain_radiance(chain, normal, view_dir, look, footprint, position=normal)

    camera = Camera((0.8, -0.9, 0.4))
    expected, inside = reference_pixels(camera, of_reference)
    found = PreviewRenderer(GpuMipChain(chain)).draw(*SPHERE, camera, SIZE, look)[..., :3]
    # As of mirrors, above
    assert np.abs(found - expected)[inside].max() < 6e-3 * expected.max()


def test_a_ball_between_two_rooms_is_lit_by_both() -> None:
    ensure_context()
    rng = np.random.default_rng(8)
    directions = representation("cube_map").texel_directions(32)

    def light() -> MipChain:
        turned = directions @ np.linalg.qr(rng.normal(size=(3, 3)))[0]
        return chain_of_faces(np.float32(0.5 + 0.4 * np.sin(2.0 * turned)), tent_halved)

    # The ball reaches out of both, where the world's light begins
    hall = Place((1.0, 0.2, 0.1), Room.BOX, (4.0, 1.5, 4.0), (2.2, 0.0, 0.0), 0.7)
    cellar = Place((-1.0, 0.0, 0.2), Room.SPHERE, (3.0, 4.0, 1.6), (-1.3, 0.0, 0.0), 0.9)
    probes = tuple(Probe(place, light().mips) for place in (hall, cellar))
    chain = replace(light(), probes=probes)
    look = MipLook(f0=(0.4, 0.6, 0.8), kd=(0.9, 0.5, 0.1), mip=1.4)
    camera = Camera((0.3, -0.9, 0.4))

    def of_reference(normal: np.ndarray, view_dir: np.ndarray, footprint: np.ndarray) -> np.ndarray:
        return mip_chain_radiance(chain, normal, view_dir, look, footprint, position=normal)

    expected, inside = reference_pixels(camera, of_reference)
    found = PreviewRenderer(GpuMipChain(chain)).draw(*SPHERE, camera, SIZE, look)[..., :3]
    # As of mirrors, above; beyond a room, rays along its walls may leave it elsewhere
    assert np.quantile(np.abs(found - expected)[inside], 0.98) < 6e-3 * expected.max()
    assert expected[inside].std() > 0.02


def test_a_chain_that_does_not_say_how_blurred_it_is() -> None:
    ensure_context()
    chain = smooth_chain(box_halved)
    renderer = PreviewRenderer(GpuMipChain(MipChain(chain.mips, chain.harmonics)))
    with pytest.raises(RangeError, match="bake it again, or choose a mip"):
        renderer.draw(*SPHERE, Camera((0.0, -1.0, 0.0)), SIZE, MipLook(roughness=0.3))
    assert gpu.state.depth_test_get() == "NONE"


def test_the_atlas_holds_every_mip() -> None:
    chain = smooth_chain(box_halved)
    atlas = atlas_texels(chain)
    assert atlas.shape == (66 + 34 + 18 + 10 + 6 + 4 + 3, 6 * 66, 4)
    assert np.all(atlas[..., 3] == 1.0)
    np.testing.assert_array_equal(atlas[66 + 1 : 66 + 33, 34 + 1 : 34 + 33, :3], chain.mips[1][1])


def test_the_program_is_built_once() -> None:
    ensure_context()
    assert mip_chain_shader() is mip_chain_shader()
