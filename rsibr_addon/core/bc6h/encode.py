"""Radiance to blocks of BC6H."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..conventions import Array, Indices
from .layout import ANCHORS, MODES, PARTITIONS, WEIGHTS, Mode, packed

LARGEST = 65504.0
"""The largest value, that of half floats."""

DARKEST = 2.0**-14
"""The least value of full precision; steps between darker ones are as wide."""

AT_ONCE = 4096
"""Blocks at a time, so that what is made of them stays in the processor's memory."""

TRIED = 4
"""Partitions that are tried for each block."""

ROUNDS = 3
"""Times that a line is fitted to texels as they were placed on the one before."""

NEAR = 60.0
"""Distance of a texel from its line within which it does not matter, of about a thousandth of its value."""


def bc6h_blocks(texels: Array, signed: bool = False) -> Indices:
    """Compress a texture.

    Parameters
    ----------
    texels : ndarray, shape (height, width, 3)
        From 0, if `signed` from -`LARGEST`, to `LARGEST`; row 0 is that of the first blocks.
    signed : bool
        Whether values may be negative; they keep a bit less then.

    Returns
    -------
    ndarray, shape (ceil(height / 4), ceil(width / 4), 16), uint8

    Notes
    -----
    Lines are fitted to most texels, in the whole numbers that the format interpolates. Each block takes
    whichever is closer: one line with 16 places, or the best of a few partitions into two lines with 8, each
    with as many bits for its ends as their distance allows.
    """
    height, width = texels.shape[:2]
    edges = ((0, -height % 4), (0, -width % 4), (0, 0))
    padded = np.pad(_numbers(texels, signed), edges, mode="edge")
    rows, columns = padded.shape[0] // 4, padded.shape[1] // 4
    blocks = padded.reshape(rows, 4, columns, 4, 3).swapaxes(1, 2).reshape(-1, 16, 3)
    made = [_compressed(blocks[at : at + AT_ONCE], signed) for at in range(0, len(blocks), AT_ONCE)]
    return np.concatenate(made).reshape(rows, columns, 16)


def _numbers(texels: Array, signed: bool) -> Array:
    """Values as the format interpolates them: the bits of half floats, spread over 16 bits."""
    half = texels.astype(np.float16)
    bits = (half.view(np.uint16) & 0x7FFF).astype(np.float32)
    return (
        np.copysign(bits * np.float32(32 / 31), half.astype(np.float32))
        if signed
        else bits * np.float32(64 / 31)
    )


@dataclass(frozen=True)
class _Fit:
    """Lines through blocks.

    Attributes
    ----------
    ends : ndarray, shape (n, 4, 3)
        Of the first line, then of the second.
    partition : ndarray, shape (n,)
    regions : int
    """

    ends: Array
    partition: Indices
    regions: int

    @property
    def region(self) -> Indices:
        """The line of each texel, shape (n, 16)."""
        lines = PARTITIONS[self.partition]
        return lines if self.regions == 2 else np.zeros_like(lines)


@dataclass(frozen=True)
class _Coded:
    """Blocks as they will be stored: see `packed`; and the sums of their texels' distances."""

    mode: Indices
    ends: Indices
    partition: Indices
    index: Indices
    error: Array


def _compressed(blocks: Array, signed: bool) -> Indices:
    none = np.zeros(len(blocks), np.intp)
    best = _coded(blocks, _fitted(blocks, none, 1), signed)
    for partition in _promising(blocks):
        other = _coded(blocks, _fitted(blocks, partition, 2), signed)
        closer = other.error < best.error
        best = _Coded(*(_where(closer, getattr(other, each), getattr(best, each)) for each in _FIELDS))
    made = np.empty((len(blocks), 16), np.uint8)
    for number, mode in enumerate(MODES):
        of = np.flatnonzero(best.mode == number)
        made[of] = packed(mode, best.ends[of], best.partition[of], best.index[of])
    return made


_FIELDS = ("mode", "ends", "partition", "index", "error")


def _where(which: Any, one: Any, other: Any) -> Any:
    return np.where(which.reshape(-1, *[1] * (one.ndim - 1)), one, other)


def _promising(blocks: Array) -> Iterator[Indices]:
    """The partitions whose lines miss their texels least, the best first, for each block."""
    count = PARTITIONS.sum(axis=1).astype(np.float32)
    centred = blocks - blocks.mean(axis=1, keepdims=True)
    products = centred[..., (0, 0, 0, 1, 1, 2)] * centred[..., (0, 1, 2, 1, 2, 2)]
    features = np.concatenate([centred, products], axis=-1)
    second = np.einsum("pt,btf->bpf", PARTITIONS.astype(np.float32), features, optimize=True)
    whole = features.sum(axis=1)[:, None]
    missed = sum(_missed(part, n) for part, n in ((second, count), (whole - second, 16.0 - count)))
    yield from np.argsort(missed, axis=1)[:, :TRIED].T


