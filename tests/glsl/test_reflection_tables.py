"""Pictures drawn from reflection tables against core/kinds/reflection_tables/shading.py at every sample."""

import numpy as np
import pytest
from rsibr.rsibr_addon.core.antialiased.footprint import parallelogram
from rsibr.rsibr_addon.core.conventions import texel_centres
from rsibr.rsibr_addon.core.geometry.camera import Camera
from rsibr.rsibr_addon.core.kinds.reflection_tables.shading import TablesLook, reflect_tables
from rsibr.rsibr_addon.core.kinds.reflection_tables.tables import ReflectionTables, Role
from rsibr.rsibr_addon.core.maps import equirect
from rsibr.rsibr_addon.device.context import ensure_context
from rsibr.rsibr_addon.device.kinds.reflection_tables import GpuReflectionTables
from rsibr.rsibr_addon.device.preview import PreviewRenderer
from rsibr.rsibr_addon.host.meshes import load_mesh
from rsibr.tests.glsl.test_preview_renderer import BY_CAMERA, SIZE, SPHERE, pixels, reference_pixels, samples
from rsibr.tests.synthetic_views import environment_radiance


def smooth_map(rows: int, turn: np.ndarray) -> np.ndarray:
    directions = equirect.direction_from_uv(texel_centres(2 * rows, rows))
    return environment_radiance(directions @ turn).astype(np.float32)


def smooth_tables(eta: float) -> ReflectionTables:
    """A smooth map for each role, each turned another way and of another size; smooth weights."""
    rng = np.random.default_rng(4)
    turns = [np.linalg.qr(rng.normal(size=(3, 3)))[0] for _ in Role]
    maps = {role: smooth_map(24 + 8 * number, turns[number]) for number, role in enumerate(Role)}
    cosine = ((np.arange(32) + 0.5) / 32)[:, None]
    weights = np.stack([0.2 + rng.random(3) * cosine ** (number + 1) for number in range(len(Role))])
    parts = {
        "diffuse": "lambert:kd=0.5",
        "specular": "phong:n=20,ks=0.4",
        "coat": "fresnel:eta=1.5",
        "retro": "phong:n=50,ks=0.5",
        "refraction": f"clear:eta={eta}",
    }
    return ReflectionTables(maps, weights.astype(np.float32), eta, parts)


LOOKS = {
    "all": TablesLook(antialiased=False),
    **{role.value: TablesLook((role,), antialiased=False) for role in Role},
    "weighted": TablesLook(
        w_diffuse=0.5, w_specular=1.4, w_coat=0.0, w_retro=0.8, w_refraction=0.3, antialiased=False
    ),
    "faded": TablesLook(fade=True, antialiased=False),
    "another": TablesLook(
        antialiased=False,
        diffuse="lambert:kd=0.3/0.2/0.1",
        emission="0.1/0/0.2",
        specular="phong:n=20,ks=0.1/0.2/0.3",
        coat="constant:k=0.2",
        refraction="clear:eta=1.2,tint=1/0.5/0.25",
        weights="curve:wd=0:1/1:0.5,ws=0:1/0.5:0.2",
    ),
}


@pytest.mark.parametrize("name", LOOKS)
@pytest.mark.parametrize("eta", [1.5, 0.7])
@BY_CAMERA
def test_a_picture_is_what_the_reference_says(name: str, eta: float, camera: Camera) -> None:
    ensure_context()
    tables, look = smooth_tables(eta), LOOKS[name]
    picture = PreviewRenderer(GpuReflectionTables(tables)).draw(*SPHERE, camera, SIZE, look)
    normal, view_dir, cosine = samples(camera)
    # Near the critical angle a refracted direction turns without limit for the normal's smallest turn.
    clear = np.abs(np.sqrt(np.maximum(1.0 - cosine**2, 0.0)) - eta) > 0.05
    expected, inside = pixels(reflect_tables(tables, normal, view_dir, look), (cosine > 0.2) & clear)
    assert np.count_nonzero(inside) > 0.4 * SIZE**2
    # As in test_preview_renderer: facets turn normals by up to 2e-4, directions that come of them by
    # twice to six times that, radiance changes by up to 2.6 a radian.
    error = np.abs(picture[..., :3] - expected)[inside].max()
    assert error < 2e-3 * expected[inside].max()
    assert expected[inside].std() > 0.02


def test_tables_that_are_not_there_are_black() -> None:
    ensure_context()
    tables = smooth_tables(1.5)
    alone = ReflectionTables({Role.RETRO: tables.maps[Role.RETRO]}, tables.weights)
    renderer = PreviewRenderer(GpuReflectionTables(alone))
    hidden = renderer.draw(*SPHERE, Camera((1.0, 0.0, 0.0)), 8, TablesLook((Role.DIFFUSE, Role.COAT)))
    np.testing.assert_array_equal(hidden[..., :3], 0.0)
    assert hidden[4, 4, 3] == 1.0
    seen = renderer.draw(*SPHERE, Camera((1.0, 0.0, 0.0)), 8, TablesLook())
    # In an orthographic view retro-reflection depends on the angle alone.
    expected = reflect_tables(alone, (1.0, 0.0, 0.0), (1.0, 0.0, 0.0), TablesLook())
    np.testing.assert_allclose(seen[3:5, 3:5, :3], np.broadcast_to(expected, (2, 2, 3)), rtol=0.05)


TEXELS = 128
"""Rows of a table that shows a lamp of 3 x 3 texels, 2.5 degrees wide."""


