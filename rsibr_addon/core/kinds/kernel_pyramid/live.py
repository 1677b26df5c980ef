"""A pyramid of six renders, made anew whenever the light changes: each map of a sharper one.

`bake` filters an environment by harmonics, which takes a second. Here a texel is a weighted sum of lookups in
a map that is filtered already, on rings about the texel's direction, as [Kautz2004] section 5 makes each mip
of the one before. The weights are those whose zonal coefficients, times those of the sharper map, come
nearest to the kernel's.
"""

from dataclasses import dataclass
from functools import cache

import numpy as np

from ...conventions import Array
from ...errors import RangeError
from ...filtering.harmonics.legendre import legendre_sums
from ...filtering.radial_lobes import cosine_lobe, von_mises_fisher_lobe
from ...filtering.zonal import ZonalLobe, zonal_coefficients
from ...geometry.directions import camera_frame
from ...lobes.bank import KernelBank
from ...lobes.family import KERNELS
from ...lobes.rings import WIDTHS
from ...maps.representation import representation
from ...resample import lookup, lookup_variance
from ...suns import NO_SUNS, Suns
from ...ties import TIE
from .bake import leaning_lobe, ring_lobe, width_of
from .pyramid import OCTAHEDRAL, Pyramid

CUBE = representation("cube_map")

SMALLEST_FACE = 32
"""Least width of a face: smaller ones do not resolve the kernel that the maps by the normal are made of."""

MIRROR_WIDTH = 4
"""Width of the environment's own map over that of a face: the cube's texels around the horizon."""

RESOLVED = 0.5
"""Root of the sharpest kernel's concentration over the width of a face: a texel from its axis, such a kernel
has fallen to .73."""

TEXELS_BY_SHARPNESS = 8.0
"""Width of a kernel's map over the root of its concentration."""

LEAST_TEXELS, LEAST_BY_NORMAL = 64, 32
"""Width of the smallest maps of kernels, and of those by the normal."""

SHARPER = 4.0
"""Concentration of the kernel that another is made of, over that one's, at least."""

BROAD = 16.0
"""Concentration up to which a kernel is made with more lookups. In the lobes of rough metals broad kernels of
opposite signs are shown by their difference, which magnifies errors eight times; their maps are small."""

BY_NORMAL_FROM = 64.0
"""Concentration of the kernel that the maps by the normal are made of."""

_RINGS, _RINGS_IF_BROAD, _RINGS_BY_NORMAL = 5, 7, 12
_WAVES, _WAVES_IF_BROAD, _WAVES_BY_NORMAL = 2.0, 4.0, 2.5
_LEAST_LOOKUPS = 5
_FALL = 5.5
_LEAST_COSINE = -0.95
_FLUX_COUNTS = 1e4


@dataclass(frozen=True, eq=False)
class LiveMap:
    """How a map is made.

    Attributes
    ----------
    source : int
        Number of the map that is looked up.
    width : int
        Of its square in texels.
    taps : ndarray, shape (N, 4)
        Unit directions of lookups about an axis +z, and their weights.
    lobe : ZonalLobe
        What it shows of light.
    """

    source: int
    width: int
    taps: Array
    lobe: ZonalLobe


@dataclass(frozen=True, eq=False)
class LiveMaps:
    """How all maps are made.

    Attributes
    ----------
    bank : KernelBank
        The kernels that the faces resolve.
    mirror_width : int
        Width of the first map, number 0: the environment itself.
    others : tuple of LiveMap
        The rest of `Pyramid.all_maps` in their order, in which each is made of one before.
    """

    bank: KernelBank
    mirror_width: int
    others: tuple[LiveMap, ...]

    @property
    def widths(self) -> list[int]:
        """Of all maps in texels, the mirror's first."""
        return [self.mirror_width, *(each.width for each in self.others)]


@dataclass(frozen=True)
class _Source:
    """A map that is there: its number, the concentration of the kernel that it shows, and its width."""

    number: int
    concentration: float
    width: int


@cache
def live_maps(size: int) -> LiveMaps:
    """How the pyramid of six faces is made.

    Parameters
    ----------
    size : int
        Width of a face in texels, at least `SMALLEST_FACE`.

    Raises
    ------
    RangeError
        The faces are smaller.
    """
    if size < SMALLEST_FACE:
        raise RangeError(f"Faces of {size} texels are too small: choose {SMALLEST_FACE} or more.")
    sharpest = (1.0 + TIE) * (RESOLVED * size) ** 2
    bank = KernelBank(tuple(kappa for kappa in KERNELS.concentrations if kappa <= sharpest))
    width = MIRROR_WIDTH * size
    blur = lookup_variance(4.0 * np.pi / (6.0 * size**2)) + lookup_variance(4.0 * np.pi / width**2)
    sources = [_Source(0, 1.0 / blur, width)]
    others = []
    for kappa in reversed(bank.concentrations):
        source = [each for each in sources if each.concentration >= SHARPER * kappa][-1]
        others.append(_kernel(kappa, source))
        sources.append(_Source(len(sources), kappa, others[-1].width))
    source = next(each for each in sources if each.concentration == BY_NORMAL_FROM)
    angles = 0.5 * np.pi * (np.arange(_RINGS_BY_NORMAL) + 0.5) / _RINGS_BY_NORMAL
    for lobe in (*map(ring_lobe, WIDTHS), _white(), leaning_lobe()):
        taps = _taps(lobe, source, angles, LEAST_BY_NORMAL, _WAVES_BY_NORMAL)
        others.append(LiveMap(source.number, LEAST_BY_NORMAL, taps, lobe))
    return LiveMaps(bank, width, tuple(others))


