"""The base of every reflectance model: a function of a light and a view direction above a surface."""

from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ..conventions import Array, ArrayLike
from ..geometry.directions import dot
from .parameters import Checked

BrdfFunction = Callable[[Array, Array], Array]
"""A function called like a `Brdf`: from light and view directions (..., 3) to (..., 3) [1/sr]."""


@dataclass(frozen=True)
class Geometry:
    """Pairs of directions above the horizon, and the cosines between them.

    Attributes
    ----------
    light_dir, view_dir : ndarray, shape (N, 3), float64
        Unit vectors with positive z; the surface's normal is +Z.
    """

    light_dir: Array
    view_dir: Array

    @property
    def n_dot_l(self) -> Array:
        """Cosine of the light's angle from the normal, shape (N,), in (0, 1]."""
        return self.light_dir[:, 2]

    @property
    def n_dot_v(self) -> Array:
        """Cosine of the view's angle from the normal, shape (N,), in (0, 1]."""
        return self.view_dir[:, 2]

    @cached_property
    def l_dot_v(self) -> Array:
        """Cosine between light and view, shape (N,), in (-1, 1]."""
        return np.clip(dot(self.light_dir, self.view_dir), -1.0, 1.0)

    @cached_property
    def half_dir(self) -> Array:
        """Unit vector half-way between light and view, shape (N, 3)."""
        half_dir: Array = (self.light_dir + self.view_dir) / (2.0 * self.h_dot_l)[:, None]
        return half_dir

    @property
    def n_dot_h(self) -> Array:
        """Cosine of the half vector's angle from the normal, shape (N,), in (0, 1]."""
        return self.half_dir[:, 2]

    @cached_property
    def h_dot_l(self) -> Array:
        """Cosine between the half vector and light, or view: the same, shape (N,), in (0, 1]."""
        # Half the diagonal of their rhombus: exact, and never 0, where they are opposite along the horizon
        cosine: Array = np.linalg.norm(self.light_dir + self.view_dir, axis=1) / 2.0
        return np.minimum(cosine, 1.0)

    @cached_property
    def half_sine_squared(self) -> Array:
        """1 - the square of `n_dot_h` with all its digits where that is tiny, shape (N,)."""
        across = self.half_dir[:, :2]
        return dot(across, across)


class Brdf(Checked, ABC):
    """A bidirectional reflectance distribution function.

    It is isotropic, and reciprocal unless the model says otherwise. Models are frozen dataclasses; their spec
    names their fields (see `spec.py`).
    """

    def __call__(self, light_dir: ArrayLike, view_dir: ArrayLike) -> Array:
        """Reflectance between two directions.

        Parameters
        ----------
        light_dir, view_dir : array_like, shapes (..., 3), broadcastable to each other
            Unit vectors away from the surface, whose normal is +Z.

        Returns
        -------
        ndarray, shape (..., 3), float64
            [1/sr] in linear Rec. 709, without the cosine; 0 where a direction is on or below the horizon.
        """
        light_dir, view_dir = np.broadcast_arrays(
            np.asarray(light_dir, dtype=np.float64), np.asarray(view_dir, dtype=np.float64)
        )
        above = (light_dir[..., 2] > 0.0) & (view_dir[..., 2] > 0.0)
        brdf = np.zeros(light_dir.shape)
        brdf[above] = self.above_horizon(Geometry(light_dir[above], view_dir[above]))
        return brdf

    @abstractmethod
    def above_horizon(self, geometry: Geometry) -> Array:
        """Reflectance [1/sr] where both directions are above the horizon, shape (N, 3) or (N, 1)."""

    @property
    def layers(self) -> tuple["Brdf", ...]:
        """Models whose sum this is, each with one kind of lobe; most models return themselves alone."""
        return (self,)

    @property
    def is_noisy(self) -> bool:
        """Whether errors of measurement make it differ from one elevation to the next."""
        return False
