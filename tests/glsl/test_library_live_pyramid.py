"""The functions that a live pyramid is filtered with against their numpy twins."""

import gpu
import numpy as np
from rsibr.rsibr_addon.core.kinds.kernel_pyramid.live import live_maps, live_pyramid, sunlit, tapped
from rsibr.rsibr_addon.core.lobes.rings import WIDTHS
from rsibr.rsibr_addon.core.maps import octahedral
from rsibr.rsibr_addon.core.suns import lamp_suns
from rsibr.rsibr_addon.device.context import ensure_context
from rsibr.rsibr_addon.device.kinds.kernel_pyramid import SUNS
from rsibr.rsibr_addon.device.kinds.live_pyramid import GpuLivePyramid
from rsibr.tests.glsl.evaluation import evaluate
from rsibr.tests.glsl.principled_inputs import families
from rsibr.tests.glsl.test_live_environment import show, smooth_faces
from rsibr.tests.glsl.test_live_pyramid import FACE, LAMPS, ROUNDED
from rsibr.tests.glsl.twins import AXES, COUNT, ULP, unit_vectors

LIBRARY = "live_pyramid_lib.glsl"


def test_octahedral_direction() -> None:
    uv = np.random.default_rng(4).random((COUNT, 2))
    found = evaluate(LIBRARY, "result_0.xyz = octahedral_direction(in_0.xy);", [uv], 1)[:, 0, :3]
    # A length, and the roundings of uv
    np.testing.assert_allclose(found, octahedral.direction_from_uv(uv), atol=16 * ULP)


def test_bordered_direction() -> None:
    size = 8
    along = np.arange(-1, size + 1)
    column, row = (each.ravel() for each in np.meshgrid(along, along))
    code = "result_0.xyz = bordered_direction(in_0.xy + 0.5, 8.0);"
    found = evaluate(LIBRARY, code, [np.stack([column, row], axis=-1).astype(np.float64)], 1)[:, 0, :3]
    within = np.stack(octahedral.wrap(column, row, size, size), axis=-1)
    np.testing.assert_allclose(found, octahedral.direction_from_uv((within + 0.5) / size), atol=16 * ULP)


def test_sunlit_by_normal() -> None:
    ensure_context()
    live = GpuLivePyramid(FACE, families())
    live.set_lamps(*LAMPS)
    normal = unit_vectors(6, AXES)
    number = 1 + np.arange(len(normal))[:, None] % 5
    ring = np.array([1.0, 1.0, *WIDTHS])[number - 1]
    code = "result_0.rgb = sunlit_by_normal(lookups, int(in_1.x + 0.5), in_2.x, in_0.xyz);"
    textures = {"lookups": ("FLOAT_2D", live.textures[1].whole())}
    given = [normal, number.astype(np.float64), ring]
    found = evaluate(LIBRARY, code, given, 1, textures, defines=(SUNS,))[:, 0, :3]
    *rings, white, leaning = (each.lobe for each in live_maps(FACE).others[-5:])
    for each, lobe in enumerate((white, leaning, *rings), 1):
        some = number[:, 0] == each
        expected = sunlit(lamp_suns(*LAMPS), lobe, normal[some])
        # Single precision; a narrow ring rises a hundredfold within a tenth above the horizon
        assert np.abs(found[some] - expected).max() < 1e-4 * expected.max()


def test_tapped_radiance() -> None:
    ensure_context()
    faces = smooth_faces(FACE)
    live = GpuLivePyramid(FACE, families())
    show(live, faces)
    textures: dict[str, tuple[str, gpu.types.GPUTexture]] = {
        "atlas": ("FLOAT_2D", live._atlas.texture),
        "taps": ("FLOAT_2D", live._taps),
    }
    axis = unit_vectors(5, AXES)
    row = np.arange(len(axis))[:, None] % 2.0
    code = "result_0.rgb = tapped_radiance(atlas, taps, int(in_1.x + 0.5), in_0.xyz);"
    found = evaluate(LIBRARY, code, [axis, row], 1, textures)[:, 0, :3]
    pyramid = live_pyramid(faces)
    for number, source in enumerate((pyramid.mirror, pyramid.maps[-1])):
        expected = tapped(source, live_maps(FACE).others[number].taps, axis[number::2])
        assert np.abs(found[number::2] - expected).max() < ROUNDED
