"""The suns of an environment: the few bright places that hold most of its squared radiance.

A sun shows the lobes that a material is made of, not the material. So what a sun sends is left out of the
lobes' light, and reflected by GGX itself, which is known in closed form.
"""

from dataclasses import dataclass

import numpy as np

from ...brdf.fresnel_powers import powers_of
from ...brdf.ggx import ggx_ndf, smith_visibility
from ...brdf.oren_nayar import tilt
from ...conventions import Array
from ...geometry.directions import dot, normalize
from ...lobes.bank import KernelBank
from ...maps import equirect

MOST_SUNS = 8
"""A fragment's costs grow with their number."""

CELLS = 1024
"""Cells around the horizon, of which a sun is one, or a texel where those are larger: .35 degrees wide."""

LEAST_SHARE = 0.75
"""Share of the squared radiance that suns take away; where they cannot, there are none."""

FAINTEST = 1e-3
"""Least share of the squared radiance in a sun's cell."""

NARROWEST = 4.0
"""Width alpha of a GGX lobe as wide as a cell, times the cells around the horizon."""

_NEGLIGIBLE = 1e-8
"""Value of a kernel, over its peak, below which a sun's share of a texel is not taken away."""


@dataclass(frozen=True, eq=False)
class Suns:
    """N suns, the light that is brighter than all other.

    Attributes
    ----------
    direction : ndarray, shape (N, 3)
        Unit vectors towards them.
    irradiance : ndarray, shape (N, 3)
        What they add to the light below `ceiling`: radiance times solid angle.
    ceiling : ndarray, shape (3,)
        The largest radiance beside them.
    narrowest : float
        Width alpha of lobes as wide as a sun. Of narrower ones, what the sun lacks is seen as in a mirror.
    """

    direction: Array
    irradiance: Array
    ceiling: Array
    narrowest: float

    def __len__(self) -> int:
        return len(self.direction)

    def mirror_share(self, alpha: Array) -> Array:
        """Share of a mirror in a lobe narrower than suns; the foot of the rest is the lobe's own.

        Parameters
        ----------
        alpha : ndarray, shape (...,)

        Returns
        -------
        ndarray, shape (...,)
            In [0, 1].
        """
        share: Array = 1.0 - np.minimum(alpha / self.narrowest, 1.0) ** 2
        return share

    def glossy(self, alpha: Array, coefficients: Array, normal: Array, view_dir: Array) -> Array:
        """Their light as GGX reflects it, shape (N, 3), without what is seen as in a mirror.

        Parameters
        ----------
        alpha : ndarray, shape (N,)
        coefficients : ndarray, shape (N, C, 3)
            Of `fresnel_powers.POWERS`.
        normal, view_dir : ndarray, shape (N, 3)
            Unit vectors, less than 90 degrees from each other.

        Notes
        -----
        GLSL twin: gpu_shaders/lib/suns_lib.glsl `sunlit_gloss`.
        """
        width = np.maximum(alpha, self.narrowest)
        rough = (1.0 - self.mirror_share(alpha))[:, None]
        n_dot_v = dot(normal, view_dir)
        radiance = np.zeros(normal.shape)
        for direction, irradiance in zip(self.direction, self.irradiance, strict=True):
            n_dot_l = np.maximum(normal @ direction, 0.0)
            both = view_dir + direction
            square = np.maximum(dot(both, both), 1e-12)
            aside = np.cross(normal, both)
            facets = ggx_ndf(dot(aside, aside) / square, width)
            facets = facets * smith_visibility(n_dot_l, n_dot_v, width) * n_dot_l
            colour = np.einsum("nc,nci->ni", powers_of(both @ direction / np.sqrt(square)), coefficients)
            radiance += rough * facets[:, None] * colour * irradiance
        return radiance

    def leaning(self, mu: Array, normal: Array, view_dir: Array) -> Array:
        """Their light as `oren_nayar.tilt` reflects it, shape (N, 3).

        Parameters
        ----------
        mu : ndarray, shape (N,)
            Cosines between normal and view; above 0, though that of an interpolated normal may not be.
        normal, view_dir : ndarray, shape (N, 3)
            Unit vectors.

        Notes
        -----
        GLSL twin: gpu_shaders/lib/suns_lib.glsl `sunlit_leaning`.
        """
        radiance = np.zeros(normal.shape)
        for direction, irradiance in zip(self.direction, self.irradiance, strict=True):
            n_dot_l = np.maximum(normal @ direction, 0.0)
            radiance += (n_dot_l * tilt(n_dot_l, mu, view_dir @ direction))[:, None] * irradiance
        return radiance

    def left_of(self, sheet: Array, texel_dir: Array, concentration: float) -> Array:
        """A filtered map without them.

        Parameters
        ----------
        sheet : ndarray, shape (..., 3)
            Radiance filtered with a kernel.
        texel_dir : ndarray, shape (..., 3)
            Direction of each of its texels.
        concentration : float
            The kernel's.

        Returns
        -------
        ndarray, shape (..., 3)
            Of the type of `sheet`.
        """
        bank = KernelBank((concentration,))
        least = 1.0 + np.log(_NEGLIGIBLE) / concentration
        rest = sheet.astype(np.float64)
        for direction, irradiance in zip(self.direction, self.irradiance, strict=True):
            near = texel_dir @ direction > least
            between = texel_dir[near] - direction
            rest[near] -= bank.values(0.25 * dot(between, between)) * irradiance
        return rest.astype(sheet.dtype)