def lamp_pictures(look: TablesLook, turns: int) -> np.ndarray:
    """The lamp in a mirror ball of 8 x 8 pixels, a texel further in each picture; shape (turns, 8, 8, 4)."""
    pictures = []
    for turn in range(turns):
        table = np.full((TEXELS, 2 * TEXELS, 3), 1e-3, dtype=np.float32)
        table[70:73, TEXELS + 20 + turn : TEXELS + 23 + turn] = 1e4
        tables = ReflectionTables({Role.SPECULAR: table}, np.ones((len(Role), 2, 3), dtype=np.float32))
        renderer = PreviewRenderer(GpuReflectionTables(tables))
        pictures.append(renderer.draw(*SPHERE, Camera((1.0, 0.0, 0.0)), 8, look))
    return np.array(pictures)


def test_an_antialiased_lamp_neither_goes_out_nor_flickers() -> None:
    ensure_context()
    # A mirror ball scatters evenly: of its disk, solid angle / 4 shows the lamp, in pixels of 1/16.
    solid_angle = equirect.texel_solid_angle(2 * TEXELS, TEXELS)[70:73, :3].sum()
    expected = 1e4 * solid_angle / 4.0 * 16.0
    interpolated = lamp_pictures(TablesLook(antialiased=False), 8)[..., 0].sum(axis=(1, 2))
    assert interpolated.min() < 0.01 * expected
    assert interpolated.max() > 2.0 * expected
    averaged = lamp_pictures(TablesLook(antialiased=True), 8)[..., 0].sum(axis=(1, 2))
    # Boxes hold a sample's footprint, and so some of its neighbours': 10 % was seen.
    np.testing.assert_allclose(averaged, expected, rtol=0.15)


@pytest.mark.parametrize(
    "look",
    [TablesLook((Role.SPECULAR, Role.COAT), w_specular=1.3, w_coat=0.4)]
    + [TablesLook((role,)) for role in (Role.RETRO, Role.REFRACTION)],
    ids=["specular and coat", "retro", "refraction"],
)
@BY_CAMERA
def test_an_antialiased_picture_is_what_the_reference_says(look: TablesLook, camera: Camera) -> None:
    ensure_context()
    tables = smooth_tables(1.5)
    picture = PreviewRenderer(GpuReflectionTables(tables)).draw(*SPHERE, camera, SIZE, look)

    def shaded(normal: np.ndarray, view_dir: np.ndarray, seen: np.ndarray) -> np.ndarray:
        across, up = np.gradient(view_dir, axis=1), np.gradient(view_dir, axis=0)
        views = parallelogram(view_dir, across, up)
        return reflect_tables(tables, normal, view_dir, look, seen, view_footprint=views)

    expected, inside = reference_pixels(camera, shaded, 0.3)
    error = np.abs(picture[..., :3] - expected)[inside].max()
    assert error < 2e-3 * expected[inside].max()


def test_refracted_light_fills_pictures_of_odd_widths() -> None:
    ensure_context()
    renderer = PreviewRenderer(GpuReflectionTables(smooth_tables(1.5)))
    looks = [TablesLook((Role.REFRACTION,), antialiased=antialiased) for antialiased in (True, False)]
    tiled, whole = (renderer.draw(*SPHERE, Camera((1.0, 0.0, 0.0)), 15, look) for look in looks)
    assert tiled.shape == whole.shape == (15, 15, 4)
    # A pixel at the outline is covered in sixteenths, or in a quarter of that: by up to 1/16 another way
    np.testing.assert_allclose(tiled[..., 3], whole[..., 3], atol=0.07)
    inside = whole[..., 3] == 1.0
    # The table is smooth, so that more samples of a pixel have about the same mean
    np.testing.assert_allclose(tiled[inside], whole[inside], atol=0.05)


@pytest.mark.slow
def test_antialiased_glass_has_a_quarter_of_the_error_before_lamps() -> None:
    ensure_context()
    mesh, rng, size, finer = load_mesh("monkey"), np.random.default_rng(0), 16, 8
    surface = mesh.positions, mesh.normals, mesh.triangles
    camera = Camera((0.3, -0.9, 0.3))
    behind = rng.normal(size=(400, 3))
    behind /= np.linalg.norm(behind, axis=1, keepdims=True)
    lamps = equirect.uv_from_direction(behind[behind @ camera.view_dir < -0.7][:9])
    columns, rows = (np.floor(lamps * (2 * TEXELS, TEXELS)).astype(int)).T
    single, averaged = (TablesLook(antialiased=antialiased) for antialiased in (False, True))
    wrong, energy = [], []
    for turn in range(2):
        table = np.ones((TEXELS, 2 * TEXELS, 3), dtype=np.float32)
        for row, column in np.ndindex(2, 2):
            table[rows + row, (columns + column + turn) % (2 * TEXELS)] = 5000.0
        weights = np.ones((len(Role), 2, 3), dtype=np.float32)
        glass = ReflectionTables({Role.REFRACTION: table}, weights, 1.5)
        renderer = PreviewRenderer(GpuReflectionTables(glass))
        fine = renderer.draw(*surface, camera, size * finer, single)[..., :3]
        truth = fine.reshape(size, finer, size, finer, 3).mean(axis=(1, 3))
        pictures = [renderer.draw(*surface, camera, size, look)[..., :3] for look in (single, averaged)]
        wrong.append([np.sum((picture - truth) ** 2) for picture in pictures])
        energy.append(pictures[1].sum() / truth.sum())
    of_single, of_averaged = np.sqrt(np.sum(wrong, axis=0))
    assert of_averaged < 0.25 * of_single
    # Of a table that turned by a texel, 1.4 degrees
    assert np.ptp(energy) < 0.05
