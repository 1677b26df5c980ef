"""Readers of photographs, measurements and exposure times, fed with damage.

`python -m rsibr.tests.faults.fuzz_photographs --cases 1000`: each case ends in a result or in a sentence, our
error, and prints nothing. All else is told, with the numbers of the seed and of the case.
"""

import itertools
import random
import sys
from collections.abc import Iterator
from pathlib import Path

import numpy as np
from rsibr.rsibr_addon.files.cornell import read_cornell
from rsibr.rsibr_addon.files.exif import read_exposure
from rsibr.rsibr_addon.files.exposure_times import read_times
from rsibr.rsibr_addon.files.merl import read_merl
from rsibr.rsibr_addon.files.photographs import read_photograph
from rsibr.rsibr_addon.files.rgl import read_rgl
from rsibr.tests.faults.fuzzing import Reader, run_cases
from rsibr.tests.faults.mutations import damaged_bytes
from rsibr.tests.files.test_rgl import tensor_file
from rsibr.tests.written_pictures import (
    APERTURE,
    EXPOSURE_TIME,
    F_NUMBER,
    ISO,
    ORIENTATION,
    P3,
    SHUTTER,
    SRGB,
    add_exif,
    profile,
    write_picture,
    write_png,
)

SECONDS = 10
"""That no case takes."""

WHOLE = 0.02
"""Share of measurements that are as large as published ones."""

NUMBERS = (0, 1, 2, 6, 8, 9, 255, 65534, 65535)
FRACTIONS = ((0, 0), (0, 1), (1, 0), (1, 40), (2**31 - 1, 1), (1, 2**31 - 1), (3, 7))


def _radiance(path: Path) -> None:
    light = read_photograph(path).radiance()
    assert light.dtype == np.float32
    assert light.shape[2] == 3


def pictures(folder: Path) -> list[Path]:
    """Small whole pictures of every kind."""
    rng = np.random.default_rng(0)
    pixels = rng.integers(0, 255, (12, 20, 4), dtype=np.uint8, endpoint=True)
    for ending in ("jpg", "png", "webp", "tif", "bmp", "tga", "gif", "sgi", "jp2", "jxl"):
        write_picture(folder / f"a.{ending}", pixels if ending in ("png", "tga") else pixels[..., :3])
    for name in ("b.jpg", "b.png", "b.tif"):
        write_picture(folder / name, pixels[..., :3], ICCProfile=profile(P3, SRGB))
    write_picture(folder / "c.tif", rng.random((12, 20, 3), dtype=np.float32))
    chunks = (b"gAMA", bytes((0, 1, 134, 160))), (b"cHRM", bytes(range(32))), (b"cICP", bytes((12, 13, 0, 1)))
    write_png(folder / "c.png", pixels[..., :3].astype(np.uint16), *chunks)
    return sorted(folder.iterdir())


def measurements(folder: Path, lights: int, texels: int, merl: int) -> dict[Path, Reader]:
    """Whole measurements and lists, and what reads them.

    Parameters
    ----------
    folder : Path
    lights : int
        Of a Cornell file, for each of four azimuths.
    texels : int
        Width of an RGL file's pictures.
    merl : int
        Numbers of a MERL file that are there.
    """
    rng = np.random.default_rng(0)
    scattered = itertools.product(np.linspace(0.2, 1.2, lights), (0.0, 1.0, 2.0, 3.1))
    angles = np.array([[0.3, 0.0, *each] for each in scattered])
    rows = np.column_stack([angles, rng.random((4 * lights, 4))])
    text = "\n".join(" ".join(f"{number:.4f}" for number in row) for row in rows)
    fields = {
        "phi_i": np.zeros(1, np.float32),
        "theta_i": np.linspace(0.0, 1.5, 4, dtype=np.float32),
        "sigma": np.ones((2, 16), np.float32),
        "ndf": np.full((2, 16), 0.3, np.float32),
        "vndf": rng.random((1, 4, texels + 3, texels + 2), np.float32),
        "rgb": rng.random((1, 4, 3, texels - 1, texels), np.float32),
        "jacobian": np.ones(1, np.uint8),
    }
    written = {
        "a.brdf": (f"# Cornell\n4\n400 500\n600 700\n{text}\n".encode(), read_cornell),
        "a.bsdf": (tensor_file(fields), read_rgl),
        "a.binary": (np.array([90, 90, 180], "<i4").tobytes() + rng.random(merl).tobytes(), read_merl),
        "a.txt": (b'# seconds\n1/30, 0.5\n"2";1 / 4 s\r\n', read_times),
    }
    for name, (data, _) in written.items():
        (folder / name).write_bytes(data)
    return {folder / name: read for name, (_, read) in written.items()}


def cases(folder: Path, rng: random.Random) -> Iterator[tuple[Path, Reader]]:
    """Damaged files without end, and what is to read them."""
    photographs = [(path.name, path.read_bytes()) for path in pictures(folder)]
    small, whole = (
        [(path.name, path.read_bytes(), read) for path, read in measurements(folder, *sizes).items()]
        for sizes in ((3, 6, 100), (360, 256, 3 * 90 * 90 * 180))
    )
    while True:
        if rng.random() < 0.25:
            name, data, read = rng.choice(whole if rng.random() < WHOLE else small)
        else:
            (name, data), read = rng.choice(photographs), rng.choice((_radiance, _radiance, read_exposure))
        damaged = folder / f"damaged-{name}"
        damaged.write_bytes(data)
        if damaged.suffix in (".jpg", ".png", ".webp") and rng.random() < 0.3:
            numbers = {rng.choice((ORIENTATION, ISO)): rng.choice(NUMBERS)}
            for tag in rng.sample((EXPOSURE_TIME, F_NUMBER, SHUTTER, APERTURE), 3):
                numbers[tag] = rng.choice(FRACTIONS)
            add_exif(damaged, numbers, rng.choice("<>"))
        if rng.random() < 0.9:
            damaged.write_bytes(damaged_bytes(damaged.read_bytes(), rng))
        yield damaged, read


if __name__ == "__main__":
    sys.exit(run_cases(cases, SECONDS))
