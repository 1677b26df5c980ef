"""What engines show, held to the mips as core has them and to the sum over all texels."""

from collections.abc import Sequence

import numpy as np
from rsibr.rsibr_addon.core.kinds.mip_chain.ggx import ggx_mips
from rsibr.rsibr_addon.core.maps.representation import representation
from rsibr.rsibr_addon.core.resample import lookup
from rsibr.tests.engine_light import cube_directions, from_y_up, sky, truth

SIZE = 64
"""Width of the first mip."""


def directions() -> np.ndarray:
    """Texels of a mip of 8 texels, and places on the cube's edges and near its corners.

    Y is up. At a corner itself SwiftShader takes neither of the three faces.
    """
    texels = cube_directions(8).reshape(-1, 3)
    edges = np.array([(1, 1, 0.3), (-1, 0.2, 1), (0.1, -1, -1), (1, 0.99, 0.98), (-0.98, -0.99, 1)])
    some = np.random.default_rng(8).permutation(len(texels))[:100]
    made = np.concatenate([texels[some], edges])
    return made / np.linalg.norm(made, axis=-1, keepdims=True)


def check_shown(
    radiance: Sequence[object], roughness: list[float], relative: float, between: float = 0.01
) -> None:
    """Hold radiance by roughness and direction to the mips; the median, and eight times looser all.

    `relative` is what the encoding may lose, `between` what a lookup between texels may miss of the light.
    """
    normal = from_y_up(directions())
    mips = ggx_mips(sky(), SIZE, roughness).mips
    for shown, rough, mip in zip(np.array(radiance), roughness, mips, strict=True):
        for wanted, close in (
            (lookup(mip.faces, normal, representation("cube_map")), relative),
            (truth(normal, rough), relative + between),
        ):
            error = np.abs(shown - wanted) / wanted
            assert np.median(error) < close, (rough, np.median(error))
            assert error.max() < 8.0 * close, (rough, error.max())
