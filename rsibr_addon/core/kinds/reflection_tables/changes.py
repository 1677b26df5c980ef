"""Changes of a material that its tables serve as well: scales, emission, bending and weights."""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from ...brdf.model import Brdf
from ...conventions import Array
from ...errors import RangeError
from .material import TableMaterial, material_from_texts
from .models import LobeModel
from .tables import ReflectionTables, Role
from .weights import table_weights


def changed_tables(tables: ReflectionTables, parts: Mapping[str, str], fade: bool) -> ReflectionTables:
    """The tables as if they had been made of another material.

    Parameters
    ----------
    tables : ReflectionTables
        As they were read.
    parts : mapping of str to str
        All parts of the material: see `material_from_texts`.
    fade : bool
        See `table_weights`.

    Returns
    -------
    ReflectionTables
        With the same maps.

    Raises
    ------
    RangeError
        The material needs a table that is not there, or another one; or see `material_from_texts`.

    Notes
    -----
    A table is linear in kd or ks, emission is a constant of the diffuse table, and coats, indices of
    refraction, tints and weights are no matter of the tables. Models and exponents are.
    """
    before = material_from_texts(tables.parts, _none_measured)
    now = material_from_texts(parts, _none_measured)
    gains = {role: _gain(role, before.lobes.get(role), model) for role, model in now.lobes.items()}
    maps = dict(tables.maps)
    added = np.zeros(3)
    if Role.DIFFUSE in now.roles:
        gains[Role.DIFFUSE] = _diffuse_gain(before, now)
        added = _radiance(now) - gains[Role.DIFFUSE] * _radiance(before)
        maps.setdefault(Role.DIFFUSE, np.zeros((1, 2, 3), np.float32))
    weights = table_weights(now, fade).astype(np.float32)
    return replace(tables, maps=maps, weights=weights, eta=now.eta, parts=parts, gains=gains, added=added)


def emitted_radiance(parts: Mapping[str, str]) -> Array:
    """What a material of these parts emits, shape (3,): 0 where it has no emission."""
    there = {part: text for part, text in parts.items() if part == "emission"}
    return _radiance(material_from_texts(there, _none_measured)) if there else np.zeros(3)


def _none_measured(kind: str, path: str) -> Brdf:
    raise RangeError("Weights by a measured material are baked: bake the tables again.")


def _gain(role: Role, before: LobeModel | None, now: LobeModel) -> Array:
    if before is None or type(before) is not type(now) or replace(before, ks=now.ks) != now:
        raise _baked_again(role)
    return _ratio(role, before.gain, now.gain)


def _diffuse_gain(before: TableMaterial, now: TableMaterial) -> Array:
    if now.diffuse is None:
        return np.zeros(3)
    if before.diffuse is None or type(before.diffuse) is not type(now.diffuse):
        raise _baked_again(Role.DIFFUSE)
    return _ratio(Role.DIFFUSE, before.diffuse.gain, now.diffuse.gain)


def _ratio(role: Role, before: Array, now: Array) -> Array:
    dark = before == 0.0
    if np.any(dark & (now != 0.0)):
        raise _baked_again(role)
    ratio: Array = np.where(dark, 0.0, now / np.where(dark, 1.0, before))
    return ratio


def _radiance(material: TableMaterial) -> Array:
    return np.zeros(3) if material.emission is None else np.array(material.emission.radiance)


def _baked_again(role: Role) -> RangeError:
    return RangeError(f"The {role} table is another one for this material: bake it again.")
