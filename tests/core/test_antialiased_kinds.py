"""Highlights of a small lamp on a wrinkled ball, as each kind of map set shows them while the world turns."""

import numpy as np
import pytest
from rsibr.rsibr_addon.core.directions import normalize
from rsibr.rsibr_addon.core.maps.representation import representation
from rsibr.rsibr_addon.core.mip_chain import MipChain
from rsibr.rsibr_addon.core.mips.texture_space import filtered_mips, tent_halved
from rsibr.rsibr_addon.core.shading.mip_chain import Borders, glossy_mean, glossy_radiance
from rsibr.tests.bumpy_sphere import error, flicker, footprints, missing, supersampled

SIZE = 32
TEXELS = 64
LAMP_DIR = normalize((0.9, -1.0, -0.4))
FRAMES = 4

type Frames = list[dict[str, np.ndarray]]


def turns() -> np.ndarray:
    """A quarter of a texel from frame to frame."""
    return 0.25 * (2.0 / TEXELS) * np.arange(FRAMES)


def mip_chain_frames(wrinkles: float) -> Frames:
    lit = representation("cube_map").texel_directions(TEXELS) @ LAMP_DIR > np.cos(2.0 / TEXELS)
    faces = np.repeat(np.where(lit, 1e4, 0.0)[..., None], 3, axis=-1).astype(np.float32)
    mips = tuple(mip.astype(np.float32) for mip in filtered_mips(faces, tent_halved))
    chain = MipChain(mips, np.zeros((9, 3)))

    def lookup(direction: np.ndarray) -> np.ndarray:
        return glossy_radiance(chain, direction, 0.0, Borders.SEAMLESS)

    frames = []
    for turn in turns():
        middle, corners = footprints(SIZE, wrinkles, turn)
        frames.append(
            {
                "reference": supersampled(lookup, SIZE, wrinkles, turn),
                "point": lookup(middle),
                "antialiased": glossy_mean(chain, middle, corners, 0.0, Borders.SEAMLESS),
            }
        )
    return frames


@pytest.fixture(scope="module", params=[mip_chain_frames], ids=["mip_chain"])
def frames(request: pytest.FixtureRequest) -> Frames:
    return request.param(0.1)


def test_highlights_do_not_scintillate(frames: Frames) -> None:
    assert flicker(frames, "point") > 0.1
    assert flicker(frames, "antialiased") < 0.05


def test_highlights_do_not_break_up(frames: Frames) -> None:
    assert missing(frames, "point") > 0.3
    assert missing(frames, "antialiased") == 0.0


def test_pixels_show_what_they_reflect(frames: Frames) -> None:
    # A single lookup finds a lamp of a pixel's size or less, or misses it.
    assert error(frames, "point") > 0.5
    assert error(frames, "antialiased") < 0.5 * error(frames, "point")
