"""Previews: right against the closed form, the right way up in every file, refused in words."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from rsibr.rsibr_addon.core.conventions import texel_centres
from rsibr.rsibr_addon.core.errors import (
    InputFileError,
    MapSetError,
    OutputFileError,
    RangeError,
    RsibrWarning,
)
from rsibr.rsibr_addon.core.geometry.camera import Camera
from rsibr.rsibr_addon.core.geometry.directions import reflect, turn_about_z
from rsibr.rsibr_addon.core.geometry.reflection_warp import Fading
from rsibr.rsibr_addon.core.kinds.environment import EnvironmentLook
from rsibr.rsibr_addon.core.kinds.radiance_views.shading import Mode, ViewsLook
from rsibr.rsibr_addon.core.kinds.radiance_views.warping import Warping
from rsibr.rsibr_addon.core.light.transfer_curve import srgb_from_linear
from rsibr.rsibr_addon.core.maps import equirect, sphere_map
from rsibr.rsibr_addon.core.maps.representation import representation
from rsibr.rsibr_addon.core.pictures.matte import rays
from rsibr.rsibr_addon.core.progress import drain
from rsibr.rsibr_addon.files.brdfs import brdf_from_spec
from rsibr.rsibr_addon.files.map_set import write_map_set
from rsibr.rsibr_addon.files.pictures import read_exr
from rsibr.rsibr_addon.files.radiance_pictures import write_radiance
from rsibr.rsibr_addon.host.display import displayed_colours
from rsibr.rsibr_addon.host.scenes import temporary_scene
from rsibr.rsibr_addon.settings.drawing import PreviewOptions, Turned
from rsibr.rsibr_addon.tasks.preview import preview, turntable
from rsibr.tests.mirror_capture import (
    BRIGHT_DIR,
    environment,
    mirror_map_set,
    radiance_from,
    write_mirror_capture,
)

pytestmark = pytest.mark.needs("gl")

VIEW = (0.3, -0.8, 0.45)
SIZE = 48


def mirrored_sphere(camera: Camera, size: int) -> tuple[np.ndarray, np.ndarray]:
    """An orthographic picture of the mirror: radiance, and which pixels lie within radius 0.9."""
    points = 2.0 * texel_centres(size, size) - 1.0
    normals = sphere_map.normal_from_uv(texel_centres(size, size)) @ camera.frame.T
    seen = reflect(np.broadcast_to(camera.view_dir, normals.shape), normals)
    return radiance_from(seen), np.linalg.norm(points, axis=-1) < 0.9


@pytest.mark.parametrize("mode", Mode)
@pytest.mark.parametrize("warping", Warping)
def test_a_mirrored_sphere_shows_its_surroundings(tmp_path: Path, mode: Mode, warping: Warping) -> None:
    path = write_mirror_capture(tmp_path / "mirror.rsibr.exr")
    camera = Camera(VIEW)
    settings, look = PreviewOptions(view=VIEW, size=SIZE), ViewsLook(mode, warping)
    output = drain(preview(path, settings, tmp_path / "out.exr", look=look))
    assert output == tmp_path / "out.exr"
    rgba = read_exr(output)
    expected, inside = mirrored_sphere(camera, SIZE)
    # A mirror's views agree about every direction, so blending adds nothing. What is left is the
    # maps' interpolation: h^2 / 8 times a second derivative, with h = 1/32 and, along a radius up to
    # 0.9 where the direction turns by 2 / sqrt(1 - r^2) = 4.6 a unit, 4 (4.6)^2 at the lobe's peak
    # of 1: 1e-2; a pixel's average over 1/24 adds a third of it.
    assert np.abs(rgba[..., :3] - expected)[inside].max() < 0.015
    assert np.all(rgba[inside, 3] == 1.0)
    # pi / 4 of the frame, as fine as 16 samples a pixel on a rim of 48 pi pixels tell.
    assert rgba[..., 3].mean() == pytest.approx(np.pi / 4.0, abs=2e-3)


@pytest.mark.parametrize("look", [None, EnvironmentLook(antialiased=False)])
def test_a_picture_of_an_environment_is_mirrored(tmp_path: Path, look: EnvironmentLook | None) -> None:
    write_radiance(tmp_path / "forest.exr", environment(128).radiance)
    camera = Camera(VIEW)
    settings = PreviewOptions(view=VIEW, size=SIZE)
    rgba = read_exr(drain(preview(tmp_path / "forest.exr", settings, tmp_path / "out.exr", look=look)))
    expected, inside = mirrored_sphere(camera, SIZE)
    # A pixel of 1/24 averages as above; texels of 1.4 degrees err by h^2 / 8 of second derivatives up to 4,
    # averaged over boxes that hold a texel and more by a few times that: 1e-3.
    assert np.abs(rgba[..., :3] - expected)[inside].max() < 0.01


def test_a_picture_that_is_no_environment_is_refused(tmp_path: Path) -> None:
    write_radiance(tmp_path / "square.exr", np.ones((4, 4, 3), np.float32))
    with pytest.raises(InputFileError, match="twice as wide as high"):
        drain(preview(tmp_path / "square.exr", PreviewOptions(view=VIEW), tmp_path / "out.png"))


def test_png_and_exr_agree(tmp_path: Path, stored_bytes: Callable) -> None:
    path = write_mirror_capture(tmp_path / "mirror.rsibr.exr", size=32)
    settings = PreviewOptions(view=VIEW, size=SIZE)
    linear = read_exr(drain(preview(path, settings, tmp_path / "out.exr")))
    shown = stored_bytes(drain(preview(path, settings, tmp_path / "out.png")))
    np.testing.assert_allclose(shown[..., 3], 255.0 * linear[..., 3], atol=0.51)
    opaque = linear[..., 3] == 1.0
    brightest = np.argmax(np.where(opaque, linear[..., 0], 0.0))
    assert np.where(opaque, shown[..., 0], 0.0).flat[brightest] == shown[opaque, 0].max()


def test_exposure_and_view_transform_are_those_of_blender(tmp_path: Path, stored_bytes: Callable) -> None:
    path = write_mirror_capture(tmp_path / "mirror.rsibr.exr", size=32)
    shown = {}
    for name, more in {"plain": {}, "darker": {"exposure": -1.0}, "agx": {"view_transform": "AgX"}}.items():
        settings = PreviewOptions(view=VIEW, size=SIZE, **more)
        shown[name] = stored_bytes(drain(preview(path, settings, tmp_path / f"{name}.png")))
        linear = read_exr(drain(preview(path, settings, tmp_path / f"{name}.exr")))
        np.testing.assert_array_equal(linear, read_exr(tmp_path / "plain.exr"))
    opaque = linear[..., 3] == 1.0
    halved = 255.0 * srgb_from_linear(np.minimum(0.5 * linear[..., :3], 1.0))
    np.testing.assert_allclose(shown["darker"][opaque, :3], halved[opaque], atol=1.0)
    # AgX mixes the colours of bright light and has no straight part
    with temporary_scene() as scene:
        scene.view_settings.view_transform = "AgX"
        agx = 255.0 * displayed_colours(scene, linear[..., :3])
    np.testing.assert_allclose(shown["agx"][opaque, :3], agx[opaque], atol=1.0)
    assert np.abs(agx - shown["plain"][..., :3])[opaque].mean() > 2.0


def test_perspective_looks_from_the_eye(tmp_path: Path) -> None:
    path = write_mirror_capture(tmp_path / "mirror.rsibr.exr", view_count=42)
    camera = Camera(VIEW, field_of_view=np.radians(60.0))
    settings = PreviewOptions(view=VIEW, perspective=60.0, size=SIZE)
    rgba = read_exr(drain(preview(path, settings, tmp_path / "out.exr")))
    # Rays through pixel centres, and where they meet the unit sphere first.
    spread = np.tan(0.5 * camera.field_of_view)
    screen = spread * (2.0 * texel_centres(SIZE, SIZE) - 1.0)
    rays = np.concatenate([screen, np.full((SIZE, SIZE, 1), -1.0)], axis=-1) @ camera.frame.T
    rays /= np.linalg.norm(rays, axis=-1, keepdims=True)
    eye = camera.eye[:3]
    along = rays @ eye
    root = along**2 - (eye @ eye - 1.0)
    inside = root > 0.1
    normals = eye + rays * (-along - np.sqrt(np.maximum(root, 0.0)))[..., None]
    expected = radiance_from(reflect(-rays, normals))
    # As in the orthographic test; root > 0.1 keeps within 0.95 of the silhouette's radius.
    assert np.abs(rgba[..., :3] - expected)[inside].max() < 0.02


@pytest.mark.parametrize("suffix", [".png", ".exr"])
def test_a_turntable_turns_once(tmp_path: Path, suffix: str, stored_bytes: Callable) -> None:
    path = write_mirror_capture(tmp_path / "mirror.rsibr.exr", size=32)
    settings = PreviewOptions(view=VIEW, size=32, turntable=6)
    steps = turntable(path, settings, tmp_path / f"turn{suffix}")
    progress = []
    while True:
        try:
            progress.append(next(steps))
        except StopIteration as end:
            sheet, movie = end.value
            break
    assert [step.done for step in progress] == sorted(step.done for step in progress)
    assert all(step.total == progress[0].total > step.done for step in progress)
    assert (sheet, movie) == (tmp_path / f"turn{suffix}", tmp_path / "turn.mp4")
    assert sorted(each.name for each in tmp_path.iterdir()) == sorted(
        ["mirror.rsibr.exr", sheet.name, "turn.mp4"]
    )
    assert movie.read_bytes()[4:8] == b"ftyp"
    if suffix == ".exr":
        shown = read_exr(sheet)
        assert shown.shape == (64, 128, 4)
        # Six frames, four to a row, from the top left; the last two places are empty.
        assert not shown[:32, 64:].any()
        for number in range(6):
            row, column = divmod(number, 4)
            frame = shown[32 * (1 - row) :, 32 * column :][:32, :32]
            angle = number * np.pi / 3.0
            turned = (
                np.cos(angle) * VIEW[0] - np.sin(angle) * VIEW[1],
                np.sin(angle) * VIEW[0] + np.cos(angle) * VIEW[1],
                VIEW[2],
            )
            expected, inside = mirrored_sphere(Camera(turned), 32)
            assert np.abs(frame[..., :3] - expected)[inside].mean() < 0.01


def test_the_light_lies_behind_and_the_floor_takes_a_shadow(tmp_path: Path) -> None:
    light = tmp_path / "light.exr"
    write_radiance(light, radiance_from(representation("equirect").texel_directions(256)[0]))
    view = (0.0, -1.0, 0.7)

    def seen(**more: Any) -> np.ndarray:
        options = {"view": view, "size": 64, "fill": 0.5, "perspective": 60.0, **more}
        output = tmp_path / "out.exr"
        return read_exr(drain(preview(light, PreviewOptions(**options), output, force=True)))

    alone, over = seen(), seen(background="light")
    outside = alone[..., 3] == 0.0
    np.testing.assert_array_equal(over[alone[..., 3] == 1.0], alone[alone[..., 3] == 1.0])
    directions = rays(Camera(view, np.radians(60.0)), 64)[1]
    # As of mirrors: interpolation of texels
    assert np.abs(over[..., :3] - radiance_from(directions))[outside].max() < 0.01
    brighter = seen(background="light", background_exposure=1.0)
    np.testing.assert_allclose(brighter[outside], over[outside] * (2.0, 2.0, 2.0, 1.0), rtol=1e-5)
    lamp = [
        seen(view=tuple(-BRIGHT_DIR), fill=0.2, background="light", background_blur=blur)[outside, 0].max()
        for blur in (0.0, 20.0)
    ]
    # Some 18 degrees beside its middle, the lobe exp(4 (cos - 1)) is filtered with one of concentration 8
    assert lamp[0] == pytest.approx(0.05 + np.exp(4.0 * (np.cos(np.radians(18.0)) - 1.0)), abs=0.06)
    assert 0.6 < lamp[1] / lamp[0] < 0.9
    box = tmp_path / "box.obj"
    corners = [f"v {x} {y} {z}" for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]
    sides = ("1 2 4 3", "5 7 8 6", "1 5 6 2", "3 4 8 7", "1 3 7 5", "2 6 8 4")
    box.write_text("\n".join([*corners, *(f"f {side}" for side in sides)]))
    alone, over, floor, shadow = (
        seen(mesh=str(box), **more)
        for more in ({}, {"background": "light"}, {"background": "light", "floor": True}, {"floor": True})
    )
    outside = alone[..., 3] == 0.0
    share = floor[..., :3] / over[..., :3]
    assert np.all(share[outside] <= 1.0 + 1e-5)
    assert share[outside].min() < 0.7
    assert np.all(share[:, :8][outside[:, :8]] > share[outside].min() + 0.2)
    np.testing.assert_allclose(shadow[outside, 3], 1.0 - share.mean(axis=-1)[outside], atol=1e-4)
    assert not shadow[outside, :3].any()


def test_a_photograph_lies_behind(tmp_path: Path) -> None:
    path = write_mirror_capture(tmp_path / "mirror.rsibr.exr", size=32)
    picture = np.random.default_rng(7).random((64, 96, 3))
    write_radiance(tmp_path / "photo.exr", picture)
    options = PreviewOptions(view=VIEW, size=32, background=str(tmp_path / "photo.exr"))
    shown = read_exr(drain(preview(path, options, tmp_path / "out.exr")))
    corner = picture[:2, 16:18].mean(axis=(0, 1))
    np.testing.assert_allclose(shown[0, 0, :3], corner, rtol=1e-5)


def turn_of(tmp_path: Path, turned: Turned, **more: Any) -> list[np.ndarray]:
    """Four frames of a turntable of a mirror."""
    path = tmp_path / "mirror.rsibr.exr"
    if not path.exists():
        write_mirror_capture(path, size=32)
    settings = PreviewOptions(view=VIEW, size=32, turntable=4, turned=turned, **more)
    sheet, _ = drain(turntable(path, settings, tmp_path / "turn.exr", force=True))
    return np.split(read_exr(sheet), 4, axis=1)


def test_a_turntable_turns_the_light(tmp_path: Path) -> None:
    camera = Camera(VIEW)
    normals = sphere_map.normal_from_uv(texel_centres(32, 32)) @ camera.frame.T
    seen = reflect(np.broadcast_to(camera.view_dir, normals.shape), normals)
    _, inside = mirrored_sphere(camera, 32)
    for number, frame in enumerate(turn_of(tmp_path, Turned.LIGHT)):
        expected = radiance_from(seen @ turn_about_z(number * np.pi / 2.0))
        assert np.abs(frame[..., :3] - expected)[inside].mean() < 0.01


def test_a_turntable_turns_the_object(tmp_path: Path) -> None:
    sphere = turn_of(tmp_path, Turned.OBJECT)
    # The sphere's triangles turn: a few pixels of its rim
    assert all(np.abs(frame - sphere[0]).mean() < 2e-3 for frame in sphere)
    arrow = tmp_path / "arrow.obj"
    arrow.write_text("v -1 -1 0\nv 1 -1 0.7\nv 0 1 0\nvn 0 0 1\nf 1//1 2//1 3//1\n")
    objects, eyes = (turn_of(tmp_path, turned, mesh=str(arrow)) for turned in (Turned.OBJECT, Turned.EYE))
    # An object's turn one way looks as the eye's way around it does the other way
    for number in range(4):
        np.testing.assert_allclose(objects[number][..., 3], eyes[-number % 4][..., 3], atol=1e-6)
    assert np.abs(objects[1][..., 3] - eyes[1][..., 3]).max() == 1.0


def test_an_objs_picture_is_upright(tmp_path: Path) -> None:
    """A flat arrow that points up along Y in the file, seen from the front."""
    path = write_mirror_capture(tmp_path / "mirror.rsibr.exr", size=32)
    arrow = tmp_path / "arrow.obj"
    arrow.write_text("v -1 -1 0\nv 1 -1 0\nv 0 1 0\nvn 0 0 1\nf 1//1 2//1 3//1\n")
    settings = PreviewOptions(mesh=str(arrow), size=32)
    alpha = read_exr(drain(preview(path, settings, tmp_path / "out.exr")))[..., 3]
    widths = (alpha > 0.5).sum(axis=1)
    assert widths[8] > widths[16] > widths[24] > 0
    # One normal towards the eye: the mirror shows the eye's own direction everywhere.
    rgba = read_exr(tmp_path / "out.exr")
    ahead = radiance_from(np.array([0.0, -1.0, 0.0]))
    np.testing.assert_allclose(
        rgba[alpha == 1.0, :3], np.broadcast_to(ahead, (np.sum(alpha == 1.0), 3)), atol=5e-3
    )


def test_existing_files_and_odd_names_are_refused_before_anything_is_read(tmp_path: Path) -> None:
    absent = tmp_path / "absent.rsibr.exr"
    settings = PreviewOptions(view=VIEW, size=32, turntable=4)
    (tmp_path / "there.png").touch()
    (tmp_path / "turn.mp4").touch()
    with pytest.raises(OutputFileError, match=r"there\.png exists"):
        drain(preview(absent, settings, tmp_path / "there.png"))
    with pytest.raises(OutputFileError, match=r"there\.jpg does not end in \.exr or \.png"):
        drain(preview(absent, settings, tmp_path / "there.jpg"))
    with pytest.raises(OutputFileError, match=r"turn\.mp4 exists"):
        drain(turntable(absent, settings, tmp_path / "turn.png"))
    with pytest.raises(MapSetError, match=r"absent\.rsibr\.exr"):
        drain(preview(absent, settings, tmp_path / "new.png"))
    assert not (tmp_path / "new.png").exists()


@pytest.mark.parametrize(
    ("wanted", "complaint"),
    [
        ({"view": VIEW, "size": 31, "turntable": 4}, "31 pixels wide: choose an even size"),
        ({"view": VIEW, "size": 32, "turntable": 1}, "Turntable cannot be 1"),
        ({"view": (0.0, 0.0, 2.0), "size": 32, "turntable": 4}, "cannot be along Z"),
        ({"view": (0.0, 0.0, 0.0), "size": 32, "turntable": 4}, "length 0"),
        ({"perspective": 180.0, "turntable": 4}, "Perspective cannot be 180 degrees: choose 0.1 to 179"),
    ],
)
def test_a_turntable_that_cannot_be_is_refused(
    tmp_path: Path, wanted: dict[str, Any], complaint: str
) -> None:
    with pytest.raises(RangeError, match=complaint):
        drain(turntable(tmp_path / "m", PreviewOptions(**wanted), tmp_path / "t.png"))


def test_a_model_itself_is_the_sum_over_all_texels(tmp_path: Path) -> None:
    path, spec = write_mirror_capture(tmp_path / "mirror.rsibr.exr", size=32), "phong:n=20,ks=0.6,kd=0.3"
    settings = PreviewOptions(view=VIEW, size=SIZE, exact=spec)
    shown = read_exr(drain(preview(path, settings, tmp_path / "out.exr")))
    frame = Camera(VIEW).frame
    normals = sphere_map.normal_from_uv(texel_centres(SIZE, SIZE))
    radiance = environment().radiance
    light_dirs = representation("equirect").texel_directions(radiance.shape[1])[0] @ frame
    light = radiance * equirect.texel_solid_angle(*radiance.shape[1::-1])[..., None]
    model = brdf_from_spec(spec)
    for row, column in ((24, 24), (12, 30), (30, 8), (24, 44)):
        # The normal as +Z, about any two axes across
        axes = np.linalg.qr(np.column_stack([normals[row, column], np.eye(3)[:, :2]]))[0][:, [1, 2, 0]]
        axes[:, 2] = normals[row, column]
        lights, view = light_dirs @ axes, np.array([0.0, 0.0, 1.0]) @ axes
        expected = np.sum(model(lights, view) * np.maximum(lights[..., 2:], 0.0) * light, axis=(0, 1))
        # The light is looked up in the camera's axes, and the picture shows the mean over a pixel
        np.testing.assert_allclose(shown[row, column, :3], expected, rtol=0.03)


@pytest.mark.parametrize("wanted", [{"perspective": 30.0}, {"turntable": 4}])
def test_a_model_itself_is_shown_in_one_orthographic_picture(wanted: dict[str, Any]) -> None:
    with pytest.raises(RangeError, match="leave the perspective and the turntable out"):
        PreviewOptions(exact="lambert:kd=0.5", **wanted)


def test_a_model_itself_has_no_look(tmp_path: Path) -> None:
    path = write_mirror_capture(tmp_path / "mirror.rsibr.exr", size=16)
    settings, look = PreviewOptions(size=8, exact="lambert:kd=0.5"), ViewsLook(fading=Fading.DISTANCE)
    with pytest.raises(RangeError, match="leave the options of their look out"):
        drain(preview(path, settings, tmp_path / "out.exr", look=look))


def test_light_too_coarse_for_a_model_is_told(tmp_path: Path) -> None:
    path = write_mirror_capture(tmp_path / "mirror.rsibr.exr", size=32)
    settings = PreviewOptions(size=16, exact="ggx:alpha=0.005,f0=0.04")
    with pytest.warns(RsibrWarning, match="too coarse, at .* for alpha 0.005: take a larger environment"):
        drain(preview(path, settings, tmp_path / "out.exr"))


@pytest.mark.parametrize("size", [0, -3, 4096])
def test_sizes_have_limits(size: int) -> None:
    with pytest.raises(RangeError, match="choose 1 to 2048"):
        PreviewOptions(view=VIEW, size=size)


def test_views_of_one_direction_are_refused(tmp_path: Path) -> None:
    map_set = mirror_map_set(size=16)
    for part in map_set.header["parts"][1:]:
        part["view_dir"] = BRIGHT_DIR.tolist()
    write_map_set(tmp_path / "bent.rsibr.exr", map_set)
    with pytest.raises(MapSetError, match="nearer than 1 degree"):
        drain(preview(tmp_path / "bent.rsibr.exr", PreviewOptions(view=VIEW), tmp_path / "out.png"))
