"""[Miller1984] section 8 as seen: highlights of a small lamp on a wrinkled ball, while the world turns."""

import numpy as np
import pytest
from rsibr.tests.bumpy_sphere import WAYS, flicker, lamp_table, missing, pictures

SIZE = 40
"""Pixels along a side of the picture; one reflects up to ten texels of the table."""

TABLE_HEIGHT = 64


@pytest.fixture(scope="module", params=[1, 3])
def frames(request: pytest.FixtureRequest) -> list[dict[str, np.ndarray]]:
    """Eight frames, a quarter of a texel's turn from one to the next."""
    table = lamp_table(TABLE_HEIGHT, 31, 94, request.param, 1e4)
    return [pictures(table, SIZE, 0.1, 0.25 * np.pi / TABLE_HEIGHT * frame) for frame in range(8)]


@pytest.mark.slow
def test_highlights_do_not_scintillate(frames: list[dict[str, np.ndarray]]) -> None:
    assert flicker(frames, "point") > 0.1
    # The reference's lookups count a lamp of one texel, which some twenty of them find, to 3 %.
    for way in WAYS:
        assert flicker(frames, way) < 0.05


@pytest.mark.slow
def test_highlights_do_not_break_up(frames: list[dict[str, np.ndarray]]) -> None:
    assert missing(frames, "point") > 0.3
    assert [missing(frames, way) for way in WAYS] == [0.0, 0.0, 0.0]