NO_SUNS = Suns(np.zeros((0, 3)), np.zeros((0, 3)), np.full(3, np.inf), 1e-30)
"""So narrow that no lobe but a mirror is narrower: without suns, none has its `mirror_share` looked up."""


def lamp_suns(direction: Array, irradiance: Array, angle: float) -> Suns:
    """The brightest `MOST_SUNS` of some lamps, which are in no map, as cameras do not see them.

    Parameters
    ----------
    direction : ndarray, shape (N, 3)
        Unit vectors towards them.
    irradiance : ndarray, shape (N, 3)
        On a surface that faces them.
    angle : float
        Angle across one of them [rad].
    """
    brightest = np.argsort(-irradiance.sum(axis=1), kind="stable")[:MOST_SUNS]
    narrowest = NARROWEST * max(angle / (2.0 * np.pi), 1.0 / CELLS)
    return Suns(direction[brightest], irradiance[brightest], np.full(3, np.inf), min(narrowest, 1.0))


def find_suns(radiance: Array) -> Suns:
    """The suns of an environment.

    Parameters
    ----------
    radiance : ndarray, shape (height, 2 * height, 3)
        Latitude-longitude map.

    Returns
    -------
    Suns
        `MOST_SUNS` at most; `NO_SUNS` where these do not hold `LEAST_SHARE`.
    """
    height, width = radiance.shape[:2]
    step = -(-width // CELLS)
    solid_angle = equirect.texel_solid_angle(width, height)
    power = np.einsum("hwc,hwc->hw", radiance, radiance, dtype=np.float64) * solid_angle
    of_cells = _by_cells(np.add, power, step)
    brightest = np.argsort(-of_cells, axis=None, kind="stable")[:MOST_SUNS]
    chosen = brightest[of_cells.flat[brightest] > FAINTEST * power.sum()]
    rows, columns = np.unravel_index(chosen, of_cells.shape)
    others = _by_cells(np.maximum, radiance, step)
    others[rows, columns] = 0.0
    ceiling = others.max(axis=(0, 1)).astype(np.float64)
    # Texels of each cell's first row and column on
    row = (rows * step)[:, None, None] + np.arange(step)[:, None]
    column = (columns * step)[:, None, None] + np.arange(step)
    inside = (row < height) & (column < width)
    row, column = np.minimum(row, height - 1), np.minimum(column, width - 1)
    angle = (inside * solid_angle[row, column])[..., None]
    held = radiance[row, column].astype(np.float64)
    left = np.minimum(held, ceiling)
    if np.sum((held**2 - left**2) * angle) <= LEAST_SHARE * power.sum():
        return NO_SUNS
    light = (held - left) * angle
    uv = np.stack(np.broadcast_arrays((column + 0.5) / width, (row + 0.5) / height), axis=-1)
    towards = np.einsum("nhwc,nhwi->ni", light, equirect.direction_from_uv(uv))
    lit = np.any(towards, axis=1)
    narrowest = min(NARROWEST * step / width, 1.0)
    return Suns(normalize(towards[lit]), light.sum(axis=(1, 2))[lit], ceiling, narrowest)


def _by_cells(reduced: np.ufunc, texels: Array, step: int) -> Array:
    """Texels of a map, shape (height, width, ...), those of each cell as one."""
    rows, columns = (range(0, count, step) for count in texels.shape[:2])
    found: Array = reduced.reduceat(reduced.reduceat(texels, rows, axis=0), columns, axis=1)
    return found
