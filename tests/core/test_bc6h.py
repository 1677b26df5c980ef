"""BC6H, decoded by OpenImageIO."""

import struct
from pathlib import Path

import numpy as np
import OpenImageIO
import pytest
from rsibr.rsibr_addon.core.bc6h.encode import LARGEST, bc6h_blocks
from rsibr.rsibr_addon.core.bc6h.layout import ANCHORS, MODES, PARTITIONS

RNG = np.random.default_rng(6)


def decoded(blocks: np.ndarray, signed: bool, folder: Path) -> np.ndarray:
    """A texture as OpenImageIO reads it from a DDS file around the blocks."""
    rows, columns = blocks.shape[:2]
    size = (124, 0x81007, 4 * rows, 4 * columns, blocks.nbytes, 0, 1)
    texels = (32, 4, int.from_bytes(b"DX10", "little"), 0, 0, 0, 0, 0)
    head = struct.pack("<4s7I44x8I5I", b"DDS ", *size, *texels, 0x1000, 0, 0, 0, 0)
    path = folder / "blocks.dds"
    path.write_bytes(head + struct.pack("<5I", 96 if signed else 95, 3, 0, 1, 0) + blocks.tobytes())
    picture = OpenImageIO.ImageInput.open(str(path))
    pixels: np.ndarray = picture.read_image(0, 0, 0, 3, "float")
    picture.close()
    return pixels


def mode_of(blocks: np.ndarray) -> np.ndarray:
    """Number of each block's mode, by its lowest bits."""
    lowest = blocks.reshape(-1, 16)[:, 0]
    number = np.full(len(lowest), -1)
    for mode, each in enumerate(MODES):
        bits = sum(bit << place for place, bit in enumerate(each.bits))
        number[(lowest & (1 << len(each.bits)) - 1) == bits] = mode
    return number


def of_two_lines(count: int, contrast: float) -> np.ndarray:
    """A row of blocks with two lines of colours, or one, which lie so many stops apart and are as long."""
    region = PARTITIONS[np.arange(count) % 32] * RNG.integers(0, 2, (count, 1))
    middle = RNG.uniform(-3.0, 3.0, (count, 1, 3)) + contrast * RNG.uniform(-0.5, 0.5, (count, 2, 3))
    along = contrast * RNG.uniform(-0.5, 0.5, (count, 2, 3))
    share = np.rint(RNG.uniform(0.0, 7.0, (count, 16, 1))) / 7.0 - 0.5
    rows = np.arange(count)[:, None]
    stops = middle[rows, region] + share * along[rows, region]
    return (
        np.exp2(np.clip(stops, -14.0, 15.0)).reshape(count, 4, 4, 3).swapaxes(0, 1).reshape(4, 4 * count, 3)
    )


def test_partitions_and_anchors_are_the_format_s() -> None:
    # The first texel is on the first line, an anchor on the second; 32 different ones
    assert np.all(PARTITIONS[:, 0] == 0)
    assert np.all(PARTITIONS[np.arange(32), ANCHORS] == 1)
    assert len(np.unique(PARTITIONS, axis=0)) == 32
    for mode in MODES:
        # A place for each bit of every end, and none twice
        stored = mode.precision if mode.delta is None else mode.delta[0]
        assert len(set(mode.places)) == len(mode.places)
        assert len(mode.bits) + len(mode.places) == (65 if mode.regions == 1 else 77)
        assert stored <= mode.precision


@pytest.mark.parametrize("signed", [False, True])
def test_every_mode_is_read_as_it_was_meant(signed: bool, tmp_path: Path) -> None:
    found = {}
    for contrast in (0.0, 0.01, 0.05, 0.1, 0.2, 0.4, 0.8, 1.5, 3.0, 6.0, 12.0, 24.0):
        texels = of_two_lines(512, contrast) * (RNG.choice([-1.0, 1.0]) if signed else 1.0)
        blocks = bc6h_blocks(texels, signed)
        error = np.abs(decoded(blocks, signed, tmp_path) - texels) / np.abs(texels)
        by_block = error.reshape(4, 512, 4, 3).swapaxes(0, 1).reshape(512, -1)
        for mode in np.unique(mode_of(blocks)):
            found.setdefault(int(mode), []).append(by_block[mode_of(blocks) == mode])
    assert set(found) == set(range(14))
    for mode, errors in found.items():
        # Steps of ends are 2^(11 - precision) of a value, twice that with a sign; a misread bit shows as more
        step = 2.0 ** (11 - MODES[mode].precision + signed)
        assert np.median(np.concatenate(errors)) < max(0.25 * step, 2.0**-8), mode


def test_a_colour_is_kept_and_black_is_black(tmp_path: Path) -> None:
    texels = np.repeat(np.exp2(RNG.uniform(-10.0, 15.0, (8, 1, 3))), 8, axis=1)
    texels[0] = 0.0
    texels[4:] = LARGEST
    found = decoded(bc6h_blocks(texels), False, tmp_path)
    assert np.all(found[0] <= 2.0**-14)
    np.testing.assert_allclose(found[4:], LARGEST, rtol=2.0**-10)


def test_edges_are_padded_with_themselves(tmp_path: Path) -> None:
    texels = np.exp2(RNG.uniform(0.0, 0.05, (2, 2, 3)))
    found = decoded(bc6h_blocks(texels), False, tmp_path)
    np.testing.assert_allclose(found[:2, :2], texels, rtol=0.01)
