"""Reflectance models as text: ``model:key=value,key=value``.

Numbers are decimal; colours are one number or three, red/green/blue; models within models stand in
parentheses::

    ward:alpha=0.04,ks=0.8
    ggx:alpha=0.3,metal=copper
    ggx:alpha=0.3,eta=0.2/0.924/1.102,k=3.912/2.452/2.142
    layered:coat=(ggx:alpha=0.05,eta=1.5),base=(lambert:kd=0.3/0.05/0.02)
    sum:parts=(lambert:kd=0.2)+(phong:n=50,ks=0.5)
    merl:path=gold-metallic-paint.binary

A material of Blender, ``blend:FILE.blend:NAME``, is measured first: see tasks/reflectance/brdfs.py.
"""

import dataclasses
import re
from collections.abc import Callable
from typing import Any, get_type_hints

import numpy as np

from ..errors import RangeError
from ..near_names import did_you_mean
from .car_paint import CarPaint
from .cook_torrance import CookTorrance
from .fresnel import Fresnel, Index, Schlick
from .ggx import Ggx
from .he_torrance import HeTorrance
from .lambert import Lambert
from .layered import Layered, Sum
from .measured_cornell import Scattered
from .measured_material import MeasuredMaterial
from .measured_rgl import MeasuredRgl
from .metals import METALS
from .model import Brdf
from .parameters import Color, check_numbers, parameter_ranges
from .phong import Phong
from .principled import Principled
from .retroreflective import Retroreflective
from .tabulated import Tabulated
from .ward import Ward

ReadMeasured = Callable[[str, str], Brdf]
"""Reads a measured model: from its format, one of `MEASURED`, and its path."""

MODELS: dict[str, type[Brdf]] = {
    owner.model: owner
    for owner in (
        Lambert, Phong, Ward, Ggx, CookTorrance, HeTorrance, Retroreflective, CarPaint, Principled, Layered,
        Sum,
    )
}  # fmt: skip
"""Name -> model whose parameters are the spec's keys."""

MEASURED = ("merl", "cornell", "rgl")
"""Formats of measured models; their only key is path, which takes the rest of the text."""

MATERIAL = "blend"
"""What a text begins with that stands for a material: ``blend:FILE.blend:NAME``, ``blend:PRESET``."""

DEEPEST = 8
"""Greatest depth of models within models."""

A_MODEL = "a model in parentheses, as (lambert:kd=0.5)"
_ALPHA = re.compile(r"(?<=[:,])\s*alpha\s*=[^,()]*")
FRESNEL_KEYS = ("metal", "eta", "k", "f0", "f90")


def brdf_from_spec(spec: str, read_measured: ReadMeasured) -> Brdf:
    """Make the model that a text describes.

    Parameters
    ----------
    spec : str
        As above; blanks around names and values are ignored.
    read_measured : callable
        Reads the models of `MEASURED`.

    Raises
    ------
    RangeError
        The model or a key does not exist, a key is missing or twice there, or a value is not what its
        key takes; one sentence that names the key and what it takes.
    InputFileError
        From `read_measured`.
    """
    name, _, rest = (part.strip() for part in spec.partition(":"))
    if name in MEASURED:
        key, _, path = (part.strip() for part in rest.partition("="))
        if key != "path" or not path:
            raise RangeError(f"{name} takes one key, path: write {name}:path=FILE.")
        return read_measured(name, path)
    if name not in MODELS:
        known = *MODELS, *MEASURED
        raise RangeError(
            f'There is no BRDF model "{name}"{did_you_mean(name, known)}: choose one of {", ".join(known)}.'
        )
    try:
        return MODELS[name](**arguments_from_text(MODELS[name], rest, read_measured))
    except RangeError as error:
        raise RangeError(f"{name}: {error}") from error


def is_model(text: str) -> bool:
    """Whether a text begins as one of a model does: with its name and a colon, or with that alone."""
    return text.partition(":")[0].strip() in (*MODELS, *MEASURED)


def spec_from_brdf(brdf: Brdf) -> str:
    """The text that describes a model, the same for the same model.

    Parameters
    ----------
    brdf : Brdf
        One of `MODELS`, or measured.

    Returns
    -------
    str
        Without keys that have their default values; `brdf_from_spec` makes an equal model of it.

    Raises
    ------
    RangeError
        No text can describe the model.
    """
    if isinstance(brdf, Tabulated | Scattered | MeasuredRgl | MeasuredMaterial):
        return brdf.spec
    for name, owner in MODELS.items():
        if type(brdf) is owner:
            return f"{name}:{','.join(_assignments(brdf))}"
    raise RangeError(f"A {type(brdf).__name__} cannot be written as text: describe its parts.")


def with_alpha(spec: str, alpha: float) -> str:
    """A model with another roughness.

    Parameters
    ----------
    spec : str
        As `brdf_from_spec` takes it.
    alpha : float
        Set in every layer that has one.

    Raises
    ------
    RangeError
        No layer has an alpha.
    """
    changed, count = _ALPHA.subn(f"alpha={alpha:g}", spec)
    if not count:
        raise RangeError(
            f'"{spec}" has no alpha to set: write one, as in ggx:alpha=0.3, or set no roughness.'
        )
    return changed