def _missed(sums: Array, count: Array) -> Array:
    """Squared distance of texels from their line, and what eight places along it leave, by sums over them."""
    x, y, z, xx, xy, xz, yy, yz, zz = np.moveaxis(sums, -1, 0)
    xx, yy, zz = xx - x * x / count, yy - y * y / count, zz - z * z / count
    xy, xz, yz = xy - x * y / count, xz - x * z / count, yz - y * z / count
    total = xx + yy + zz
    # The largest eigenvalue of the covariance, in closed form
    q = total / 3.0
    p = np.sqrt(((xx - q) ** 2 + (yy - q) ** 2 + (zz - q) ** 2 + 2.0 * (xy**2 + xz**2 + yz**2)) / 6.0) + 1e-6
    a, b, c, d, e, f = (xx - q) / p, (yy - q) / p, (zz - q) / p, xy / p, xz / p, yz / p
    determinant = a * (b * c - f * f) - d * (d * c - f * e) + e * (d * f - b * e)
    largest = q + 2.0 * p * np.cos(np.arccos(np.clip(0.5 * determinant, -1.0, 1.0)) / 3.0)
    missed: Array = total - largest * (1.0 - 1.0 / 49.0)
    return missed


def _fitted(blocks: Array, partition: Indices, regions: int) -> _Fit:
    """The lines that are closest to most texels of a block."""
    fit = _Fit(np.empty((len(blocks), 4, 3), np.float32), partition, regions)
    region = fit.region
    steps = len(WEIGHTS[regions]) - 1
    for line in range(regions):
        on_line = (region == line).astype(np.float32)
        start, end = _extent(blocks, on_line)
        for _ in range(ROUNDS):
            share = _share(blocks, start, end, steps)
            start, end = _closer(blocks, start, end, share, on_line)
        # The anchor has to be in the first half
        anchor = np.zeros(len(blocks), np.intp) if line == 0 else ANCHORS[partition]
        swapped = np.take_along_axis(_share(blocks, start, end, steps), anchor[:, None], axis=1) > 0.5
        fit.ends[:, 2 * line] = np.where(swapped, end, start)
        fit.ends[:, 2 * line + 1] = np.where(swapped, start, end)
    if regions == 1:
        fit.ends[:, 2:] = fit.ends[:, :2]
    return fit


def _extent(blocks: Array, on_line: Array) -> tuple[Array, Array]:
    """Ends of the texels' largest extent."""
    mean = np.einsum("bt,btc->bc", on_line, blocks) / on_line.sum(axis=1, keepdims=True)
    apart = (blocks - mean[:, None]) * on_line[..., None]
    along = _axis(apart)
    place = np.einsum("btc,bc->bt", apart, along)
    low, high = place.min(axis=1, keepdims=True), place.max(axis=1, keepdims=True)
    return mean + low * along, mean + high * along


def _share(blocks: Array, start: Array, end: Array, steps: int) -> Array:
    """The nearest place on a line of all texels, from 0 to 1."""
    along = end - start
    length = np.maximum(np.einsum("bc,bc->b", along, along), 1e-6)
    share = np.einsum("btc,bc->bt", blocks - start[:, None], along / length[:, None])
    nearest: Array = np.clip(np.rint(share * steps), 0.0, steps) / np.float32(steps)
    return nearest


def _closer(blocks: Array, start: Array, end: Array, share: Array, on_line: Array) -> tuple[Array, Array]:
    """The ends of a line through texels at given places: least sum of distances, by reweighted squares."""
    missed = blocks - (start[:, None] + share[..., None] * (end - start)[:, None])
    weight = on_line / np.maximum(np.sqrt(np.einsum("btc,btc->bt", missed, missed)), NEAR)
    of_end, of_start = share * weight, (1.0 - share) * weight
    aa, ab, bb = (
        (one * other).sum(axis=1)
        for one, other in (((1.0 - share), of_start), (share, of_start), (share, of_end))
    )
    determinant = aa * bb - ab * ab
    solvable = determinant > 1e-3 * weight.sum(axis=1) ** 2 / 16.0
    per = np.where(solvable, 1.0 / np.where(solvable, determinant, 1.0), 0.0)[:, None]
    ay, by = (np.einsum("bt,btc->bc", each, blocks) for each in (of_start, of_end))
    aa, ab, bb, solvable = (each[:, None] for each in (aa, ab, bb, solvable))
    return (
        np.where(solvable, (ay * bb - by * ab) * per, start),
        np.where(solvable, (by * aa - ay * ab) * per, end),
    )


