"""Filters of four texels, as in hardware, and of sixteen, which do not stop at the faces' borders.

[Kautz2004] section 4.2 uses hardware's box filter for mip maps as a glossy lobe. Hardware filters every face
of the cube separately, so the smallest mip holds six unrelated colours: the border problem of the paper's
figure 4. The paper's remedy, "a filtering implementation that pays attention to the borders, i.e. filters
across faces", is `tent_halved`.
"""

from collections.abc import Callable

import numpy as np

from ...conventions import Array
from ...maps import cube_map

_TENT = np.array([0.125, 0.375, 0.375, 0.125])


def filtered_mips(faces: Array, halved: Callable[[Array], Array]) -> tuple[Array, ...]:
    """A cube map and its halves down to a single texel.

    Parameters
    ----------
    faces : ndarray, shape (6, n, n, channels)
        n a power of 2.
    halved : callable
        `box_halved` or `tent_halved`.

    Returns
    -------
    tuple of ndarray, shapes (6, n, n, channels), (6, n / 2, n / 2, channels) ... (6, 1, 1, channels)
    """
    mips = [faces]
    while mips[-1].shape[1] > 1:
        mips.append(halved(mips[-1]))
    return tuple(mips)


def box_halved(faces: Array) -> Array:
    """Means of two by two texels within each face, as graphics hardware makes mip maps.

    Parameters
    ----------
    faces : ndarray, shape (6, n, n, channels)
        n even.

    Returns
    -------
    ndarray, shape (6, n / 2, n / 2, channels)

    Notes
    -----
    All texels have the same weight, whatever their solid angles: [Kautz2004] section 4.2.
    """
    half = faces.shape[1] // 2
    means: Array = faces.reshape(6, half, 2, half, 2, -1).mean(axis=(2, 4))
    return means


def tent_halved(faces: Array) -> Array:
    """Means of four by four texels, weighted 1 3 3 1 both ways and by solid angle, across the faces' borders.

    Parameters and result are those of `box_halved`.

    Notes
    -----
    With repeated halving the weights tend to the quadratic B-spline, so blocks disappear as well, which the
    paper leaves to future hardware (its section 6).
    """
    solid_angle = cube_map.texel_solid_angle(faces.shape[1])[..., None]
    weighted = np.concatenate([faces * solid_angle, solid_angle], axis=-1)
    means = _tent(_tent(with_borders(weighted), axis=1), axis=2)
    return means[..., :-1] / means[..., -1:]


def with_borders(faces: Array) -> Array:
    """Faces with one more texel on every side: the neighbouring texels on the cube.

    Parameters
    ----------
    faces : ndarray, shape (6, n, n, channels)

    Returns
    -------
    ndarray, shape (6, n + 2, n + 2, channels)
        Bilinear lookups within a face's own square are then continuous over the sphere. Where three faces
        meet, the corner is the mean of their texels, as in `core.resample.lookup`.
    """
    size = faces.shape[1]
    beyond = np.arange(-1, size + 1)
    face, row, column = np.meshgrid(np.arange(6), beyond, beyond, indexing="ij")
    columns, rows, sheets = cube_map.wrap(column, row, face, size, size)
    bordered: Array = faces[sheets, rows, columns]
    for j, inner_j in ((0, 1), (-1, -2)):
        for i, inner_i in ((0, 1), (-1, -2)):
            meeting = bordered[:, inner_j, inner_i] + bordered[:, j, inner_i] + bordered[:, inner_j, i]
            bordered[:, j, i] = meeting / 3.0
    return bordered


def _tent(bordered: Array, axis: int) -> Array:
    """Means of every second four neighbours along an axis: half as many as there are without borders."""
    along = np.moveaxis(bordered, axis, 0)
    taps = np.stack([along[tap : len(along) - 2 + tap : 2] for tap in range(4)])
    means: Array = np.moveaxis(np.tensordot(_TENT, taps, axes=1), 0, axis)
    return means