def arguments_from_text(owner: type, text: str, read_measured: ReadMeasured) -> dict[str, Any]:
    """Arguments of a model, or of anything else with parameters like a model's.

    Parameters
    ----------
    owner : type
        A dataclass whose fields are numbers and colours as in `parameters`, names, a `Fresnel`, and models.
    text : str
        ``key=value,key=value``.
    read_measured : callable
        Reads the models of `MEASURED`.

    Returns
    -------
    dict
        Field -> its value, for the fields that the text names; the others have defaults.

    Raises
    ------
    RangeError, InputFileError
        See `brdf_from_spec`.
    """
    values = key_values(text)
    hints = get_type_hints(owner)
    fields = dataclasses.fields(owner)
    keys = [key for field in fields for key in _keys(field.name, hints[field.name])]
    if unknown := [key for key in values if key not in keys]:
        raise RangeError(f"it has no parameter {unknown[0]}: choose from {', '.join(keys)}.")
    arguments: dict[str, Any] = {}
    for field in fields:
        kind, value = hints[field.name], values.get(field.name)
        if kind is Fresnel:
            arguments[field.name] = _fresnel(values)
        elif value is None:
            if field.default is dataclasses.MISSING:
                raise RangeError(f"{field.name} is missing; it must be {_taken(owner, field.name, kind)}.")
        elif kind is str:
            arguments[field.name] = value
        elif kind is Brdf:
            arguments[field.name] = _inner(field.name, value, read_measured)
        elif kind == tuple[Brdf, ...]:
            arguments[field.name] = tuple(
                _inner(field.name, part, read_measured) for part in _split(value, "+")
            )
        else:
            arguments[field.name] = _number(owner, field.name, value)
    return arguments


def key_values(text: str) -> dict[str, str]:
    """The text of each value of ``key=value,key=value``.

    Raises
    ------
    RangeError
        It is no such text, or a key appears twice.
    """
    values: dict[str, str] = {}
    for part in _split(text, ",") if text else ():
        key, _, value = (piece.strip() for piece in part.partition("="))
        if not key or not value:
            raise RangeError(f'"{part.strip()}" is not of the form key=value.')
        if key in values:
            raise RangeError(f"{key} appears twice; give it once.")
        values[key] = value
    return values


def _keys(field: str, kind: object) -> tuple[str, ...]:
    return FRESNEL_KEYS if kind is Fresnel else (field,)


def _fresnel(values: dict[str, str]) -> Fresnel:
    given = {key: values[key] for key in FRESNEL_KEYS if key in values}
    if given.keys() == {"metal"}:
        if given["metal"] not in METALS:
            near = did_you_mean(given["metal"], METALS)
            raise RangeError(f'metal is "{given["metal"]}"{near}, but it must be one of {", ".join(METALS)}.')
        return METALS[given["metal"]]
    for kind, needed in ((Index, "eta"), (Schlick, "f0")):
        if needed in given and given.keys() <= parameter_ranges(kind).keys():
            return kind(**{key: _number(kind, key, text) for key, text in given.items()})
    raise RangeError(
        "its reflectance must be one of metal=NAME, eta and k of an index of refraction, "
        "or f0 and f90 of Schlick's approximation."
    )


def _inner(key: str, text: str, read_measured: ReadMeasured) -> Brdf:
    text = text.strip()
    if not (text.startswith("(") and text.endswith(")")):
        raise RangeError(f'{key} is "{text}", but it must be {A_MODEL}.')
    return brdf_from_spec(text[1:-1], read_measured)


def _number(owner: type, key: str, text: str) -> Color:
    try:
        numbers = [float(part) for part in text.split("/")]
    except ValueError:
        numbers = []
    limits, is_color = parameter_ranges(owner)[key]
    if len(numbers) != 1 and not (is_color and len(numbers) == 3):
        raise RangeError(f'{key} is "{text}", but it must be {_taken(owner, key, Color)}.')
    check_numbers(key, numbers, limits)  # before another key is said to be missing
    return numbers[0] if len(numbers) == 1 else (numbers[0], numbers[1], numbers[2])


def _taken(owner: type, key: str, kind: object) -> str:
    """The values that a key takes, in words."""
    if kind is str:
        return "a name"
    if key not in parameter_ranges(owner):
        return A_MODEL
    limits, is_color = parameter_ranges(owner)[key]
    return f"{'one number, or three as red/green/blue,' if is_color else 'a number'} {limits}"


def _split(text: str, separator: str) -> list[str]:
    """Parts of `text` between separators that are not in parentheses."""
    depth, parts = 0, [""]
    for character in text:
        depth += (character == "(") - (character == ")")
        if depth > DEEPEST:
            raise RangeError(f"models are nested more than {DEEPEST} deep: name fewer layers.")
        if depth < 0:
            break
        if character == separator and depth == 0:
            parts.append("")
        else:
            parts[-1] += character
    if depth != 0:
        raise RangeError(f'the parentheses in "{text}" do not match; put each model within one pair.')
    return parts


def _assignments(owner: Brdf | Fresnel) -> list[str]:
    """Fields that differ from their defaults, as key=value."""
    assignments = []
    for field in dataclasses.fields(owner):  # type: ignore[arg-type]  # its subclasses are dataclasses
        value = getattr(owner, field.name)
        if isinstance(value, Fresnel):
            names = [f"metal={metal}" for metal, index in METALS.items() if index == value]
            assignments += names or _assignments(value)
        elif value not in (field.default, (field.default,) * 3):
            assignments.append(f"{field.name}={_text(value)}")
    return assignments


def _text(value: Any) -> str:
    if isinstance(value, str):
        return value
    if isinstance(value, Brdf):
        return f"({spec_from_brdf(value)})"
    if isinstance(value, tuple):
        texts = [_text(part) for part in value]
        if isinstance(value[0], Brdf):
            return "+".join(texts)
        return texts[0] if len(set(texts)) == 1 else "/".join(texts)
    return np.format_float_positional(value, trim="-")