def _axis(apart: Array) -> Array:
    """Direction of the largest extent of points about 0, by powers of their covariance."""
    covariance = np.einsum("bti,btj->bij", apart, apart)
    row = np.argmax(np.einsum("bii->bi", covariance), axis=1)
    along = np.take_along_axis(covariance, row[:, None, None], axis=1)[:, 0]
    for _ in range(4):
        along = along / np.maximum(np.linalg.norm(along, axis=1, keepdims=True), 1e-12)
        along = np.einsum("bij,bj->bi", covariance, along)
    unit: Array = along / np.maximum(np.linalg.norm(along, axis=1, keepdims=True), 1e-12)
    return unit


def _coded(blocks: Array, fit: _Fit, signed: bool) -> _Coded:
    """Ends with as many bits as their mode can have, and each texel's nearest place."""
    chosen = np.full(len(blocks), -1)
    quantised = np.zeros(fit.ends.shape, np.int32)
    restored = np.zeros(fit.ends.shape, np.float32)
    for number in _BY_PRECISION[fit.regions]:
        mode = MODES[number]
        left = np.flatnonzero(chosen < 0)
        ends = _quantised(fit.ends[left], mode.precision, signed)
        fits = _fits(ends, mode)
        of = left[fits]
        chosen[of], quantised[of] = number, ends[fits]
        restored[of] = _restored(ends[fits], mode.precision, signed)
    index, error = _indexed(blocks, fit, restored)
    stored = quantised.copy()
    differs = np.array([mode.delta is not None for mode in MODES])[chosen]
    stored[differs, 1:] -= quantised[differs, :1]
    return _Coded(chosen, stored, fit.partition, index, error)


_BY_PRECISION = {
    regions: sorted(
        (number for number, mode in enumerate(MODES) if mode.regions == regions),
        key=lambda number: (MODES[number].delta is None, -MODES[number].precision),
    )
    for regions in (1, 2)
}
"""Number of lines -> modes, those with the most bits first; the last takes any ends."""


def _fits(ends: Indices, mode: Mode) -> Any:
    if mode.delta is None:
        return np.ones(len(ends), bool)
    room = 1 << np.array(mode.delta) - 1
    apart = ends[:, 1:] - ends[:, :1]
    return np.all((apart >= -room) & (apart < room), axis=(1, 2))


def _quantised(ends: Array, precision: int, signed: bool) -> Indices:
    if precision == 16:
        low, high = (-32767, 32767) if signed else (0, 65535)
        return np.clip(np.rint(ends), low, high).astype(np.int32)
    step, most = 2.0 ** (16 - precision), (1 << precision - signed) - 1
    magnitude = np.minimum(np.floor(np.abs(ends) / step), most)
    return (np.sign(ends) * magnitude if signed else np.where(ends > 0.0, magnitude, 0.0)).astype(np.int32)


def _restored(ends: Indices, precision: int, signed: bool) -> Array:
    """Ends as a decoder makes them of their bits."""
    if precision == 16:
        return ends.astype(np.float32)
    magnitude = np.abs(ends)
    most = (1 << precision - signed) - 1
    spread = ((magnitude << 15) + 0x4000) >> precision - 1
    spread = np.where(magnitude == 0, 0, np.where(magnitude >= most, 0x7FFF if signed else 0xFFFF, spread))
    restored: Array = (np.sign(ends) * spread).astype(np.float32)
    return restored


def _indexed(blocks: Array, fit: _Fit, ends: Array) -> tuple[Indices, Array]:
    """The place of each texel on its line, and the sum of each block's distances."""
    weights = WEIGHTS[fit.regions].astype(np.float32) / 64.0
    steps = len(weights) - 1
    region = fit.region
    start, along = ends[:, 0::2], ends[:, 1::2] - ends[:, 0::2]
    along = np.take_along_axis(along, region[..., None], axis=1)
    apart = blocks - np.take_along_axis(start, region[..., None], axis=1)
    length = np.maximum(np.einsum("btc,btc->bt", along, along), 1e-6)
    share = np.einsum("btc,btc->bt", apart, along) / length
    index = np.clip(np.rint(share * steps), 0, steps).astype(np.int32)
    half = len(weights) // 2 - 1
    index[:, 0] = np.minimum(index[:, 0], half)
    if fit.regions == 2:
        rows, anchor = np.arange(len(blocks)), ANCHORS[fit.partition]
        index[rows, anchor] = np.minimum(index[rows, anchor], half)
    missed = apart - weights[index][..., None] * along
    return index, np.sqrt(np.einsum("btc,btc->bt", missed, missed)).sum(axis=1)
