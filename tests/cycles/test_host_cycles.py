"""Renders of spheres: in place, in two parts, with known light and known noise."""

from collections.abc import Callable
from pathlib import Path

import bpy
import numpy as np
import pytest
from rsibr.rsibr_addon.core.conventions import texel_centres
from rsibr.rsibr_addon.core.environment import Environment
from rsibr.rsibr_addon.core.errors import RangeError, RenderError
from rsibr.rsibr_addon.core.geometry.camera import Camera
from rsibr.rsibr_addon.core.geometry.directions import reflect
from rsibr.rsibr_addon.core.maps import equirect, sphere_map
from rsibr.rsibr_addon.files.exr import read_parts
from rsibr.rsibr_addon.host.cameras import add_camera
from rsibr.rsibr_addon.host.cycles import RenderedView, RenderSettings, render_view
from rsibr.rsibr_addon.host.materials import load_material
from rsibr.rsibr_addon.host.rendering import render_to
from rsibr.rsibr_addon.host.scenes import temporary_scene
from rsibr.rsibr_addon.host.spheres import add_sphere
from rsibr.rsibr_addon.host.worlds import light_with
from rsibr.tests.open_file import open_file_state

ASLANT = Camera((1.0, -1.0, 0.5))

Make = Callable[[], bpy.types.Material]


def uniform(*radiance: float) -> Environment:
    return Environment(np.full((4, 8, 3), radiance, dtype=np.float32), "uniform")


def one_texel(row: int, column: int) -> Environment:
    radiance = np.zeros((16, 32, 3), dtype=np.float32)
    radiance[row, column] = 1000.0
    return Environment(radiance, "one texel")


def contrasts(deviation: float = 2.0) -> Environment:
    """As hard to sample as a room with lamps, or softer."""
    radiance = np.random.default_rng(5).lognormal(0.0, deviation, (16, 32, 3))
    return Environment(radiance.astype(np.float32), "contrasts")


def view_of(
    material: str | Make, light: Environment, settings: RenderSettings, camera: Camera = ASLANT
) -> RenderedView:
    with temporary_scene() as scene:
        light_with(scene, light)
        add_sphere(scene, load_material(material) if isinstance(material, str) else material())
        add_camera(scene, camera)
        return render_view(scene, settings)


def shader(*kinds: str) -> bpy.types.Material:
    """A shader node, or two mixed in equal parts."""
    material = bpy.data.materials.new("shader")
    nodes, links = material.node_tree.nodes, material.node_tree.links
    mix = nodes.new("ShaderNodeMixShader")
    for socket, kind in zip((mix.inputs[1], mix.inputs[2]), (kinds * 2)[:2], strict=True):
        node = nodes.new(kind)
        if "Color" in node.inputs:
            node.inputs["Color"].default_value = (1.0, 1.0, 1.0, 1.0)
        links.new(node.outputs[0], socket)
    links.new(mix.outputs[0], nodes["Material Output"].inputs["Surface"])
    return material


def inside(size: int) -> np.ndarray:
    """Texels wholly within the disk."""
    return np.linalg.norm(2.0 * texel_centres(size, size) - 1.0, axis=-1) < 1.0 - 2.0 / size


def test_a_sun_of_one_texel_makes_little_noise() -> None:
    """Its edges, which interpolation spreads into other texels, are sampled as often as they are bright."""
    view = view_of(lambda: shader("ShaderNodeBsdfDiffuse"), one_texel(6, 10), RenderSettings(32, 16))
    # .15 of 16 samples; by a map of directions as fine as the texels .8
    assert view.noise < 0.3


