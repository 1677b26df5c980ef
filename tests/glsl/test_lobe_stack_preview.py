"""Pictures drawn from lobe stacks against core/kinds/lobe_stack/shading.py at every sample."""

import numpy as np
import pytest
from rsibr.rsibr_addon.core.conventions import texel_centres
from rsibr.rsibr_addon.core.errors import DeviceError, RangeError
from rsibr.rsibr_addon.core.geometry.camera import Camera
from rsibr.rsibr_addon.core.kinds.lobe_stack.shading import StackLook, stack_radiance
from rsibr.rsibr_addon.core.kinds.lobe_stack.stack import LAYOUTS, LobeStack
from rsibr.rsibr_addon.core.lobes.bake import bake_stack
from rsibr.rsibr_addon.core.lobes.bank import KernelBank
from rsibr.rsibr_addon.core.maps import equirect
from rsibr.rsibr_addon.core.progress import drain
from rsibr.rsibr_addon.device.context import ensure_context
from rsibr.rsibr_addon.device.kinds.lobe_stack import GpuLobeStack
from rsibr.rsibr_addon.device.preview import PreviewRenderer
from rsibr.tests.glsl.test_preview_renderer import BY_CAMERA, SIZE, SPHERE, reference_pixels
from rsibr.tests.lobe_stacks import random_fit, random_stack


def smooth_stack(layout: str, brightness: float = 1.0) -> LobeStack:
    direction = equirect.direction_from_uv(texel_centres(64, 32))
    radiance = brightness * np.exp(
        direction @ np.array([[0.5, -0.3, 0.9], [0.2, 0.8, -0.1], [-0.4, 0.3, 0.6]])
    )
    fit = random_fit(KernelBank((0.5, 4.0, 16.0)))
    return drain(bake_stack(radiance, fit, layout, 32)).stack


@pytest.fixture(scope="module", params=LAYOUTS)
def smooth(request: pytest.FixtureRequest) -> tuple[LobeStack, PreviewRenderer]:
    ensure_context()
    stack = smooth_stack(request.param)
    return stack, PreviewRenderer(GpuLobeStack(stack))


def reference(stack: LobeStack, camera: Camera, look: StackLook) -> tuple[np.ndarray, np.ndarray]:
    """Radiance of every pixel, and those all of whose samples see the sphere at n.v > 0.2."""
    return reference_pixels(
        camera, lambda normal, view_dir, seen: stack_radiance(stack, normal, view_dir, look, seen)
    )


@pytest.mark.parametrize("lobes", [(), (1,)])
@BY_CAMERA
def test_a_picture_is_what_the_reference_says(smooth, lobes: tuple[int, ...], camera: Camera) -> None:
    stack, renderer = smooth
    expected, inside = reference(stack, camera, StackLook(lobes))
    picture = renderer.draw(*SPHERE, camera, SIZE, StackLook(lobes))
    assert np.all(picture[inside, 3] == 1.0)
    assert np.count_nonzero(inside) > 0.6 * SIZE**2
    # Half floats keep 11 bits; facets turn mirror directions by 4e-4; weights of texels and slices may be
    # rounded to 8 bits, 3 / 512 of what neighbours differ by, a tenth of the peak.
    assert np.abs(picture[..., :3] - expected)[inside].max() < 2e-3 * expected.max()


def test_light_beyond_half_floats_is_kept() -> None:
    ensure_context()
    stack = smooth_stack("octahedral", 1e6)
    assert stack.maps.max() > 65504.0
    camera = Camera((0.0, -1.0, 0.2))
    expected, inside = reference(stack, camera, StackLook())
    picture = PreviewRenderer(GpuLobeStack(stack)).draw(*SPHERE, camera, SIZE, StackLook())
    assert np.abs(picture[..., :3] - expected)[inside].max() < 2e-3 * expected.max()


def test_lobes_add_up_and_are_kept(smooth) -> None:
    stack, _ = smooth
    gpu_map_set = GpuLobeStack(stack)
    renderer = PreviewRenderer(gpu_map_set)
    camera = Camera((0.3, -1.0, 0.2))
    looks = [StackLook(), StackLook((0,)), StackLook((1,))]
    whole, *single = [renderer.draw(*SPHERE, camera, SIZE, look)[..., :3] for look in looks]
    more = sum(single) - whole
    # A signed lobe is cut off at 0 where it is alone, so that single lobes add up to the whole or to more.
    assert more.min() > -1e-5
    assert np.quantile(more, 0.5) < 1e-5
    assert whole.max() > 0.5
    kept = dict(gpu_map_set._elevations)
    for look in looks:
        renderer.draw(*SPHERE, camera, SIZE, look)
    assert gpu_map_set._elevations == kept


def test_a_lobe_that_is_not_there_is_refused(smooth) -> None:
    _, renderer = smooth
    with pytest.raises(RangeError, match="no lobe 2: choose from 0 to 1"):
        renderer.draw(*SPHERE, Camera((0.0, -1.0, 0.0)), SIZE, StackLook((2,)))


def test_too_many_maps_are_refused() -> None:
    ensure_context()
    small = random_stack("dual_paraboloid", 2)
    many = {
        name: np.repeat(getattr(small, name), 100, axis=0)
        for name in ("maps", "scale", "offsets", "taps", "albedo")
    }
    with pytest.raises(DeviceError, match="3000 maps do not fit into a texture of 2048: fit fewer"):
        GpuLobeStack(LobeStack(layout=small.layout, mu=small.mu, **many))
