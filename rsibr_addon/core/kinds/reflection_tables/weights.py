"""Weights of the tables at each angle: Wd and Ws of [Miller1984] section 7, and those of other tables."""

import numpy as np

from ...brdf.albedo import TOLERATED_GAIN, directional_albedo
from ...brdf.fresnel import fresnel_conductor
from ...brdf.lambert import Lambert
from ...brdf.layered import uncoated
from ...brdf.model import Brdf
from ...brdf.retroreflective import Retroreflective
from ...conventions import Array
from ...errors import RangeError
from ...warned import warn
from .material import TableMaterial
from .models import AlbedoReflectance, CoatModel, ConstantReflectance, Curves, PhongTable
from .tables import Role

COLUMNS = 64
"""Cosines at which weights are tabulated."""

_ANGLES = 256
"""Angles from a lobe's axis over which its share is averaged: 1e-3 at the horizon."""


def weight_cosines() -> Array:
    """Cosines between normal and view of the weights' columns, shape (COLUMNS,)."""
    cosines: Array = (np.arange(COLUMNS) + 0.5) / COLUMNS
    return cosines


def share_above_horizon(cosine: Array, n: float) -> Array:
    """The part of a Phong lobe that is above the horizon.

    Parameters
    ----------
    cosine : ndarray, shape (N,)
        Between the normal and the lobe's axis, in (0, 1].
    n : float
        The lobe's exponent.

    Returns
    -------
    ndarray, shape (N,), float64
        1/2 at the horizon, up to 1.

    Notes
    -----
    The mean over angles from the axis that are spread as the lobe is; of the circle at the angle a about an
    axis that is e above the horizon, the part acos(-tan e / tan a) / pi is above it.
    """
    spread = (np.arange(_ANGLES) + 0.5) / _ANGLES
    tangent = np.tan(np.arccos(spread ** (1.0 / (n + 1.0))))
    height = np.tan(np.arcsin(np.minimum(cosine, 1.0 - 1e-12)))
    above: Array = np.mean(np.arccos(-np.minimum(height[:, None] / tangent, 1.0)), axis=1) / np.pi
    return above


def table_weights(material: TableMaterial, fade: bool = False, cosines: Array | None = None) -> Array:
    """Weights of a material's tables.

    Parameters
    ----------
    material : TableMaterial
    fade : bool
        Whether lobes lose what of them is beneath the horizon; a BRDF's albedo has lost it anyway.
    cosines : ndarray, shape (N,), optional
        Between normal and view, in (0, 1]; by default `weight_cosines`.

    Returns
    -------
    ndarray, shape (len(Role), N, 3), float64
        As `ReflectionTables.weights`; 0 for tables that the material lacks.

    Raises
    ------
    RangeError
        The weights are those of a BRDF with lobes for which the material has no table.

    Notes
    -----
    A smooth boundary gives the specular table the share F that it reflects, and the diffuse and retro tables
    the rest, 1 - F; a constant share is such an F. Curves are the weights themselves. A BRDF gives each table
    the directional albedo of its lobes of that kind. Refracted light gets 1 - F of its own boundary. A coat
    takes its share from all.
    """
    mu = weight_cosines() if cosines is None else cosines
    shares = {role: np.ones((len(mu), 3)) for role in material.roles} | _shares(material, mu)
    if material.refraction is not None:
        passes = 1.0 - fresnel_conductor(mu, material.refraction.eta, 0.0)
        shares[Role.REFRACTION] = passes[:, None] * np.asarray(material.refraction.tint)
    for role, model in material.lobes.items():
        if fade and isinstance(model, PhongTable) and not isinstance(material.weights, AlbedoReflectance):
            shares[role] = shares[role] * share_above_horizon(mu, model.n)[:, None]
    if material.coat is not None:
        coat = _reflectance(material.coat, mu)
        shares = {role: (1.0 - coat) * share for role, share in shares.items()} | {Role.COAT: coat}
    weights = np.zeros((len(Role), len(mu), 3))
    for row, role in zip(weights, Role, strict=True):
        if role in material.roles:
            row[:] = shares[role]
    return weights


def furnace(material: TableMaterial) -> Array:
    """Radiance of a material in even light of radiance 1, without its emission.

    Returns
    -------
    ndarray, shape (COLUMNS, 3), float64
        At `weight_cosines`; at most 1 where no energy is gained.
    """
    models = material.lobes | ({Role.DIFFUSE: material.diffuse} if material.diffuse is not None else {})
    weights = dict(zip(Role, table_weights(material), strict=True))
    total: Array = sum((weights[role] * model.gain for role, model in models.items()), np.zeros((COLUMNS, 3)))
    return total


def warn_of_table_gain(material: TableMaterial) -> None:
    """Warn when a material reflects more light than it receives.

    Warns
    -----
    RsibrWarning
        Its `furnace` exceeds 1 by more than `TOLERATED_GAIN`; says how much and where.
    """
    total = furnace(material).max(axis=1)
    worst = int(np.argmax(total))
    if total[worst] > 1.0 + TOLERATED_GAIN:
        angle = np.degrees(np.arccos(weight_cosines()[worst]))
        warn(
            f"The material reflects {total[worst]:.3g} times the light it receives at {angle:.0f} degrees "
            f"from the normal; pictures of it will be too bright."
        )


def _shares(material: TableMaterial, mu: Array) -> dict[Role, Array]:
    """Shares of some roles by `TableMaterial.weights`, shape (COLUMNS, 3) each."""
    if material.weights is None:
        return {}
    if isinstance(material.weights, AlbedoReflectance):
        return _albedo_shares(material.weights.brdf, material.roles, mu)
    if isinstance(material.weights, Curves):
        curves = {Role.DIFFUSE: material.weights.diffuse(mu), Role.SPECULAR: material.weights.specular(mu)}
        return {role: np.broadcast_to(curve, (len(mu), 3)) for role, curve in curves.items()}
    boundary = _reflectance(material.weights, mu)
    return {Role.SPECULAR: boundary, Role.DIFFUSE: 1.0 - boundary, Role.RETRO: 1.0 - boundary}


def _albedo_shares(brdf: Brdf, roles: tuple[Role, ...], mu: Array) -> dict[Role, Array]:
    kinds = Role.DIFFUSE, Role.SPECULAR, Role.RETRO
    shares: dict[Role, Array] = {role: np.zeros((len(mu), 3)) for role in kinds}
    for layer in brdf.layers:
        role = _role_of(layer)
        if role not in roles:
            raise RangeError(f"The weights' BRDF has a {role} part, so the material needs a {role} table.")
        shares[role] += directional_albedo(layer, mu)
    return shares


def _role_of(layer: Brdf) -> Role:
    """The table of a layer's light, by the layer's model beneath its coats."""
    layer = uncoated(layer)
    if isinstance(layer, Lambert):
        return Role.DIFFUSE
    return Role.RETRO if isinstance(layer, Retroreflective) else Role.SPECULAR


def _reflectance(boundary: CoatModel, mu: Array) -> Array:
    if isinstance(boundary, ConstantReflectance):
        return np.broadcast_to(boundary.k, (len(mu), 3))
    return boundary.fresnel(mu)
