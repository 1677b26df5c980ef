"""The place of the next lobe: the highest peak, or as [Kautz2000] section 7 proposes.

A peak may be a noisy sample, and a lobe may have its maximum on a ring instead of its axis. Both extensions
therefore look for the lobe of most volume, which here is the integral of its minimum profile.
"""

from collections.abc import Sequence

import numpy as np

from ..conventions import Array
from ..geometry.directions import camera_frame
from ..ties import first_greatest, greatest_first
from .bank import KernelBank
from .kautz_mccool import Remainder, Seek

_SPACING = np.radians(12.0)
_COPIES = 5
_CANDIDATES = 3


def best_place(rest: Remainder) -> Array:
    """First extension: the best of the likely places, shape (3,).

    The peak, the mirror direction, the normal or the view direction: whichever has the lobe of most volume.
    """
    sine = np.sqrt(1.0 - rest.mu**2)
    places = [(sine, 0.0, rest.mu), (0.0, 0.0, 1.0), (-sine, 0.0, rest.mu)]
    return _most_volume(rest, [rest.peak(), *(np.array(place) for place in places)])


def search(rest: Remainder) -> Array:
    """Second extension: search everywhere in a blurred copy, and refine what was found in sharper ones.

    Gives the axis of the lobe of most volume, shape (3,), within a sixteenth of twelve degrees.

    Notes
    -----
    A copy is blurred with a spherical Gaussian as wide as the spacing of the axes that are tried: its values
    are volumes. In the end the best axes of all copies are compared by the volume of their actual lobes.
    """
    spacing = _SPACING
    axes = _everywhere(spacing)
    finalists: list[Array] = []
    for _ in range(_COPIES):
        best = axes[greatest_first(_blurred(rest, axes, spacing))[:_CANDIDATES]]
        finalists.extend(best)
        spacing *= 0.5
        axes = np.concatenate([_neighbours(axis, spacing) for axis in best])
    return _most_volume(rest, finalists)


SEEKING: dict[str, Seek] = {"peaks": Remainder.peak, "places": best_place, "search": search}
"""Name -> the choice of the next lobe's axis."""


def _most_volume(rest: Remainder, axes: Sequence[Array]) -> Array:
    volumes = [float(rest.minimum_profile(axis).integral.sum()) for axis in axes]
    return axes[first_greatest(np.array(volumes))]


def _everywhere(spacing: float) -> Array:
    """Axes above the horizon on one side of the plane of incidence, shape (A, 3)."""
    theta = np.arange(0.5 * spacing, 0.5 * np.pi, spacing)
    turns = [np.linspace(0.0, np.pi, int(np.pi * np.sin(angle) / spacing) + 2) for angle in theta]
    phi, theta = np.concatenate(turns), np.repeat(theta, [len(turn) for turn in turns])
    return np.stack([np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta)], axis=-1)


def _neighbours(axis: Array, spacing: float) -> Array:
    """The axis and those of eight about it that are above the horizon, shape (A, 3)."""
    frame = camera_frame(axis)
    steps = spacing * np.array([(i, j) for i in (0, 1, -1) for j in (0, 1, -1)])
    near = axis + steps @ frame[:, :2].T
    near /= np.linalg.norm(near, axis=1, keepdims=True)
    return near[near[:, 2] > 0.0]


def _blurred(rest: Remainder, axes: Array, spacing: float) -> Array:
    """The remainder, summed over the channels and blurred, about some axes, shape (A,)."""
    light = rest.weight * rest.values.sum(axis=1)
    kernel = KernelBank((1.0 / spacing**2,))
    return kernel.values(np.clip(0.5 * (1.0 - axes @ rest.nodes.T), 0.0, 1.0))[..., 0] @ light
