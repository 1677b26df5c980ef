"""Readers of radiance, fed with damage: `python -m rsibr.tests.faults.fuzz_pictures --cases 10000`.

Each case ends in a picture or in one sentence of ours. All else is told, with what makes it again: the
numbers of the seed and of the case.
"""

import random
import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import OpenEXR
from rsibr.rsibr_addon.files.baked_inputs import BakedInputs, is_whole, read_baked_inputs, write_baked_inputs
from rsibr.rsibr_addon.files.environments import read_environment
from rsibr.rsibr_addon.files.kinds.environment import is_environment
from rsibr.rsibr_addon.files.radiance_pictures import describe_radiance, read_radiance
from rsibr.tests.faults.fuzzing import run_cases
from rsibr.tests.faults.mutations import damaged_bytes

SECONDS = 10
"""That no case takes."""

MEGABYTES = 400
"""That no case takes beyond those before: a size that a file of some kilobytes can have is not refused."""

WIDTH, HEIGHT = 32, 16
AP0 = (0.7347, 0.2653, 0.0, 1.0, 0.0001, -0.077, 0.32168, 0.33767)

VALUES = (
    *(
        b"",
        b"0",
        b"-1",
        b"1e999",
        b"-inf",
        b"nan",
        b"1,5",
        b"0x10",
        b"1 2 3",
        b"0 0 0 0 0 0 0 0",
        b"\xff\x00",
    ),
    *(b".64 .33 .3 .6 .15 .06 .3127 .329", b"1 1 1 1 1 1 1 1", b"9" * 400, b"32-bit_rle_xyze", b"32-bit"),
    *(b"-Y 99999999 +X 99999999", b"-Y 1 +X 134217728", b"+X 32 -Y 16", b"\n", b"\r\n\r\n", b"=", b"#"),
)
NAMES = (
    b"EXPOSURE=",
    b"COLORCORR=",
    b"PRIMARIES=",
    b"FORMAT=",
    b"GAMMA =",
    b"PIXASPECT=",
    b"X=",
    b"COMMENTS=",
    b"",
    b"\t",
)


def hdr_files(rng: random.Random) -> list[bytes]:
    """One for each coding."""
    head = b"#?RADIANCE\nEXPOSURE=2\nFORMAT=32-bit_rle_rgbe\n\n-Y %d +X %d\n" % (HEIGHT, WIDTH)
    flat = bytes(rng.randrange(2, 256) for _ in range(4 * WIDTH * HEIGHT))
    older = (bytes([9, 8, 7, 130]) + bytes([1, 1, 1, WIDTH - 1])) * HEIGHT
    newer = (bytes([2, 2, 0, WIDTH]) + bytes([128 + WIDTH, 131]) * 4) * HEIGHT
    return [head + pixels for pixels in (flat, older, newer)]


def exr_files(folder: Path) -> list[bytes]:
    """Storages, layers, parts and luminance with chroma."""
    rgb = np.random.default_rng(0).random((HEIGHT, WIDTH, 3)).astype(np.float32)
    plain = {name: np.ascontiguousarray(rgb[..., i]) for i, name in enumerate("RGB")}
    half = {name: plane.astype(np.float16) for name, plane in plain.items()}
    tiles = OpenEXR.TileDescription()
    tiles.xSize = tiles.ySize = 8
    chroma = {"Y": plain["R"]} | {name: OpenEXR.Channel(name, plain["G"], 2, 2) for name in ("RY", "BY")}
    layers = {f"V.{layer}.{name}": plane for layer in ("Combined", "Sky") for name, plane in plain.items()}
    scanlines = {"type": OpenEXR.scanlineimage, "compression": OpenEXR.ZIP_COMPRESSION}
    files: list[list[tuple[dict, dict]]] = [
        [(scanlines | {"chromaticities": AP0, "pixelAspectRatio": 1.0, "colorInteropID": "data"}, plain)],
        [(scanlines | {"type": OpenEXR.tiledimage, "tiles": tiles}, half)],
        [(scanlines, chroma)],
        [(scanlines, layers)],
        [(scanlines, {"Y": plain["R"]}), (scanlines, plain)],
    ]
    files += [
        [(scanlines | {"compression": getattr(OpenEXR, f"{name}_COMPRESSION")}, half)]
        for name in ("NO", "RLE", "ZIPS", "PIZ", "PXR24", "B44", "DWAA", "DWAB")
    ]
    path = folder / "a.exr"
    written = []
    for parts in files:
        described = [OpenEXR.Part(dict(head), dict(planes), str(i)) for i, (head, planes) in enumerate(parts)]
        OpenEXR.File(described).write(str(path))
        written.append(path.read_bytes())
    corners = np.zeros((5, 2), np.float32)
    pictures = {(0, ("base_color",)): rgb, (1, ("metallic", "roughness")): rgb}
    write_baked_inputs(path, BakedInputs(pictures, corners=corners), force=True)
    return [*written, path.read_bytes()]


def damaged_hdr(data: bytes, rng: random.Random) -> bytes:
    """With other lines in its header, or as any bytes."""
    if rng.random() < 0.4:
        return damaged_bytes(data, rng)
    lines = data.split(b"\n", 5)
    for _ in range(rng.choice((1, 1, 2, 5))):
        line = rng.choice(NAMES) + rng.choice(VALUES)
        lines[rng.randrange(1, len(lines) - 1) :][:1] = [line]
        lines.insert(rng.randrange(1, len(lines) - 1), line)
    return b"\n".join(lines)


def damaged_exr(data: bytes, rng: random.Random) -> bytes:
    """Mostly in its header, which is its first bytes."""
    if rng.random() < 0.5:
        end = min(len(data), 600)
        return damaged_bytes(data[:end], rng) + data[end:]
    return damaged_bytes(data, rng)


def _describe(path: Path) -> None:
    describe_radiance(path)
    is_environment(path)


def _inputs(path: Path) -> None:
    if is_whole(path):
        read_baked_inputs(path)


READERS: tuple[Callable[[Path], object], ...] = (read_radiance, read_environment, _describe, _inputs)


def cases(folder: Path, rng: random.Random) -> Iterator[tuple[Path, Callable[[Path], object]]]:
    """Damaged files without end, and what is to read them."""
    hdr, exr = hdr_files(rng), exr_files(folder)
    path = folder / "damaged.exr"
    while True:
        is_hdr = rng.random() < 0.5
        path.write_bytes(damaged_hdr(rng.choice(hdr), rng) if is_hdr else damaged_exr(rng.choice(exr), rng))
        yield path, rng.choice(READERS)


if __name__ == "__main__":
    sys.exit(run_cases(cases, SECONDS, MEGABYTES))