def test_the_sphere_fills_the_frame() -> None:
    for camera in (ASLANT, Camera((0.0, 0.0, -1.0)), Camera((1.0, 2.0, 3.0), np.radians(50.0))):
        view = view_of("clay", uniform(1.0, 1.0, 1.0), RenderSettings(32, 64), camera)
        # Exact areas of texels within a disk; 64 samples find them to 1/64 and a little.
        expected = sphere_map.texel_solid_angle(32) * 32**2 / 16.0
        np.testing.assert_allclose(view.coverage, expected, atol=0.06)
        assert abs(view.coverage.mean() - np.pi / 4.0) < 2e-3
        assert view.rgba.shape == (32, 32, 4)
        assert not np.any(view.rgba[expected == 0.0])


@pytest.mark.parametrize(("row", "column"), [(12, 3), (8, 16), (5, 26), (14, 9), (1, 20)])
def test_a_lit_texel_is_mirrored_where_the_conventions_say(row: int, column: int) -> None:
    for camera in (ASLANT, Camera((-0.3, 0.2, -1.0))):
        view = view_of("mirror", one_texel(row, column), RenderSettings(64, 16), camera)
        normal = sphere_map.normal_from_uv(texel_centres(64, 64)) @ camera.frame.T
        direction = reflect(np.broadcast_to(camera.view_dir, normal.shape), normal)
        # A mirrored sphere shows equal solid angles in equal areas: the mean direction of the light
        # is that of the texel, but for the rim, where a texel of the view shows many directions.
        mean = np.einsum("ij,ijk->k", view.glossy[..., 0], direction)
        texel = equirect.direction_from_uv(texel_centres(32, 16)[row, column])
        if texel @ camera.view_dir > -0.9:
            # Texels are 11 degrees high: a mistake of one half of one would show.
            assert mean @ texel / np.linalg.norm(mean) > np.cos(np.radians(3.0))


def test_uniform_light_looks_the_same_on_a_mirror_and_on_white_lambert() -> None:
    light = uniform(2.0, 1.0, 0.5)
    mirror = view_of("mirror", light, RenderSettings(16, 4))
    lambert = view_of(lambda: shader("ShaderNodeBsdfDiffuse"), light, RenderSettings(16, 4))
    for part in (mirror.glossy, lambert.diffuse):
        # Directions are chosen in proportion to light times BRDF, each with the cosine's weight.
        radiance = part[inside(16)].mean(axis=0)
        np.testing.assert_allclose(radiance, (2.0, 1.0, 0.5), rtol=0.02)
    np.testing.assert_allclose(mirror.diffuse, 0.0, atol=1e-5)
    assert not np.any(lambert.glossy)
    # A mirror has one direction, so uniform light on it has no noise at all.
    assert mirror.noise < 1e-6


def test_what_is_not_glossy_is_in_the_diffuse_part() -> None:
    def glowing() -> bpy.types.Material:
        return shader("ShaderNodeEmission", "ShaderNodeBsdfAnisotropic")

    view = view_of(glowing, uniform(3.0, 3.0, 3.0), RenderSettings(16, 64))
    np.testing.assert_allclose(view.diffuse[inside(16)], 0.5, rtol=1e-4)
    assert view.glossy[inside(16)].mean() == pytest.approx(1.5, rel=0.05)  # white, but rough


def test_behind_a_transparent_surface_is_black() -> None:
    def glazed() -> bpy.types.Material:
        return shader("ShaderNodeBsdfTransparent", "ShaderNodeEmission")

    view = view_of(glazed, uniform(9.0, 9.0, 9.0), RenderSettings(16, 64))
    opaque = view_of("clay", uniform(9.0, 9.0, 9.0), RenderSettings(16, 64))
    # Once in a while a sample misses the core, and then sees through one of the sphere's two layers.
    np.testing.assert_allclose(view.coverage, opaque.coverage, atol=1.0 / 64.0)
    # Transparency is chosen at random for each sample, in the proportion of the mix
    assert view.rgba[inside(16)][:, :3].mean() == pytest.approx(0.5, abs=0.01)


