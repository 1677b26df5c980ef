"""Functions of gpu_shaders/lib that bring radiance to a display, against their numpy twins."""

import numpy as np
import pytest
from rsibr.rsibr_addon.core.light.transfer_curve import linear_from_srgb
from rsibr.rsibr_addon.core.pictures.display import TABLE_SIZE, displayed, node_from_radiance, node_radiance
from rsibr.rsibr_addon.core.pictures.false_colour import heat
from rsibr.rsibr_addon.device import buffers
from rsibr.tests.glsl.evaluation import Samplers
from rsibr.tests.glsl.twins import COUNT, ULP, Twin, check, single


def colours() -> np.ndarray:
    """Radiance from below black to above the table, shape (COUNT, 3); greys and nodes among it."""
    node = np.random.default_rng(1).uniform(-1.0, TABLE_SIZE + 2.0, (COUNT, 3))
    node[: COUNT // 10] = node[: COUNT // 10, :1]
    node[COUNT // 10 : COUNT // 5] = np.rint(node[COUNT // 10 : COUNT // 5])
    return single(np.concatenate([np.zeros((1, 3)), node_radiance(node[1:])]))


def table() -> np.ndarray:
    """Colours that half floats hold, without any pattern but that neighbours differ by at most 1 / 16."""
    steps = np.random.default_rng(2).integers(0, 65, (TABLE_SIZE, TABLE_SIZE, TABLE_SIZE, 3))
    slope = np.arange(TABLE_SIZE) / 128.0
    return steps / 1024.0 + slope[:, None, None, None] * 0.5 + slope[None, :, None, None] * 0.5


def samplers() -> Samplers:
    return {"display": ("FLOAT_3D", buffers.table_texture(table()))}


TWINS = {
    "node_from_radiance": Twin(
        "display_lib.glsl",
        "result_0.rgb = node_from_radiance(in_0.rgb);",
        lambda: [colours()],
        node_from_radiance,
        # log2 to four units in the last place of up to 8, times five, and the sum's rounding at 95.
        5.0 * 4.0 * 16.0 * ULP + 128.0 * ULP,
    ),
    "displayed": Twin(
        "display_lib.glsl",
        "result_0.rgb = displayed(display, in_0.rgb);",
        lambda: [colours()],
        lambda radiance: displayed(table(), radiance),
        # The node's error times the steepest slope: 1/16 a node, along each of three axes.
        3.0 / 16.0 * (5.0 * 4.0 * 16.0 + 128.0) * ULP + 8.0 * ULP,
        samplers=samplers,
    ),
    "heat": Twin(
        "false_colour_lib.glsl",
        "result_0.rgb = heat(in_0.x);",
        lambda: [single(np.random.default_rng(4).uniform(-0.5, 1.5, (COUNT, 1)))],
        lambda number: heat(number[:, 0]),
        16.0 * ULP,
    ),
    "linear_from_srgb": Twin(
        "transfer_curve_lib.glsl",
        "result_0.rgb = linear_from_srgb(in_0.rgb);",
        lambda: [single(np.random.default_rng(3).random((COUNT, 3)))],
        linear_from_srgb,
        # pow is exp2(2.4 log2): the logarithm's error, four units of up to 4.2, times 2.4, becomes relative.
        4.0 * 8.0 * 2.4 * ULP + 8.0 * ULP,
    ),
}


@pytest.mark.parametrize("twin", TWINS.values(), ids=TWINS.keys())
def test_twin(twin: Twin) -> None:
    check(twin)
