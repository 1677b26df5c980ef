"""Directional albedo: the share of light that a surface sends to one view, by quadrature."""

from functools import cache

import numpy as np

from ..conventions import Array, ArrayLike
from ..errors import RangeError
from ..ties import TIE
from ..warned import warn
from .model import BrdfFunction

RADIAL_NODES, ARC_NODES = 8, 32
NARROWEST = 1e-4
"""Radians about the mirror and the view direction within which a lobe is taken as smooth."""

CHECKED_ELEVATIONS = (np.arange(16) + 0.5) / 16.0
TOLERATED_GAIN = 0.01
"""Share by which a surface may reflect more light than it receives without a warning."""


def hemisphere_quadrature(
    mu: float, radial_nodes: int = RADIAL_NODES, arc_nodes: int = ARC_NODES, narrowest: float = NARROWEST
) -> tuple[Array, Array]:
    """Directions and weights to integrate over the hemisphere for one view.

    Parameters
    ----------
    mu : float
        Cosine of the view's angle from the normal, in (0, 1]; the view is (sqrt(1 - mu^2), 0, mu).
    radial_nodes, arc_nodes : int
        Nodes of each panel of radii, and of each arc.
    narrowest : float
        Radians about the mirror and the view direction within which a lobe is taken as smooth.

    Returns
    -------
    light_dir : ndarray, shape (N, 3), float64
        Unit vectors above the horizon, dense about the mirror and the view direction.
    weight : ndarray, shape (N,), float64
        Solid angles [sr], sum 2 pi.

    Raises
    ------
    RangeError
        `mu` lies outside (0, 1].

    Notes
    -----
    Either half of the hemisphere, forwards with the mirror direction and backwards with the view, is cut into
    arcs about its direction, on which horizon and border are known in closed form. Arcs have Gauss-Legendre
    nodes, which crowd at the ends, where the lobes of grazing views are thin. Radii have them in panels that
    halve towards the centre, in t^2 instead of t for the corners at horizon and border.
    """
    if not 0.0 < mu <= 1.0:
        raise RangeError(f"An elevation has a cosine greater than 0 and at most 1, not {mu:g}.")
    sine = max(np.sqrt(1.0 - mu**2), 1e-12)
    radius, radial_weight = _radial_nodes(np.arccos(mu), radial_nodes, narrowest)
    cot = 1.0 / np.tan(radius)
    # Arc angle psi counts from straight down; the horizon cuts the start, the other half the end
    start = np.arccos(np.minimum(1.0, cot * mu / sine))
    end = np.arccos(-np.minimum(1.0, cot * sine / mu))
    node, node_weight = _gauss_legendre(arc_nodes)
    psi = start[:, None] + (end - start)[:, None] * (node + 1.0) / 2.0
    weight = (radial_weight * np.sin(radius) * (end - start) / 2.0)[:, None] * node_weight
    along, down = np.cos(radius)[:, None], np.sin(radius)[:, None] * np.cos(psi)
    x, z = along * sine + down * mu, along * mu - down * sine
    y = np.sin(radius)[:, None] * np.sin(psi)
    quarter = np.stack([x, y, z], axis=-1).reshape(-1, 3)
    light_dir = np.concatenate([quarter * (forwards, left, 1.0) for forwards in (1, -1) for left in (1, -1)])
    return light_dir, np.tile(weight.ravel(), 4)


def directional_albedo(brdf: BrdfFunction, mu: ArrayLike) -> Array:
    """Share of uniform light that is reflected to a view: the integral of brdf times cosine.

    Parameters
    ----------
    brdf : callable
        A `Brdf`, or any isotropic function called like one.
    mu : array_like, shape (...,)
        Cosines of the views' angles from the normal, in (0, 1].

    Returns
    -------
    ndarray, shape (..., 3), float64
        In linear Rec. 709; at most 1 for a surface that gains no energy. The error is at most 5e-4 for lobes
        at least 0.01 wide (alpha) and elevations mu of at least 0.03.

    Raises
    ------
    RangeError
        An elevation lies outside (0, 1].
    """
    mu = np.asarray(mu, dtype=np.float64)
    albedo = np.empty((mu.size, 3))
    for index, cosine in enumerate(mu.ravel().tolist()):
        light_dir, weight = hemisphere_quadrature(cosine)
        view_dir = np.array([np.sqrt(1.0 - cosine**2), 0.0, cosine])
        albedo[index] = (weight * light_dir[:, 2]) @ brdf(light_dir, view_dir)
    return albedo.reshape(*mu.shape, 3)


def warn_of_gain(brdf: BrdfFunction, name: str) -> None:
    """Warn when a surface reflects more light than it receives.

    Parameters
    ----------
    brdf : callable
        A `Brdf`, or any isotropic function called like one.
    name : str
        Name of the surface in the message.

    Warns
    -----
    RsibrWarning
        Its albedo exceeds 1 by more than `TOLERATED_GAIN` at one of sixteen elevations; says how much
        and where.
    """
    albedo = directional_albedo(brdf, CHECKED_ELEVATIONS).max(axis=-1)
    worst = int(np.argmax(albedo))
    angle = np.degrees(np.arccos(CHECKED_ELEVATIONS[worst]))
    if albedo[worst] > 1.0 + TOLERATED_GAIN:
        warn(
            f"{name} reflects {albedo[worst]:.3g} times the light it receives at {angle:.0f} degrees from "
            f"the normal; pictures of it will be too bright."
        )


@cache
def _gauss_legendre(nodes: int) -> tuple[Array, Array]:
    return np.polynomial.legendre.leggauss(nodes)


@cache
def _panel(nodes: int) -> tuple[Array, Array]:
    """Gauss-Legendre nodes and weights on [0, 1] in t^2."""
    node, weight = _gauss_legendre(nodes)
    t = (node + 1.0) / 2.0
    return t**2, weight * t


def _radial_nodes(theta: float, nodes: int, narrowest: float) -> tuple[Array, Array]:
    """Radii in (0, pi/2) and their weights; panels end where arcs meet the horizon or the border."""
    halvings = np.pi / 2.0 * 0.5 ** np.arange(np.ceil(np.log2(np.pi / 2.0 / narrowest) - TIE) + 1.0)
    corners = [corner for corner in (theta, np.pi / 2.0 - theta) if narrowest < corner < np.pi / 2.0]
    edges = np.unique([0.0, *halvings, *corners])
    node, weight = _panel(nodes)
    width = np.diff(edges)[:, None]
    return (edges[:-1, None] + width * node).ravel(), (width * weight).ravel()
