"""What antialiased lookup gains on a wrinkled ball and in glass, for docs/antialiased-lookup.md."""

import time
from pathlib import Path

import bpy  # noqa: F401  (before what it brings)
import numpy as np
from docs_table import DOCS, write_table
from rsibr.rsibr_addon.core.antialiased.averaging import Averaging, footprint_mean
from rsibr.rsibr_addon.core.geometry.camera import Camera
from rsibr.rsibr_addon.core.geometry.directions import normalize
from rsibr.rsibr_addon.core.kinds.reflection_tables.bake import TableSizes, bake_tables
from rsibr.rsibr_addon.core.kinds.reflection_tables.material import PRESETS, material_from_texts
from rsibr.rsibr_addon.core.kinds.reflection_tables.shading import TablesLook
from rsibr.rsibr_addon.core.maps import equirect
from rsibr.rsibr_addon.core.progress import drain
from rsibr.rsibr_addon.core.resample import bilinear
from rsibr.rsibr_addon.device.kinds.reflection_tables import GpuReflectionTables
from rsibr.rsibr_addon.device.preview import PreviewRenderer
from rsibr.rsibr_addon.files.brdfs import read_measured
from rsibr.rsibr_addon.host.meshes import load_mesh
from rsibr.rsibr_addon.host.pictures import save_png
from rsibr.tests.bumpy_kinds import KINDS, frames_of
from rsibr.tests.bumpy_sphere import (
    SAMPLES,
    WAYS,
    energy,
    error,
    flicker,
    footprints,
    lamp_table,
    missing,
    pictures,
    supersampled,
)

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
        f"| {np.mean(energy(frames, way)):.2f} | {100.0 * flicker(frames, way):.1f} % "
        f"| {error(frames, way):.2f} |"
        for way in ("point", *WAYS)
    ]


def measured_previews(row: int, lamp: int, wrinkles: float) -> list[str]:
    """The same for the ways that previews have, whose maps are interpolated."""
    table = lamp_table(TABLE_HEIGHT, row, 94, lamp, 1e4)

    def lookup(direction: np.ndarray) -> np.ndarray:
        return bilinear(table, equirect.uv_from_direction(direction), equirect.wrap)

    frames = []
    for number in range(FRAMES):
        turn = 0.25 * np.pi / TABLE_HEIGHT * number
        middle, corners = footprints(40, wrinkles, turn)
        ways = {way.value: footprint_mean(table, middle, corners, way) for way in Averaging}
        frames.append(
            {"reference": supersampled(lookup, 40, wrinkles, turn), "point": lookup(middle), **ways}
        )
    return [
        f"| {NAMES.get(way, way)} | {np.mean(energy(frames, way)):.2f} "
        f"| {100.0 * flicker(frames, way):.1f} % | {error(frames, way):.2f} |"
        for way in ("point", *Averaging)
    ]


GLASS = {"sphere": 512, "monkey": 256}
"""Mesh of a glass object -> rows of its tables."""

GLASS_SIZE, GLASS_TURN, GLASS_FRAMES = 48, np.radians(2.0), 5
GLASS_VIEW = Camera(tuple(normalize(np.array([0.3, -0.9, 0.3]))))


def lamps_behind(rows: int, turn: float) -> np.ndarray:
    """A room with nine lamps of 2 x 2 texels, 5000 times as bright, within 45 degrees of the far end."""
    rng = np.random.default_rng(0)
    table = np.ones((rows, 2 * rows, 3), dtype=np.float32)
    directions = normalize(rng.normal(size=(400, 3)))
    behind = directions[directions @ GLASS_VIEW.view_dir < -np.cos(np.pi / 4.0)][:9]
    for u, v in equirect.uv_from_direction(behind):
        row, column = int(v * rows), int((u + turn / (2.0 * np.pi)) * 2 * rows) % (2 * rows - 2)
        table[row : row + 2, column : column + 2] = 5000.0
    return table


def measured_glass(mesh: str, rows: int) -> list[str]:
    """The rows of a glass object, for every way."""
    shape, material = load_mesh(mesh), material_from_texts(PRESETS["glass"], read_measured)
    looks = {"a single lookup": TablesLook(antialiased=False)}
    looks |= {way.value: TablesLook(averaging=way) for way in Averaging}
    seconds, frames = dict.fromkeys(looks, 0.0), []
    for turn in np.linspace(0.0, GLASS_TURN, GLASS_FRAMES):
        tables = drain(bake_tables(lamps_behind(rows, turn), material, TableSizes())).tables
        renderer = PreviewRenderer(GpuReflectionTables(tables))

        def drawn(size: int, look: TablesLook, renderer: PreviewRenderer = renderer) -> np.ndarray:
            picture = renderer.draw(shape.positions, shape.normals, shape.triangles, GLASS_VIEW, size, look)
            return picture[..., :3].astype(np.float64)

        fine = drawn(GLASS_SIZE * SAMPLES, looks["a single lookup"])
        fine = fine.reshape(GLASS_SIZE, SAMPLES, GLASS_SIZE, SAMPLES, 3).mean(axis=(1, 3))
        frame = {"reference": fine}
        for way, look in looks.items():
            drawn(GLASS_SIZE, look)  # with the program built, and all uploaded
            begin = time.process_time()
            frame[way] = drawn(GLASS_SIZE, look)
            seconds[way] += time.process_time() - begin
        frames.append(frame)
    return [
        f"| {way} | {error(frames, way):.3f} | {100.0 * np.ptp(energy(frames, way)):.1f} % "
        f"| {seconds[way] / seconds['a single lookup']:.1f} |"
        for way in looks
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
    """Measure, and write all."""
    tables = {
        "highlights": (
            ["| lookup | pixels missing | energy | flicker | error |", "|---|---|---|---|---|"],
            measured,
        ),
        "previews": (["| lookup | energy | flicker | error |", "|---|---|---|---|"], measured_previews),
    }
    for name, (lines, of_lamp) in tables.items():
        for lamp, (row, size) in LAMPS.items():
            lines.append(f"| **{lamp}** |" + (lines[0].count("|") - 2) * " |")
            lines += of_lamp(row, size, 0.1 if row < TABLE_HEIGHT // 2 else 0.2)
        write_table("antialiased-lookup.md", name, "\n".join(lines))
    write_table("antialiased-lookup.md", "kinds", "\n".join(measured_kinds()))
    glass = ["| lookup | error | energy varies by | CPU, of a single lookup's |", "|---|---|---|---|"]
    for mesh, rows in GLASS.items():
        glass += [f"| **{mesh}, table of {2 * rows} x {rows}** | | | |", *measured_glass(mesh, rows)]
    write_table("antialiased-lookup.md", "glass", "\n".join(glass))
    picture(DOCS / "images" / "antialiased-lookup.png")


if __name__ == "__main__":
    main()