def test_other_working_colours_give_the_same_radiance() -> None:
    bpy.ops.wm.set_working_color_space(working_space="ACEScg")
    view = view_of("mirror", uniform(2.0, 1.0, 0.5), RenderSettings(16, 4))
    # Blender converts in float32, by matrices of six to seven digits.
    expected = np.broadcast_to((2.0, 1.0, 0.5), (np.count_nonzero(inside(16)), 3))
    np.testing.assert_allclose(view.glossy[inside(16)], expected, rtol=1e-4)


def test_equal_seeds_give_equal_bits() -> None:
    a, b, c = (view_of("plastic", contrasts(), RenderSettings(16, 6, True, seed)) for seed in (7, 7, 8))
    for name in ("diffuse", "glossy", "coverage"):
        np.testing.assert_array_equal(getattr(a, name), getattr(b, name))
    assert a.noise == b.noise
    assert not np.array_equal(a.diffuse, c.diffuse)


@pytest.mark.parametrize("samples", [8, 7])
def test_two_halves_are_one_whole(samples: int, tmp_path: Path) -> None:
    with temporary_scene() as scene:
        light_with(scene, contrasts())
        add_sphere(scene, load_material("plastic"))
        add_camera(scene, ASLANT)
        view = render_view(scene, RenderSettings(16, samples))
        scene.cycles.use_sample_subset = False
        scene.cycles.sample_offset = 0
        render_to(scene, tmp_path / "whole.exr")
    channels = {
        name: pixels for part in read_parts(tmp_path / "whole.exr") for name, pixels in part.channels.items()
    }
    whole = np.stack([channels[f"ViewLayer.Combined.{channel}"] for channel in "RGBA"], axis=-1)
    np.testing.assert_allclose(view.rgba, whole, rtol=1e-4, atol=1e-5)  # sums of float32 in two orders


def test_noise_is_known_and_not_understated() -> None:
    views = [view_of("copper", contrasts(), RenderSettings(16, 16, seed=seed)) for seed in range(24)]
    radiance = np.stack([view.rgba[..., :3] for view in views]).astype(np.float64)
    variance = radiance.var(axis=0, ddof=1).mean() / np.mean(radiance.mean(axis=0) ** 2)
    stated = np.mean([view.noise**2 for view in views])
    # 24 views of 200 texels, of light with a heavy tail: the ratio itself is known to some 10 %.
    # Halves complement each other, so their difference overstates the error, seen by a quarter.
    assert 0.85 < np.sqrt(stated / variance) < 1.7


def test_denoising_brings_both_parts_closer_to_the_truth() -> None:
    def error(view: RenderedView, name: str) -> float:
        return float(np.linalg.norm(getattr(view, name) - getattr(truth, name)))

    light = contrasts(1.0)
    truth = view_of("plastic", light, RenderSettings(48, 256))  # of a quarter of the noise
    noisy = view_of("plastic", light, RenderSettings(48, 16, False, 1))
    clean = view_of("plastic", light, RenderSettings(48, 16, True, 1))
    for name in ("diffuse", "glossy"):
        assert error(clean, name) < 0.7 * error(noisy, name)
    np.testing.assert_array_equal(clean.coverage, noisy.coverage)
    assert clean.noise == noisy.noise


def test_what_cannot_be_rendered_is_said() -> None:
    before = open_file_state()
    with pytest.raises(RenderError, match=r"Blender cannot render: .*camera"), temporary_scene() as scene:
        render_view(scene, RenderSettings(16, 2))
    assert open_file_state() == before


@pytest.mark.parametrize(
    ("settings", "words"),
    [
        ({"size": 3, "samples": 4}, "A view cannot be 3 pixels wide: choose 4 to 8192"),
        ({"size": 8, "samples": 1}, "cannot take 1 samples: choose 2 to"),
        ({"size": 8, "samples": 4, "seed": -1}, "seed -1 is out of range"),
        ({"size": 8, "samples": 4, "seed": 1 << 31}, "out of range: choose 0 to 2147483647"),
    ],
)
def test_settings_out_of_range_are_refused(settings: dict[str, int], words: str) -> None:
    with pytest.raises(RangeError, match=words):
        RenderSettings(**settings)
