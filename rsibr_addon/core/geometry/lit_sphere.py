"""A sphere of a material in an environment, exactly: the reference for every approximation.

Seen from afar, radiance depends on the normal alone. With the view as the pole, surface points of equal
mu = n.v form a ring, and turning a point along its ring by an angle turns its whole reflectance about
the pole by the same. The sum over all texels of radiance times brdf times cosine, for all points of a
ring at once, therefore is a circular correlation along each row of the map: products of Fourier
transforms. A ring costs one evaluation of the BRDF for every second texel, whatever its points.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from ..brdf.model import BrdfFunction
from ..conventions import Array, ArrayLike
from ..errors import RangeError, ShapeError
from ..filtering.harmonics.coefficients import Complex
from ..maps import equirect
from ..maps.representation import representation
from ..progress import Progress, Steps
from ..resample import bilinear, resample
from .directions import camera_frame

_EQUIRECT = representation("equirect")


@dataclass(frozen=True)
class LitSphere:
    """Radiance of a sphere seen from afar, by its normals; it holds for anything convex seen from afar.

    Attributes
    ----------
    frame : ndarray, shape (3, 3)
        The camera's axes as columns, in world coordinates; the last is the view direction.
    radiance : ndarray, shape (R, W, 3), float64
        The upper half of a latitude-longitude map in the camera's axes, its rows from the rim to the
        view: R rings, whose normals are (k + 1/2) / R of a right angle from the rim.
    """

    frame: Array
    radiance: Array

    def at(self, normal: ArrayLike) -> Array:
        """Radiance of surface points.

        Parameters
        ----------
        normal : array_like, shape (..., 3)
            Unit vectors in world coordinates; vectors that point away from the camera show the rim.

        Returns
        -------
        ndarray, shape (..., 3), float64
            Interpolated with a cubic through four rings, so that few rings are enough, and linearly along
            each.
        """
        rings = len(self.radiance)
        uv = equirect.uv_from_direction(np.asarray(normal, dtype=np.float64) @ self.frame)
        row = np.maximum((2.0 * uv[..., 1] - 1.0) * rings - 0.5, 0.0)
        # Towards the rim the last four rings are continued; the pole's neighbours lie beyond it.
        first = np.maximum(np.floor(row) - 1.0, 0.0)
        found = np.zeros((*row.shape, 3))
        for ring, weight in enumerate(_cubic_weights(row - first)):
            at_ring = np.stack([uv[..., 0], (first + ring + 0.5) / rings], axis=-1)
            found += weight[..., None] * bilinear(self.radiance, at_ring, equirect.wrap)
        return found


def lit_spheres(
    brdf: BrdfFunction, radiance: Array, view_dirs: Sequence[ArrayLike], rings: int
) -> Steps[tuple[LitSphere, ...]]:
    """Spheres seen from several directions.

    Parameters
    ----------
    brdf : callable
        A `Brdf`, or any isotropic function called like one.
    radiance : ndarray, shape (height, 2 * height, 3)
        Latitude-longitude map of the environment.
    view_dirs : sequence of array_like, shape (3,)
        Unit vectors from the sphere to the camera.
    rings : int
        Number R of rings of each sphere, at least 4.

    Yields
    ------
    Progress
        One step for each ring.

    Raises
    ------
    ShapeError, RangeError
        See `ring_radiance`; or there are fewer than 4 rings.

    Notes
    -----
    A view from +Z needs the map as it is. For others it is looked up in the camera's axes, bilinearly
    at its own size, which blurs it by about a texel: a relative root-mean-square error of 1e-3 for a lobe
    as narrow as Ward's with alpha = 0.04 in a map of 1024x512.
    """
    if rings < 4:
        raise RangeError(f"{rings} rings are too few to interpolate between: ask for 4 or more.")
    frames = [camera_frame(view_dir) for view_dir in view_dirs]
    spectrum = _row_spectrum(np.stack([environment_about(radiance, frame) for frame in frames]))
    spheres = np.empty((len(frames), rings, radiance.shape[1], 3))
    for ring in range(rings):
        yield Progress(ring, rings, f"integrating ring {ring + 1} of {rings}")
        spheres[:, ring] = _ring(brdf, spectrum, np.sin(0.5 * np.pi * (ring + 0.5) / rings))
    return tuple(LitSphere(frame, sphere) for frame, sphere in zip(frames, spheres, strict=True))


def ring_radiance(brdf: BrdfFunction, radiance: Array, mu: Sequence[float]) -> Array:
    """Radiance of a sphere seen from +Z, exactly the sum over all texels.

    Parameters
    ----------
    brdf : callable
        A `Brdf`, or any isotropic function called like one.
    radiance : ndarray, shape (..., height, 2 * height, channels)
        Latitude-longitude maps whose +Z is the view; channels 1 or 3.
    mu : sequence of float
        Cosines between normal and view, in (0, 1].

    Returns
    -------
    ndarray, shape (..., len(mu), 2 * height, 3), float64
        Column i shows the point whose normal lies at the azimuth of the map's column i.

    Raises
    ------
    ShapeError
        A map is not twice as wide as high.
    RangeError
        An elevation lies outside (0, 1].

    Notes
    -----
    All light of a texel is at its centre, as in `core.filtering.prefilter`: repeat texels along both axes for
    lobes that are not much wider. The result is that of brute force, to rounding.
    """
    if not all(0.0 < cosine <= 1.0 for cosine in mu):
        raise RangeError(f"Elevations have cosines greater than 0 and at most 1, not all of {list(mu)}.")
    spectrum = _row_spectrum(radiance)
    return np.stack([_ring(brdf, spectrum, float(cosine)) for cosine in mu], axis=-3)


def environment_about(radiance: Array, frame: Array) -> Array:
    """An environment as a map about a camera's view, as `ring_radiance` takes it.

    Parameters
    ----------
    radiance : ndarray, shape (height, 2 * height, 3)
        Latitude-longitude map.
    frame : ndarray, shape (3, 3)
        The camera's axes as columns: see `directions.camera_frame`.

    Returns
    -------
    ndarray, shape (height, 2 * height, 3)
        Latitude-longitude map in those axes, looked up bilinearly; from straight above, as it is.
    """
    if np.array_equal(frame[:, 2], (0.0, 0.0, 1.0)):
        # The camera's x and y are then -X and -Y: half a turn about the pole.
        return np.roll(radiance, radiance.shape[1] // 2, axis=1)
    axes = replace(_EQUIRECT, frame=frame)
    seen: Array = resample(radiance[None], _EQUIRECT, axes, radiance.shape[1])[0]
    return seen


def _row_spectrum(radiance: Array) -> Complex:
    """Fourier transform along each row, shape (..., height, height + 1, channels)."""
    height, width = radiance.shape[-3:-1]
    if width != 2 * height:
        raise ShapeError(f"A latitude-longitude map is twice as wide as high, not {width}x{height}.")
    return np.fft.rfft(radiance.astype(np.float64), axis=-2)


def _ring(brdf: BrdfFunction, spectrum: Complex, mu: float) -> Array:
    """One ring of every map, shape (..., 2 * height, 3)."""
    height = spectrum.shape[-3]
    product = np.einsum("...jmc,jmc->...mc", spectrum, _kernel_spectrum(brdf, mu, height))
    ring: Array = np.fft.irfft(product, 2 * height, axis=-2)
    return ring


def _kernel_spectrum(brdf: BrdfFunction, mu: float, height: int) -> Array:
    """Fourier transform along each row of a texel's weight for a point of a ring.

    Returns
    -------
    ndarray, shape (height, height + 1, 3), float64
        Real, because the reflectance is symmetric about the plane of incidence.
    """
    # Half a row: azimuths from the point's own on.
    azimuth = np.pi * np.arange(height + 1) / height
    colatitude = np.pi * (1.0 - (np.arange(height) + 0.5) / height)[:, None]
    light_dir = np.stack(
        [
            np.sin(colatitude) * np.cos(azimuth),
            np.sin(colatitude) * np.sin(azimuth),
            np.broadcast_to(np.cos(colatitude), (height, height + 1)),
        ],
        axis=-1,
    )
    sine = np.sqrt(1.0 - mu**2)
    # Rows are the surface's axes: x is that of the view along the surface, z the normal.
    light_dir = light_dir @ np.array([[-mu, 0.0, sine], [0.0, -1.0, 0.0], [sine, 0.0, mu]]).T
    lobe = brdf(light_dir, np.array([sine, 0.0, mu])) * light_dir[..., 2:]
    kernel = lobe * equirect.texel_solid_angle(2 * height, height)[:, :1, None]
    spectrum: Array = np.fft.rfft(np.concatenate([kernel, kernel[:, -2:0:-1]], axis=1), axis=1).real
    return spectrum


def _cubic_weights(position: Array) -> tuple[Array, ...]:
    """Lagrange's weights of the points 0, 1, 2, 3 for a position among them."""
    p = [position - k for k in range(4)]
    return (
        -p[1] * p[2] * p[3] / 6.0,
        p[0] * p[2] * p[3] / 2.0,
        -p[0] * p[1] * p[3] / 2.0,
        p[0] * p[1] * p[2] / 6.0,
    )
