"""The texels of families of lobes, and of what they look up, as gpu_shaders/lib reads them."""

import numpy as np

from ...core.brdf.fresnel_powers import dielectric
from ...core.conventions import Array
from ...core.errors import ShapeError
from ...core.kinds.kernel_pyramid.shading import Families
from ...core.lobes.family import KERNELS, Family
from ...core.suns import Suns

MOST_LOBES = 4
"""Lobes of a family at most, as many as a texel has numbers."""

GLASS = dielectric(1.5) / dielectric(1.5)[1]
"""Coefficients of glass, of an index of 1.5, over the first rising one.

Most coats and plastics are glass: their weights are a function of their own, in the place of the first rising
one, which metals do not have. So glass costs one lookup of weights, and a metal without tinted edges two.
"""

_WIDTHS_AN_OCTAVE = 6
"""As gpu_shaders/lib/family_lib.glsl has it."""


def family_texels(family: Family) -> Array:
    """A family as gpu_shaders/lib/principled_radiance_lib.glsl reads it.

    Parameters
    ----------
    family : Family
        Of `MOST_LOBES` at most.

    Returns
    -------
    ndarray, shape (1 + K * C, S, A, 4), float32
        The tilts of the lobes; for each kernel and each function, their weights. The functions of GGX are
        `GLASS`, in the place of the first rising power, and the others in their order.

    Raises
    ------
    ShapeError
        It has more lobes, or is not sampled as the shader takes it to be.
    """
    count, rows, lobes = family.tilts.shape
    widths = 2.0 ** ((np.arange(count) - count + 1) / _WIDTHS_AN_OCTAVE)
    regular = np.allclose(family.alpha, widths) and np.allclose(family.mu, (np.arange(rows) + 0.5) / rows)
    if lobes > MOST_LOBES or not regular or family.bank != KERNELS:
        raise ShapeError(
            f"Graphics cards take families of {len(KERNELS)} kernels and {MOST_LOBES} lobes, at "
            f"{_WIDTHS_AN_OCTAVE} widths an octave and regular elevations: fit it anew."
        )
    weights = family.weights.astype(np.float64)
    if weights.shape[4] > 1:
        weights[..., :2] = np.stack([weights @ GLASS, weights[..., 0]], axis=-1)
    by_function = weights.transpose(3, 4, 1, 0, 2).reshape(-1, rows, count, lobes)
    texels = np.zeros((1 + len(by_function), rows, count, MOST_LOBES), dtype=np.float32)
    texels[0, ..., :lobes] = family.tilts.swapaxes(0, 1)
    texels[1:, ..., :lobes] = by_function
    return texels


def lookup_texels(families: Families, places: Array, suns: Suns, resolved: int) -> Array:
    """Which maps are looked up about which axes, as gpu_shaders/lib/pyramid_lib.glsl reads it.

    Parameters
    ----------
    families : Families
    places : ndarray, shape (1, K + 3 + R, 4)
        See `core.kinds.kernel_pyramid.atlas.AtlasLayout`.
    suns : Suns
    resolved : int
        Number of kernels with maps of their own.

    Returns
    -------
    ndarray, shape (L, A + A' + 1, 4), float32
        A column for each width of GGX, and of the leaning facets: the number of kernels that it or the next
        one needs; then of each of them the place of its map, and its number. A column with the places of the
        mirror's map, both diffuse ones, and the rings; after them the ceiling and the narrowest width of the
        suns, their number and that of kernels with maps of their own, and of each its direction and its
        irradiance: see `Suns`.
    """
    of_maps = places[0, :, :3]  # all maps are squares
    columns = [column for family in (families.ggx, families.leaning) for column in _columns(family, of_maps)]
    of_normals = np.pad(of_maps[len(KERNELS) :], ((0, 0), (0, 1)))
    columns.append(np.vstack([of_normals, _sun_texels(suns, resolved)]))
    texels = np.zeros((max(map(len, columns)), len(columns), 4), dtype=np.float32)
    for number, column in enumerate(columns):
        texels[: len(column), number] = column
    return texels


def _sun_texels(suns: Suns, resolved: int) -> Array:
    single = np.finfo(np.float32)
    each = np.stack([suns.direction, np.minimum(suns.irradiance, single.max)], axis=1).reshape(-1, 3)
    head = [*np.minimum(suns.ceiling, single.max), suns.narrowest], [len(suns), resolved, 0.0, 0.0]
    return np.vstack([*head, np.pad(each, ((0, 0), (0, 1)))])


def _columns(family: Family, places: Array) -> list[Array]:
    needed = np.any(family.weights, axis=(1, 2, 4))
    needed[:-1] |= needed[1:]
    columns: list[Array] = []
    for each in needed:
        (kernels,) = np.nonzero(each)
        count = np.array([[len(kernels), 0.0, 0.0, 0.0]])
        columns.append(np.vstack([count, np.column_stack([places[kernels], kernels])]))
    return columns


def albedo_texels(families: Families) -> Array:
    """Albedos of GGX as gpu_shaders/lib/principled_lib.glsl reads them.

    Returns
    -------
    ndarray, shape (2, S, A, 4), float32
        The albedos of GGX times the powers from 2 onwards; that of GGX itself, its mean, 0 and 0.
    """
    albedo = families.ggx.albedo.swapaxes(0, 1)
    texels = np.zeros((2, *albedo.shape[:2], 4), dtype=np.float32)
    texels[0] = albedo[..., 1:]
    texels[1, ..., 0] = albedo[..., 0]
    texels[1, ..., 1] = families.mean(families.ggx.alpha)
    return texels


def sheen_texels(families: Families) -> Array:
    """The table of sheen as gpu_shaders/lib/principled_lib.glsl reads it, shape (S, N, 4), float32."""
    texels: Array = families.sheen_table.weights.swapaxes(0, 1).astype(np.float32)
    return texels
