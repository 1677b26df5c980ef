"""Textures that come to the GPU piece by piece hold what those have that came at once."""

from typing import Any

import gpu
import numpy as np
import pytest
from rsibr.rsibr_addon.core.errors import DeviceError
from rsibr.rsibr_addon.device.context import ensure_context
from rsibr.rsibr_addon.device.textures import GpuTexture
from rsibr.tests.glsl.evaluation import evaluate

HEIGHT, WIDTH, LAYERS = 7, 5, 6
ROW = 16 * WIDTH


def values(*layers: int) -> np.ndarray:
    """Numbers that half floats hold, all different."""
    shape = (*layers, HEIGHT, WIDTH, 4)
    return np.arange(np.prod(shape), dtype=np.float32).reshape(shape) / 4.0


def texels(texture: GpuTexture, sampler: str, layers: int) -> np.ndarray:
    """What a shader fetches, texel by texel."""
    layer, row, column = np.meshgrid(*map(np.arange, (layers, HEIGHT, WIDTH)), indexing="ij")
    place = "ivec2(in_0.xy)" if sampler == "FLOAT_2D" else "ivec3(in_0.xyz)"
    where = np.stack([column, row, layer], axis=-1).reshape(-1, 3)
    code, samplers = f"result_0 = texelFetch(values, {place}, 0);", {"values": (sampler, texture.whole())}
    return evaluate("cube_map_lib.glsl", code, [where], samplers=samplers)


@pytest.mark.parametrize("most", [1, ROW, 3 * ROW, 10 * ROW, 10**6])
@pytest.mark.parametrize(
    ("layers", "sampler", "options"),
    [
        ((), "FLOAT_2D", {}),
        ((LAYERS,), "FLOAT_2D_ARRAY", {}),
        ((LAYERS,), "FLOAT_3D", {"deep": True}),
        ((LAYERS,), "FLOAT_3D", {"deep": True, "texel_format": "RGBA16F"}),
    ],
)
def test_pieces_make_the_whole(
    most: int, layers: tuple[int, ...], sampler: str, options: dict[str, Any]
) -> None:
    ensure_context()
    given = values(*layers)
    texture, taken = GpuTexture("map", given, **options), []
    gpu.state.depth_test_set("LESS")  # as Blender may have left it
    gpu.state.blend_set("ALPHA")
    while not texture.is_whole:
        taken.append(texture.upload(most))
    assert (gpu.state.depth_test_get(), gpu.state.blend_get()) == ("LESS", "ALPHA")
    gpu.state.depth_test_set("NONE")
    gpu.state.blend_set("NONE")
    assert sum(taken) == given.nbytes
    assert max(taken) <= max(most, ROW)
    assert texture.upload(most) == 0
    read = texels(texture, sampler, max(given.ndim > 3 and LAYERS, 1))
    np.testing.assert_array_equal(read.reshape(given.shape), given)


def test_what_was_begun_in_pieces_is_whole_when_it_is_drawn() -> None:
    ensure_context()
    texture = GpuTexture("map", values())
    texture.upload(2 * ROW)
    assert not texture.is_whole
    np.testing.assert_array_equal(texels(texture, "FLOAT_2D", 1).reshape(values().shape), values())
    assert texture.is_whole


def test_what_no_device_takes_is_refused_by_its_name() -> None:
    ensure_context()
    wide = gpu.capabilities.max_texture_size_get() + 1
    with pytest.raises(DeviceError, match=f"The moon takes a texture {wide} wide"):
        GpuTexture("moon", np.zeros((1, wide, 4))).upload(1000)
