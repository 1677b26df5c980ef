"""Shading from a lobe stack [Kautz2000]: a sum of lookups along the axes of lobes."""

from dataclasses import dataclass

import numpy as np

from ...antialiased.footprint import footprint_or_point, footprint_sides
from ...antialiased.sampling import sample_counts, samples
from ...conventions import Array, ArrayLike, Indices
from ...errors import RangeError
from ...geometry.directions import dot, reflect
from ...geometry.sides import seen_surface
from ...lobes.fit import lobe_axes
from ...options import Choice, Options, option
from ...resample import lookup
from ..look_options import antialiased_option
from .stack import LobeStack


@dataclass(frozen=True)
class StackLook(Options):
    """How a lobe stack is shaded."""

    lobes: tuple[int, ...] = option(
        (),
        label="Lobe",
        help="Numbers of the lobes that are shown, from 0",
        least=0,
        soft_most=7,
        none="all",
        switch=Choice("Single Lobe", "Show one of the lobes that the material is a sum of"),
        metavar="NUMBERS",
    )
    antialiased: bool = antialiased_option("light")

    def shown(self, stack: LobeStack) -> tuple[int, ...]:
        """The lobes that are shown.

        Raises
        ------
        RangeError
            The stack has no such lobe.
        """
        count = len(stack.maps)
        for lobe in self.lobes:
            if not 0 <= lobe < count:
                raise RangeError(f"This stack has no lobe {lobe}: choose from 0 to {count - 1}.")
        return self.lobes or tuple(range(count))


def stack_radiance(
    stack: LobeStack,
    normal: ArrayLike,
    view_dir: ArrayLike,
    look: StackLook,
    mirror_footprint: ArrayLike | None = None,
    facet: ArrayLike | None = None,
) -> Array:
    """Radiance of surface points: [Kautz2000] section 5.3; 0 where signed lobes sum to less.

    Parameters and result are those of every kind's shading: see `core.kinds`.

    Raises
    ------
    RangeError
        See `StackLook.shown`.

    Notes
    -----
    The paper's texture coordinates are those of the mirror direction with an angle added. A rotated vector
    instead keeps lobes radially symmetric, and lets the offset vanish smoothly where the view is along the
    normal. The maps of two elevations are both looked up along the same, interpolated axis, as in a 3D
    texture: a lobe then moves between its two places instead of appearing in both. Within a pixel only the
    mirror direction changes: up to `sampling.MOST` lookups along each side, a texel apart. GLSL twin:
    gpu_shaders/lobe_stack_frag.glsl; with half-float maps, within 2e-3 of the peak.
    """
    normal, view_dir = np.broadcast_arrays(np.asarray(normal, np.float64), np.asarray(view_dir, np.float64))
    normal = seen_surface(normal, view_dir, facet).mirror_normal
    mirror_dir = reflect(view_dir, normal)
    below, share = stack.elevation(dot(normal, view_dir))
    across, up = footprint_sides(
        footprint_or_point(mirror_footprint if look.antialiased else None, mirror_dir)
    )
    counts = sample_counts(across, up, stack.texel_angle(mirror_dir))
    radiance = np.zeros(normal.shape)
    for chosen, direction, weight in samples(mirror_dir, across, up, counts):
        elevation = below[chosen], share[chosen]
        radiance[chosen] += weight * _mirrored(stack, look, normal[chosen], direction, *elevation)
    return radiance


def _mirrored(
    stack: LobeStack, look: StackLook, normal: Array, mirror_dir: Array, below: Indices, share: Array
) -> Array:
    """Radiance of points by given mirror directions, at given elevations, shape (..., 3)."""
    above = np.minimum(below + 1, len(stack.mu) - 1)
    radiance = np.zeros(normal.shape)
    for lobe in look.shown(stack):
        scale, offsets, taps = (
            _between(table[lobe], below, above, share) for table in (stack.scale, stack.offsets, stack.taps)
        )
        axes = lobe_axes(normal[..., None, :], mirror_dir[..., None, :], offsets)
        for tap in range(taps.shape[-1]):
            filtered = _map_lookup(stack, lobe, axes[..., tap, :], below, share)
            if stack.sunlight is not None:
                filtered += stack.sunlight.along(lobe, axes[..., tap, :], below, share)
            radiance += taps[..., tap, None] * scale * filtered
    return np.maximum(radiance, 0.0)


def _between(table: Array, below: Indices, above: Indices, share: Array) -> Array:
    """A table over elevations, interpolated, shape (..., *table.shape[1:])."""
    share = share.reshape(*share.shape, *[1] * (table.ndim - 1))
    mixed: Array = (1.0 - share) * table[below] + share * table[above]
    return mixed


def _map_lookup(stack: LobeStack, lobe: int, axis: Array, below: Indices, share: Array) -> Array:
    """Maps of one lobe along given axes, linear between elevations, shape (..., 3)."""
    maps, representation = stack.maps[lobe], stack.representation
    if len(maps) == 1:
        return lookup(maps[0], axis, representation)
    filtered = np.zeros(axis.shape)
    for number, sheets in enumerate(maps):
        weight = np.where(below == number, 1.0 - share, np.where(below == number - 1, share, 0.0))
        counts = weight > 0.0
        filtered[counts] += weight[counts, None] * lookup(sheets, axis[counts], representation)
    return filtered
