"""A stack of maps: an environment filtered with every lobe of a fit [Kautz2000]."""

from dataclasses import dataclass

import numpy as np

from ...conventions import Array, ArrayLike, Indices
from ...errors import RangeError, ShapeError
from ...maps.representation import Representation, representation
from .sunlight import Sunlight

LAYOUTS = ("dual_paraboloid", "octahedral")
"""Map representations of a stack: continuous over the sphere, with square sheets."""

LARGEST = 1024
"""Width of the largest maps: with a border, they fit a 3D texture of every driver."""


class StackMaps:
    """Base of stacks of maps in one of `LAYOUTS`; their last axes are sheets, height, width and channels."""

    layout: str
    maps: Array

    @property
    def size(self) -> int:
        """Width and height of a sheet in texels."""
        return int(self.maps.shape[-2])

    @property
    def representation(self) -> Representation:
        """The layout of the maps."""
        return stack_representation(self.layout, self.size)


@dataclass(frozen=True, eq=False)
class LobeStack(StackMaps):
    """Maps from which glossy reflection is looked up, by a lobe's axis and by the view's elevation.

    Radiance is the sum over lobes and taps of taps * scale * (map + suns), the map looked up along the axis
    that `fit.lobe_axes` makes of the offsets, and suns as seen along it. Between two elevations all of them
    are linear in mu = n.v; beyond the first and the last, the values of these hold.

    Attributes
    ----------
    layout : str
        One of `LAYOUTS`: see `stack_representation`.
    mu : ndarray, shape (S,)
        Cosines of the view elevations, ascending, in (0, 1].
    maps : ndarray, shape (L, P, sheets, size, size, 3), float32
        Filtered radiance of L lobes; negative in places where a lobe is. P is S, or 1 where all elevations
        share one map: the single 2D lobe of [Kautz2000] section 3.2.
    scale : ndarray, shape (L, S, 3)
        Factor of the map: k(theta) of [Kautz2000] section 3.2, 1 in other stacks.
    offsets : ndarray, shape (L, S, T, 2)
        Offsets of the T lookups ("taps") of a map: see `fit.lobe_axes`.
    taps : ndarray, shape (L, S, T)
        Weights of the taps.
    albedo : ndarray, shape (L, S, 3)
        Directional albedo of each lobe with all its taps.
    sunlight : Sunlight or None
        Light that the maps lack; None where they have all light.

    Raises
    ------
    ShapeError
        The arrays' shapes do not fit each other, or the layout.
    RangeError
        There is no such layout, the maps are larger than `LARGEST` or too small to have neighbours, or the
        elevations do not ascend within (0, 1].
    """

    layout: str
    mu: Array
    maps: Array
    scale: Array
    offsets: Array
    taps: Array
    albedo: Array
    sunlight: Sunlight | None = None

    def __post_init__(self) -> None:
        slices, lobes, tap_count = len(self.mu), len(self.maps), self.taps.shape[-1]
        map_count = 1 if self.maps.shape[1] == 1 else slices
        sheets = stack_representation(self.layout, self.size).shape(self.size)
        expected = {
            "mu": (slices,),
            "maps": (lobes, map_count, *sheets, 3),
            "scale": (lobes, slices, 3),
            "offsets": (lobes, slices, tap_count, 2),
            "taps": (lobes, slices, tap_count),
            "albedo": (lobes, slices, 3),
        }
        for name, shape in expected.items():
            found = getattr(self, name).shape
            if found != shape or 0 in shape:
                raise ShapeError(f"{name} of a lobe stack cannot have the shape {found}: bake it again.")
        if np.any(np.diff(self.mu, prepend=0.0) <= 0.0) or self.mu[-1] > 1.0:
            raise RangeError("Elevations of a lobe stack have cosines that ascend from above 0 to 1.")

    def texel_angle(self, direction: ArrayLike) -> Array:
        """Distance between texels around a direction.

        Parameters
        ----------
        direction : array_like, shape (..., 3)
            Unit directions in world coordinates.

        Returns
        -------
        ndarray, shape (...,)
            [rad], the square root of a texel's solid angle.

        Notes
        -----
        On an octahedron a texel lies aslant at the distance 1 / s, s = |x| + |y| + |z|: its solid angle is
        s^3 times its area in the map. A paraboloid takes (1 + |y|)^2 of it, y being its axis, and its disk
        is as `stack_representation` has it. GLSL twin: gpu_shaders/lib/lobe_stack_lib.glsl
        `stack_texel_angle`, 1e-6 of it.
        """
        direction = np.abs(direction)
        if self.layout == "octahedral":
            angle: Array = 2.0 / self.size * np.sum(direction, axis=-1) ** 1.5
        else:
            angle = 2.0 / (self.size - 1.0) * (1.0 + direction[..., 1])
        return angle

    def elevation(self, mu: ArrayLike) -> tuple[Indices, Array]:
        """Place of views among the sampled elevations.

        Parameters
        ----------
        mu : array_like, shape (...,)
            Cosines between normal and view.

        Returns
        -------
        below : ndarray of int, shape (...,)
            Number of the elevation below, whose weight is 1 - share.
        share : ndarray, shape (...,), float64
            Weight of the next elevation, in [0, 1).
        """
        position = np.interp(np.asarray(mu, np.float64), self.mu, np.arange(len(self.mu)))
        below = np.floor(position).astype(np.intp)
        return below, position - below


def stack_representation(layout: str, size: int) -> Representation:
    """The layout of a stack's maps.

    Parameters
    ----------
    layout : str
        One of `LAYOUTS`.
    size : int
        Width of a sheet in texels, 2 to `LARGEST`.

    Returns
    -------
    Representation
        Paraboloids reach half a texel beyond the hemisphere: the centres of the outermost texels lie on
        its rim, so that bilinear lookups find four texels everywhere.

    Raises
    ------
    RangeError
        There is no such layout, or the size is out of range.
    """
    if layout not in LAYOUTS:
        raise RangeError(f"A lobe stack cannot be laid out as {layout}: choose one of {', '.join(LAYOUTS)}.")
    if not 2 <= size <= LARGEST:
        raise RangeError(f"Maps of a lobe stack cannot be {size} texels wide: choose 2 to {LARGEST}.")
    if layout == "dual_paraboloid":
        return representation(layout, overscan=size / (size - 1))
    return representation(layout)
