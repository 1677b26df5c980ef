"""The suns of an environment: the few bright places that hold much of its squared radiance.

Maps are looked up between texels, which blurs what a sharp kernel makes of a sun. So what a sun sends is left
out of maps, and added as it is reflected in closed form: by a lobe's kernels, or, where the material's model
is known, by the model itself.
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from .brdf.fresnel_powers import powers_of
from .brdf.ggx import ggx_ndf, smith_visibility
from .brdf.oren_nayar import tilt
from .conventions import Array
from .geometry.directions import dot, normalize
from .lobes.bank import KernelBank
from .maps import equirect

MOST_SUNS = 8
"""A fragment's costs grow with their number."""

CELLS = 1024
"""Cells around the horizon, of which a sun is one, or a texel where those are larger: .35 degrees wide."""

MODELS_LEAST_SHARE, LOBES_LEAST_SHARE = 0.75, 0.1
"""Share of the squared radiance that suns take away where models reflect them, and where kernels of lobes do,
which costs less; where they cannot, there are none."""

FAINTEST = 1e-3
"""Least share of the squared radiance in a sun's cell."""

NARROWEST = 4.0
"""Width alpha of a GGX lobe as wide as a cell, times the cells around the horizon."""

SHARP_FOR_SUNS = 200.0
"""Concentration from which on lobes' kernels take suns apart: below, they are many texels wide in any map."""

_NEGLIGIBLE = 1e-8
"""Value of a kernel, over its peak, below which it makes nothing of a sun."""


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
    spread : float
        Variance of a sun's texels about its middle, along each axis [rad^2]; 0 of a single texel, as a map's
        light is a sum over its texels.
    """

    direction: Array
    irradiance: Array
    ceiling: Array
    narrowest: float
    spread: float = 0.0

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

    def widened(self, bank: KernelBank) -> KernelBank:
        """Kernels as they show a sun: as much broader as it is wide."""
        return KernelBank(tuple((1.0 / (1.0 / bank.kappa + self.spread)).tolist()))

    def near(self, bank: KernelBank, axis: Array) -> Iterator[tuple[Array, Array]]:
        """What kernels make of each sun.

        Parameters
        ----------
        bank : KernelBank
            K kernels.
        axis : ndarray, shape (..., 3)
            Unit vectors about which they lie.

        Yields
        ------
        near : ndarray of bool, shape (...,)
            Axes that have the sun within the reach of their kernels, n of them.
        light : ndarray, shape (n, K, 3)
            The sun, filtered with each kernel.
        """
        widened = self.widened(bank)
        for direction, irradiance in zip(self.direction, self.irradiance, strict=True):
            near = axis @ direction > 1.0 - far_from(widened)
            between = axis[near] - direction
            yield near, widened.values(0.25 * dot(between, between))[..., None] * irradiance

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
        rest = sheet.astype(np.float64)
        for near, light in self.near(KernelBank((concentration,)), texel_dir):
            rest[near] -= light[:, 0]
        return rest.astype(sheet.dtype)


def sharp_of(bank: KernelBank) -> KernelBank | None:
    """The last kernels of a bank, those from `SHARP_FOR_SUNS` on; None where there are none."""
    sharp = tuple(kappa for kappa in bank.concentrations if kappa >= SHARP_FOR_SUNS)
    return KernelBank(sharp) if sharp else None


def far_from(bank: KernelBank) -> float:
    """1 less the cosine between a sun and an axis from which on kernels make nothing of it."""
    return float(-np.log(_NEGLIGIBLE) / bank.kappa[0])


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


def find_suns(radiance: Array, least_share: float = MODELS_LEAST_SHARE) -> Suns:
    """The suns of an environment.

    Parameters
    ----------
    radiance : ndarray, shape (height, 2 * height, 3)
        Latitude-longitude map.
    least_share : float
        Share of the squared radiance that they take away.

    Returns
    -------
    Suns
        `MOST_SUNS` at most; `NO_SUNS` where these do not take away as much.
    """
    height, width = radiance.shape[:2]
    step = -(-width // CELLS)
    solid_angle = equirect.texel_solid_angle(width, height)
    power = np.einsum("hwc,hwc->hw", radiance, radiance, dtype=np.float64) * solid_angle
    of_cells = _by_cells(np.add, power, step)
    bright = np.flatnonzero(of_cells > FAINTEST * power.sum())
    chosen = bright[np.argsort(-of_cells.flat[bright], kind="stable")][:MOST_SUNS]
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
    if np.sum((held**2 - left**2) * angle) <= least_share * power.sum():
        return NO_SUNS
    light = (held - left) * angle
    uv = np.stack(np.broadcast_arrays((column + 0.5) / width, (row + 0.5) / height), axis=-1)
    towards = np.einsum("nhwc,nhwi->ni", light, equirect.direction_from_uv(uv))
    lit = np.any(towards, axis=1)
    narrowest = min(NARROWEST * step / width, 1.0)
    spread = (step**2 - 1) / 12.0 * (np.pi / height) ** 2
    return Suns(normalize(towards[lit]), light.sum(axis=(1, 2))[lit], ceiling, narrowest, spread)


def _by_cells(reduced: np.ufunc, texels: Array, step: int) -> Array:
    """Texels of a map, shape (height, width, ...), those of each cell as one."""
    rows, columns = (range(0, count, step) for count in texels.shape[:2])
    found: Array = reduced.reduceat(reduced.reduceat(texels, rows, axis=0), columns, axis=1)
    return found
