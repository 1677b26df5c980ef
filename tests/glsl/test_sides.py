"""Every kind of map set shades the outside and the inside of a surface alike, mirrored ones too."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from rsibr.rsibr_addon.core.brdf.principled import Surface
from rsibr.rsibr_addon.core.geometry.camera import Camera
from rsibr.rsibr_addon.core.geometry.lit_sphere import LitSphere
from rsibr.rsibr_addon.core.kinds.environment import EnvironmentLook
from rsibr.rsibr_addon.core.kinds.lobe_stack.shading import StackLook
from rsibr.rsibr_addon.core.kinds.mip_chain.shading import MipLook
from rsibr.rsibr_addon.core.kinds.mip_chain.texture_space import tent_halved
from rsibr.rsibr_addon.core.kinds.radiance_views.shading import Mode, ViewsLook
from rsibr.rsibr_addon.core.kinds.reflection_tables.shading import TablesLook
from rsibr.rsibr_addon.core.kinds.reflection_tables.tables import Role
from rsibr.rsibr_addon.device.kinds.environment import GpuEnvironment
from rsibr.rsibr_addon.device.kinds.kernel_pyramid import GpuPyramid
from rsibr.rsibr_addon.device.kinds.live_environment import GpuLiveEnvironment
from rsibr.rsibr_addon.device.kinds.lobe_stack import GpuLobeStack
from rsibr.rsibr_addon.device.kinds.mip_chain import GpuMipChain
from rsibr.rsibr_addon.device.kinds.radiance_views import GpuRadianceViews
from rsibr.rsibr_addon.device.kinds.reflection_tables import GpuReflectionTables
from rsibr.rsibr_addon.device.lit_sphere import GpuLitSphere
from rsibr.tests.glsl.principled_inputs import families, pyramid
from rsibr.tests.glsl.test_live_environment import show, smooth_faces
from rsibr.tests.glsl.test_mip_chain_preview import smooth_chain
from rsibr.tests.glsl.test_reflection_tables import smooth_tables
from rsibr.tests.lobe_stacks import random_stack
from rsibr.tests.mirror_capture import environment
from rsibr.tests.placed_drawing import MIRRORING, drawn, flat, inside_out, leaf, mirrored, shell
from rsibr.tests.synthetic_views import smooth_views

CAMERA = Camera((0.4, -0.7, 0.7), 0.8)
SIZE = 32


def live_light() -> GpuLiveEnvironment:
    live = GpuLiveEnvironment(16)
    show(live, smooth_faces(16))
    return live


def lit_sphere() -> GpuLitSphere:
    rows, columns = np.meshgrid(np.arange(8) / 8.0, np.arange(16) / 16.0, indexing="ij")
    rings = np.stack([rows, np.sin(2.0 * np.pi * columns) + 1.0, rows * 0.0 + 0.5], axis=-1)
    return GpuLitSphere(LitSphere(CAMERA.frame, rings))


KINDS: dict[str, tuple[Callable[[], Any], Any]] = {
    "environment": (lambda: GpuEnvironment(environment()), EnvironmentLook((0.2, 0.6, 1.0))),
    "mip chain": (lambda: GpuMipChain(smooth_chain(tent_halved)), MipLook(mip=1.0)),
    "live light": (live_light, MipLook(mip=1.0)),
    "tables": (
        lambda: GpuReflectionTables(smooth_tables(1.5)),
        TablesLook((Role.DIFFUSE, Role.SPECULAR, Role.COAT, Role.RETRO)),
    ),
    "lobe stack": (lambda: GpuLobeStack(random_stack("octahedral")), StackLook()),
    "lit sphere": (lit_sphere, None),
    "radiance views": (lambda: GpuRadianceViews(smooth_views(12, 32)), ViewsLook(Mode.FRAGMENT)),
    "destination map": (lambda: GpuRadianceViews(smooth_views(12, 32)), ViewsLook(Mode.TEXEL)),
    "principled": (
        lambda: GpuPyramid(pyramid(), families()),
        Surface(base_color=(0.9, 0.6, 0.3), metallic=0.5, roughness=0.3, coat_weight=0.5),
    ),
}


@pytest.mark.parametrize("name", KINDS)
def test_both_sides_are_shaded_alike(name: str) -> None:
    make, look = KINDS[name]
    content = make()
    for mesh in (leaf(), shell(), flat(leaf())):
        expected = drawn(content, mesh, np.eye(4), CAMERA, SIZE, look)
        assert np.count_nonzero(expected[..., 3]) > 0.15 * SIZE**2
        turned = {
            "inside out": (inside_out(mesh), np.eye(4)),
            "mirrored": (mirrored(mesh), MIRRORING),
            "mirrored inside out": (inside_out(mirrored(mesh)), MIRRORING),
        }
        for way, (other, model) in turned.items():
            found = drawn(content, other, model, CAMERA, SIZE, look)
            # Rounding of places turns facets, and decides on samples at edges and where lookups switch maps
            apart = np.abs(found - expected).max(axis=-1)
            assert np.quantile(apart, 0.99) < 2e-3 * expected.max(), way
            assert np.mean(apart) < 1e-3 * expected.max(), way


def test_a_refraction_is_seen_from_within_with_the_index_the_other_way() -> None:
    look = TablesLook((Role.REFRACTION,))
    outside, inside = smooth_tables(1.5), smooth_tables(1.0 / 1.5)
    seen = drawn(GpuReflectionTables(outside), inside_out(flat(leaf())), np.eye(4), CAMERA, SIZE, look)
    expected = drawn(GpuReflectionTables(inside), flat(leaf()), np.eye(4), CAMERA, SIZE, look)
    assert np.quantile(np.abs(seen - expected).max(axis=-1), 0.99) < 2e-3 * expected.max()
