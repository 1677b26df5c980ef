"""[Miller1984] section 8 as seen: highlights of a small lamp on a wrinkled ball, while the world turns."""

import numpy as np
import pytest
from rsibr.rsibr_addon.core.antialiased.footprint import footprint_box, pixel_footprints
from rsibr.rsibr_addon.core.antialiased.quadrilateral import quadrilateral_mean
from rsibr.rsibr_addon.core.antialiased.recursive import recursive_mean, table_entry
from rsibr.rsibr_addon.core.antialiased.summed_area import box_mean, summed_area_table
from rsibr.tests.bumpy_sphere import lamp_table, reflected_directions

SIZE = 40
"""Pixels along a side of the picture; one reflects up to ten texels of the table."""

TABLE_HEIGHT = 64
RADIANCE = 1e4
SAMPLES = 16
"""Of the reference, along a side of a pixel."""

WAYS = ("recursive", "quadrilateral", "summed_area")


def pictures(table: np.ndarray, turn: float) -> dict[str, np.ndarray]:
    """A frame by each way, by single lookups, and by 16 x 16 lookups a pixel."""

    def reflected(across: np.ndarray) -> np.ndarray:
        return reflected_directions(across, 0.1, turn)

    def lookup(points: np.ndarray) -> np.ndarray:
        columns, rows = table_entry(table, points)
        return table[rows, columns, 0]

    corners = pixel_footprints(reflected(np.arange(SIZE + 1) / SIZE))
    boxes = footprint_box(corners, 2 * TABLE_HEIGHT, TABLE_HEIGHT)
    many = lookup(reflected((np.arange(SIZE * SAMPLES) + 0.5) / (SIZE * SAMPLES)))
    return {
        "reference": many.reshape(SIZE, SAMPLES, SIZE, SAMPLES).mean(axis=(1, 3)),
        "point": lookup(reflected((np.arange(SIZE) + 0.5) / SIZE)),
        "recursive": recursive_mean(table, corners)[..., 0],
        "quadrilateral": quadrilateral_mean(table, corners)[..., 0],
        "summed_area": box_mean(summed_area_table(table), boxes)[..., 0],
    }


@pytest.fixture(scope="module", params=[1, 3])
def frames(request: pytest.FixtureRequest) -> list[dict[str, np.ndarray]]:
    """Eight frames, a quarter of a texel's turn from one to the next."""
    table = lamp_table(TABLE_HEIGHT, 31, 94, request.param, RADIANCE)
    return [pictures(table, 0.25 * np.pi / TABLE_HEIGHT * frame) for frame in range(8)]


def flicker(frames: list[dict[str, np.ndarray]], way: str) -> float:
    """Relative variation, from frame to frame, of the highlights' energy over the reference's."""
    energy = np.array([frame[way].sum() / frame["reference"].sum() for frame in frames])
    return float(np.std(energy) / np.mean(energy))


def test_highlights_do_not_scintillate(frames: list[dict[str, np.ndarray]]) -> None:
    assert flicker(frames, "point") > 0.1
    # The reference's lookups count a lamp of one texel, which some twenty of them find, to 3 %.
    for way in WAYS:
        assert flicker(frames, way) < 0.05


def test_highlights_do_not_break_up(frames: list[dict[str, np.ndarray]]) -> None:
    def missing(way: str) -> float:
        """Part of the pixels of highlights that this way leaves black."""
        lit = [frame["reference"] > 0.1 * frame["reference"].max() for frame in frames]
        return float(
            np.mean(np.concatenate([frame[way][on] == 0.0 for frame, on in zip(frames, lit, strict=True)]))
        )

    assert missing("point") > 0.3
    assert [missing(way) for way in WAYS] == [0.0, 0.0, 0.0]