def live_pyramid(faces: Array, suns: Suns = NO_SUNS) -> Pyramid:
    """The pyramid of six renders.

    Parameters
    ----------
    faces : ndarray, shape (6, n, n, 3)
        Radiance, in the order of `maps.cube_map`.
    suns : Suns
        Those of lamps, which are in no face.

    Returns
    -------
    Pyramid

    Raises
    ------
    RangeError
        The faces are too small: see `live_maps`.

    Notes
    -----
    GPU twin: `device.kinds.live_pyramid.GpuLivePyramid`, within 1/256 of the brightest, as hardware may round
    the weights of bilinear lookups.
    """
    how = live_maps(faces.shape[1])
    sheets = [lookup(faces, OCTAHEDRAL.texel_directions(how.mirror_width), CUBE)]
    for each in how.others:
        sheets.append(tapped(sheets[each.source], each.taps, OCTAHEDRAL.texel_directions(each.width)))
    for sheet, each in zip(sheets[1:], how.others, strict=True):
        sheet += sunlit(suns, each.lobe, OCTAHEDRAL.texel_directions(each.width))
    count = len(how.bank)
    rings, diffuse = sheets[count + 1 : -2], sheets[-2:]
    kernels = tuple(sheets[count:0:-1])
    return Pyramid(how.bank, sheets[0], kernels, np.concatenate(diffuse), np.concatenate(rings), suns)


def sunlit(suns: Suns, lobe: ZonalLobe, axis: Array) -> Array:
    """What a lobe shows of suns.

    Parameters
    ----------
    suns : Suns
    lobe : ZonalLobe
    axis : ndarray, shape (..., 3)
        Unit vectors.

    Returns
    -------
    ndarray, shape (..., 3)

    Notes
    -----
    GLSL twin, for lobes about the normal: gpu_shaders/lib/live_pyramid_lib.glsl `sunlit_by_normal`.
    """
    radiance = np.zeros(axis.shape)
    for direction, irradiance in zip(suns.direction, suns.irradiance, strict=True):
        angle = np.arccos(np.clip(axis @ direction, -1.0, 1.0))
        radiance += lobe.profile(angle)[..., None] * irradiance
    return radiance


def tapped(sheet: Array, taps: Array, axis: Array) -> Array:
    """Weighted sums of lookups about axes.

    Parameters
    ----------
    sheet : ndarray, shape (1, n, n, 3)
        An octahedral map.
    taps : ndarray, shape (N, 4)
        See `LiveMap`.
    axis : ndarray, shape (..., 3)
        Unit vectors.

    Returns
    -------
    ndarray, shape (..., 3)

    Notes
    -----
    GLSL twin: gpu_shaders/lib/live_pyramid_lib.glsl `tapped_radiance`.
    """
    frame = camera_frame(axis)
    radiance = np.zeros(axis.shape)
    for *direction, weight in taps:
        radiance += weight * lookup(sheet, frame @ direction, OCTAHEDRAL)
    return radiance


def _kernel(kappa: float, source: _Source) -> LiveMap:
    """How a kernel's map is made of a sharper one."""
    is_broad = kappa <= BROAD
    width = width_of(kappa, source.width, TEXELS_BY_SHARPNESS, LEAST_TEXELS)
    # What is left to do is a kernel too, nearly, of this concentration; the last ring is where it has fallen
    left = 1.0 / (1.0 / kappa - 1.0 / source.concentration)
    reach = np.arccos(max(1.0 - _FALL / left, _LEAST_COSINE))
    angles = np.linspace(0.0, reach, _RINGS_IF_BROAD if is_broad else _RINGS)
    waves = _WAVES_IF_BROAD if is_broad else _WAVES
    lobe = von_mises_fisher_lobe(kappa)
    return LiveMap(source.number, width, _taps(lobe, source, angles, width, waves), lobe)


def _white() -> ZonalLobe:
    """What `Pyramid.diffuse` has first."""
    cosine = cosine_lobe()
    return ZonalLobe(lambda angle: cosine.profile(angle) / np.pi, cosine.knots)


def _taps(lobe: ZonalLobe, source: _Source, angles: Array, width: int, waves: float) -> Array:
    """Lookups in a source that show a lobe, in a map of some width, which bilinear lookups blur again.

    Degrees count as in natural light, where each octave has the same power; the integral above all. A ring
    has so many lookups that it follows the source's detail: waves, times its sine over the source's width.
    """
    sharpness = np.sqrt(source.concentration)
    degree = int(np.ceil(3.0 * sharpness))
    l = np.arange(degree + 1)
    counts = 1.0 / np.sqrt(l + 1.0)
    counts[0] = _FLUX_COUNTS
    # No more than bilinear lookups of what natural light has in it can be undone
    sharpened = np.exp(np.minimum(0.5 * l * (l + 1) * lookup_variance(4.0 * np.pi / width**2), 1.0))
    wanted = sharpened * zonal_coefficients(lobe, degree)
    there = zonal_coefficients(von_mises_fisher_lobe(source.concentration), degree)
    legendre = np.stack([legendre_sums(np.ones(1), np.array([angle]), degree) for angle in angles], axis=1)
    weights, *_ = np.linalg.lstsq((counts * there)[:, None] * legendre, counts * wanted, rcond=1e-6)
    rings = []
    for number, (angle, weight) in enumerate(zip(angles, weights, strict=True)):
        least = max(int(np.ceil(waves * np.sin(angle) * sharpness)), _LEAST_LOOKUPS)
        count = least if angle > 0.0 else 1
        turn = 2.0 * np.pi * (np.arange(count) + 0.5 * (number % 2)) / count
        aside, along = np.sin(angle), np.full(count, np.cos(angle))
        rings.append([aside * np.cos(turn), aside * np.sin(turn), along, np.full(count, weight / count)])
    return np.concatenate(rings, axis=1).T
