"""Highlights of a small lamp on a wrinkled ball, as each kind of map set shows them while the lamp moves."""

import numpy as np
import pytest
from rsibr.tests.bumpy_kinds import KINDS, frames_of
from rsibr.tests.bumpy_sphere import energy, error, flicker, missing

Frames = list[dict[str, np.ndarray]]


@pytest.fixture(scope="module", params=KINDS)
def frames(request: pytest.FixtureRequest) -> Frames:
    return frames_of(KINDS[request.param], 20, 3)


@pytest.mark.slow
def test_highlights_do_not_scintillate(frames: Frames) -> None:
    assert np.abs(energy(frames, "point") - 1.0).max() > 0.25
    # Of ways that are exact, 5 % is the reference's own uncertainty: see test_antialiased_highlights.
    assert flicker(frames, "antialiased") < 0.05
    # A few pixels reflect six texels a side, of which `sampling.MOST` lookups find two thirds.
    np.testing.assert_allclose(energy(frames, "antialiased"), 1.0, atol=0.15)


def test_highlights_do_not_break_up(frames: Frames) -> None:
    assert missing(frames, "point") > 0.2
    # Pixels that reflect more than `sampling.MOST` texels may miss it.
    assert missing(frames, "antialiased") < 0.1


def test_pixels_show_what_they_reflect(frames: Frames) -> None:
    # A single lookup finds a lamp of a pixel's size or less, or misses it.
    assert error(frames, "point") > 0.4
    assert error(frames, "antialiased") < 0.4 * error(frames, "point")
