"""What antialiased lookup gains on a wrinkled ball: a table and a picture for docs/antialiased-lookup.md."""

from pathlib import Path

import numpy as np
from docs_table import DOCS, write_table
from rsibr.rsibr_addon.host.pictures import save_png
from rsibr.tests.bumpy_kinds import KINDS, frames_of
from rsibr.tests.bumpy_sphere import WAYS, energy, error, flicker, lamp_table, missing, pictures

TABLE_HEIGHT = 64
FRAMES = 12
LAMPS = {
    "one texel": (31, 1),
    "3 x 3 texels": (31, 3),
    "3 x 3 texels, 10 degrees from a pole": (TABLE_HEIGHT - 5, 3),
}
"""Where a lamp begins, from the bottom, and its size in texels."""

NAMES = {"point": "a single lookup", "summed_area": "summed area"}


def measured(row: int, lamp: int, wrinkles: float) -> list[str]:
    """The table's rows for a lamp, while the world turns by a quarter of a texel a frame."""
    table = lamp_table(TABLE_HEIGHT, row, 94, lamp, 1e4)
    frames = [pictures(table, 40, wrinkles, 0.25 * np.pi / TABLE_HEIGHT * frame) for frame in range(FRAMES)]
    return [
        f"| {NAMES.get(way, way)} | {100.0 * missing(frames, way):.0f} % "
        f"| {np.mean(energy(frames, way)):.2f} | {100.0 * flicker(frames, way):.1f} % |"
        for way in ("point", *WAYS)
    ]


def measured_kinds() -> list[str]:
    """A table of what antialiasing gains in each kind of map set."""
    lines = ["| kind, lookup | pixels missing | energy | flicker | error |", "|---|---|---|---|---|"]
    for kind, shading in KINDS.items():
        frames = frames_of(shading, 40, 6)
        lines += [
            f"| {kind}, {way} | {100.0 * missing(frames, key):.0f} % | {np.mean(energy(frames, key)):.2f} "
            f"| {100.0 * flicker(frames, key):.1f} % | {error(frames, key):.2f} |"
            for way, key in (("single", "point"), ("antialiased", "antialiased"))
        ]
    return lines


def room() -> np.ndarray:
    """Floor, sky and six lamps of 3 x 3 texels that are 5000 times as bright."""
    height = 256
    v = ((np.arange(height) + 0.5) / height)[:, None, None]
    table = np.where(
        v < 0.5, (0.06, 0.05, 0.04), 0.02 + 0.25 * np.clip(v - 0.35, 0.0, 1.0) ** 2 * (0.5, 0.7, 1.0)
    )
    table = np.repeat(table, 2 * height, axis=1)
    for row, column in ((170, 370), (150, 440), (200, 330), (190, 280), (140, 300), (215, 420)):
        table[row : row + 3, column : column + 3] = np.array([250.0, 210.0, 150.0])
    return table


def picture(path: Path) -> None:
    """Two frames, one above the other, each by every way."""
    rows = []
    for turn in (0.0, 0.06):
        frame = pictures(room(), 110, 0.3, turn)
        tiles = [frame[way] for way in ("point", *WAYS, "reference")]
        framed = [np.pad(tile, ((1, 1), (1, 1), (0, 0)), constant_values=1.0) for tile in tiles]
        rows.append(np.concatenate(framed, axis=1))
    image = np.concatenate(rows[::-1]).repeat(2, axis=0).repeat(2, axis=1)
    save_png(path, np.concatenate([image, np.ones_like(image[..., :1])], axis=-1))


def main() -> None:
    """Measure, and write both."""
    head = ["| lookup | pixels missing | energy | flicker |", "|---|---|---|---|"]
    lines = list(head)
    for name, (row, lamp) in LAMPS.items():
        lines += [f"| **{name}** | | | |", *measured(row, lamp, 0.1 if row < TABLE_HEIGHT // 2 else 0.2)]
    print("\n".join(lines))
    write_table("antialiased-lookup.md", "highlights", "\n".join(lines))
    write_table("antialiased-lookup.md", "kinds", "\n".join(measured_kinds()))
    picture(DOCS / "images" / "antialiased-lookup.png")


if __name__ == "__main__":
    main()
