"""A glass ball before lamps, antialiased, against many lookups a pixel."""

import numpy as np
from rsibr.rsibr_addon.core.antialiased.footprint import pixel_footprints
from rsibr.rsibr_addon.core.geometry.directions import reflect
from rsibr.rsibr_addon.core.kinds.reflection_tables.shading import TablesLook, reflect_tables
from rsibr.rsibr_addon.core.kinds.reflection_tables.tables import ReflectionTables, Role
from rsibr.tests.bumpy_sphere import EYE, SAMPLES, energy, error, wrinkled_normals

ROWS, SIZE = 256, 12
ONES = np.ones((len(Role), 1, 3), dtype=np.float32)


def lamps() -> np.ndarray:
    """Dark but for lamps of two texels behind the ball, and before it."""
    table = np.full((ROWS, 2 * ROWS, 3), 0.02, dtype=np.float32)
    for row, column in ((125, 118), (150, 140), (100, 110), (140, 390), (110, 370)):
        table[row : row + 2, column : column + 2] = 1000.0
    return table


def frame(role: Role, turned: int) -> dict[str, np.ndarray]:
    """Pictures of a table, the world turned by texels."""
    tables = ReflectionTables({role: np.roll(lamps(), turned, axis=1)}, ONES, 1.5)

    def seen(across: np.ndarray, look: TablesLook, footprints: np.ndarray | None = None) -> np.ndarray:
        return reflect_tables(tables, wrinkled_normals(across, 0.0), EYE, look, footprints)

    fine = seen((np.arange(SIZE * SAMPLES) + 0.5) / (SIZE * SAMPLES), TablesLook())
    middles = (np.arange(SIZE) + 0.5) / SIZE
    corners = reflect(EYE, wrinkled_normals(np.arange(SIZE + 1) / SIZE, 0.0))
    return {
        "reference": fine.reshape(SIZE, SAMPLES, SIZE, SAMPLES, 3).mean(axis=(1, 3)),
        "point": seen(middles, TablesLook()),
        "antialiased": seen(middles, TablesLook(), pixel_footprints(corners)),
    }


def test_lamps_in_glass_neither_go_out_nor_shimmer() -> None:
    frames = [frame(Role.REFRACTION, turned) for turned in range(4)]  # by three texels, 2.1 degrees
    assert error(frames, "antialiased") < 0.1 * error(frames, "point")
    # The reference finds a lamp with some fifty of its lookups, and so knows its energy to 3 %
    np.testing.assert_allclose(energy(frames, "antialiased"), 1.0, atol=0.05)
    assert np.ptp(energy(frames, "point")) > 0.5
