"""The light of captures: what its kernels see of a sun, against the sum over all texels."""

import numpy as np
from rsibr.rsibr_addon.core.conventions import texel_centres
from rsibr.rsibr_addon.core.geometry.directions import normalize
from rsibr.rsibr_addon.core.kinds.radiance_views.views import RadianceViews
from rsibr.rsibr_addon.core.lobes.bake import sharpest_resolved
from rsibr.rsibr_addon.core.lobes.captured_texels import captured_texels
from rsibr.rsibr_addon.core.maps import equirect, sphere_map
from rsibr.rsibr_addon.tasks.methods.fit_captures import filtered_light

HEIGHT, SUN = 64, (20, 70)
DIRECTIONS = equirect.direction_from_uv(texel_centres(2 * HEIGHT, HEIGHT))


def sunny() -> np.ndarray:
    """Dim light and a sun of one texel, a thousand times as bright."""
    radiance = np.random.default_rng(7).random((HEIGHT, 2 * HEIGHT, 3)).astype(np.float32)
    radiance[SUN] = (1500.0, 1000.0, 700.0)
    return radiance


def test_a_sun_is_seen_as_bright_as_it_is_in_every_direction() -> None:
    radiance, rng = sunny(), np.random.default_rng(8)
    light = filtered_light(radiance)
    assert len(light.suns) == 1
    np.testing.assert_allclose(light.suns.direction[0], DIRECTIONS[SUN], atol=1e-12)
    bank = light.filtered.bank
    spread = rng.normal(size=(40, 3)) * np.geomspace(1e-3, 2.0, 40)[:, None]
    axes = normalize(DIRECTIONS[SUN] + spread)
    chords = 0.25 * np.sum((axes[:, None, None] - DIRECTIONS) ** 2, axis=-1)
    solid_angle = equirect.texel_solid_angle(2 * HEIGHT, HEIGHT)
    weights = bank.values(chords) * np.broadcast_to(solid_angle, chords.shape[1:])[..., None]
    expected = np.einsum("mijk,ijc->mkc", weights, radiance.astype(float))
    seen = light.along(axes).reshape(expected.shape)
    resolved = bank.kappa <= sharpest_resolved(HEIGHT)
    assert not np.all(resolved)
    # The dim rest, and broad kernels, are looked up between texels; sums of single precision
    np.testing.assert_allclose(seen[:, resolved], expected[:, resolved], rtol=0.03)
    # The dim rest of sharper kernels, up to 1, is blurred
    np.testing.assert_allclose(seen[:, ~resolved], expected[:, ~resolved], rtol=0.03, atol=0.3)
    looked_up = light.filtered
    assert looked_up.maps[-1].max() < 0.05 * expected[:, -1].max()  # the sharpest kernel's maps hold no sun


def test_all_texels_that_mirror_a_sun_are_taken() -> None:
    size, count = 32, 12
    views = RadianceViews(*np.zeros((2, count, size, size, 3), np.float32))
    sun = DIRECTIONS[SUN]
    texels = captured_texels(views, count, 500, sun[None])
    inside = np.linalg.norm(2.0 * texel_centres(size, size) - 1.0, axis=-1) < 1.0
    # What is sampled stands for all
    np.testing.assert_allclose(texels.stands_for.sum(), count * inside.sum(), rtol=1e-12)
    taken = texels.stands_for == 1.0
    for view, frame in enumerate(views.frames[:count]):
        mirrored = sphere_map.uv_from_direction(sun @ frame)
        centres = texels.means(texels.normal)[taken & (texels.view == view)] @ frame
        away = np.linalg.norm(0.5 * centres[:, :2] + 0.5 - mirrored, axis=-1) * size
        # Two texels about, and where the disk's rim does not cut them off, at least eight of them
        assert np.all(away < 3.0)
        if np.linalg.norm(2.0 * mirrored - 1.0) < 0.8:
            assert len(away) >= 8
