"""Properties for an option that is a text MODEL:KEY=VALUE: its model, and a slider or a colour for each key.

They keep nothing themselves: what they show is read from the text, and what is set becomes the text.
"""

from contextlib import suppress
from typing import Any, NoReturn

import bpy
import numpy as np

from ..core.brdf.fresnel import Index
from ..core.brdf.metals import METALS
from ..core.brdf.parameters import Range, parameter_ranges
from ..core.brdf.spec import arguments_from_text
from ..core.errors import RsibrError
from ..core.options import Declared, declared_options
from ..files.map_set import read_map_set_header
from ..files.read_once import read_once
from . import weight_curves
from .map_sets import written_path

NONE = "none"
"""The text of an option that names no model."""

_STARTS = {"kd": 0.5, "ks": 0.5, "n": 50.0, "eta": 1.5, "k": 0.5, "tint": 1.0, "radiance": 0.0}
"""What a key has first where the text does not say it."""

_START_BRDF = "lambert:kd=1"
"""The model within a model, likewise."""

_SOFT = {"n": (1.0, 1000.0), "eta": (1.0, 3.0), "radiance": (0.0, 10.0)}
"""Ends of sliders of wide ranges."""

_LABELS = {
    "n": "Exponent",
    "eta": "IOR",
    "k": "Share",
    "tint": "Tint",
    "radiance": "Radiance",
}


def model_properties(options: type, declared: Declared, common: dict[str, Any]) -> dict[str, Any]:
    """The properties `NAME_model` and `NAME_KEY` of an option NAME, beside the one of its text.

    Parameters
    ----------
    options : type
        Has the option.
    declared : Declared
    common : dict
        Of all properties of the group.
    """
    part = _Part(options, declared)
    common = {**common, "options": {"SKIP_SAVE"}}
    found: dict[str, Any] = {}
    names = [owner.model for owner in declared.option.models if hasattr(owner, "model")]
    if names:
        items = [(NONE, "None", "No such part"), *((name, name.capitalize(), "") for name in names)]
        found[f"{declared.name}_model"] = bpy.props.EnumProperty(
            name=declared.option.label,
            description=declared.option.help,
            items=items,
            get=lambda group: [NONE, *names].index(part.said(group)[0]),
            set=lambda group, number: part.choose(group, [NONE, *names][number]),
            **common,
        )
    for key, (limits, is_color) in part.keys.items():
        found[f"{declared.name}_{key}"] = _number(part, key, limits, is_color, common)
    if part.has_metals:
        metals = [NONE, *METALS]
        found[f"{declared.name}_metal"] = bpy.props.EnumProperty(
            name="Metal",
            description="A metal's index of refraction instead of a number",
            items=[(NONE, "None", ""), *((metal, metal.capitalize(), "") for metal in METALS)],
            get=lambda group: metals.index(part.said(group)[1].get("metal", NONE)),
            set=lambda group, number: part.change(group, "metal", metals[number]),
            **common,
        )
    if any(hasattr(owner, "CURVES") for owner in declared.option.models):
        found[f"{declared.name}_curves"] = bpy.props.PointerProperty(type=bpy.types.NodeTree)
    return found


def shown_keys(declared: Declared, group: Any) -> list[str]:
    """Names of the properties that the model has which a group's text names."""
    owner = _named(declared, getattr(group, f"{declared.name}_model", NONE))
    if owner is None:
        return []
    keys = [f"{declared.name}_{key}" for key in _keys(owner)]
    if not _has_fresnel(owner):
        return keys
    metal = f"{declared.name}_metal"
    return [metal, *(keys if getattr(group, metal) == NONE else [])]


def curves_of(declared: Declared, group: Any) -> tuple[str, ...]:
    """Names of the curves of the model that a group's text names."""
    return getattr(_named(declared, getattr(group, f"{declared.name}_model", NONE)), "CURVES", ())


def text_of_curves(declared: Declared, group: Any) -> str | None:
    """The text that a group's curves say; None where it has none."""
    tree = getattr(group, f"{declared.name}_curves")
    return tree and f"curve:{weight_curves.text(tree)}"


def take_curves(declared: Declared, group: Any) -> None:
    """Have a group's text say what its curves do.

    Curves that a copy of the group has as well, as after a duplication, stay for that as they were.
    """
    name, before = f"{declared.name}_curves", getattr(group, declared.name)
    tree = getattr(group, name)
    if tree is None or text_of_curves(declared, group) == before or not before.startswith("curve:"):
        return
    if tree.users > 1:
        setattr(group, name, tree.copy())
        weight_curves.draw(tree, before.partition(":")[2])
    setattr(group, declared.name, text_of_curves(declared, group))


class _Part:
    """An option, as its text is read and written."""

    def __init__(self, options: type, declared: Declared) -> None:
        self._options, self._declared = options, declared
        self.keys = {key: told for owner in declared.option.models for key, told in _keys(owner).items()}
        self.has_metals = any(map(_has_fresnel, declared.option.models))

    def said(self, group: Any) -> tuple[str, dict[str, Any]]:
        """The model's name, and a value for each key; none of a text that is wrong."""
        return _parsed(self._declared.option.models, self._text(group))

    def choose(self, group: Any, name: str) -> None:
        """Have the text name another model; keys that both have keep their values."""
        if name == NONE:
            self._write(group, NONE)
            return
        owner = _named(self._declared, name)
        if hasattr(owner, "CURVES"):
            self._draw_curves(group, owner.CURVES)
            return
        self._write(group, _written(owner, self.said(group)[1]))

    def change(self, group: Any, key: str, value: Any) -> None:
        """Have the text say another value of a key; nothing where it says it already."""
        name, values = self.said(group)
        owner = _named(self._declared, name)
        if owner is not None and key in {*_keys(owner), "metal"} and values.get(key) != value:
            self._write(group, _written(owner, {**values, key: value}))

    def _draw_curves(self, group: Any, names: tuple[str, ...]) -> None:
        name = f"{self._declared.name}_curves"
        if getattr(group, name) is None:
            setattr(group, name, weight_curves.new_tree(names, self._text(group).partition(":")[2]))
        self._write(group, text_of_curves(self._declared, group) or NONE)

    def _write(self, group: Any, text: str) -> None:
        if text != self._text(group):
            setattr(group, self._declared.name, text)

    def _text(self, group: Any) -> str:
        """The text that counts: the group's, or else that of its preset, or of what was baked."""
        own = getattr(group, self._declared.name)
        if own:
            return str(own)
        for each in declared_options(self._options):
            if each.option.materials and each.option.materials.parts:
                parts = each.option.materials.parts.get(group.preset, {})
                return str(parts.get(self._declared.name, NONE))
        with suppress(RsibrError, AttributeError):  # none, or one that cannot be read
            return str(_material(written_path(group.id_data.rsibr)).get(self._declared.name, NONE))
        return NONE


@read_once
def _material(path: Any) -> dict[str, Any]:
    material: dict[str, Any] = read_map_set_header(path)["material"]
    return material


def _named(declared: Declared, name: str) -> Any:
    """The model of a name; of an option whose one model has no name, that; None where there is none."""
    models: tuple[Any, ...] = declared.option.models
    return next((each for each in models if getattr(each, "model", NONE) == name), None)


def _keys(owner: type) -> dict[str, tuple[Range, bool]]:
    """The numbers of a model, of those with a Fresnel term a dielectric's index."""
    return {"eta": (Range(0.1, 10.0), False)} if _has_fresnel(owner) else parameter_ranges(owner)


def _has_fresnel(owner: type) -> bool:
    return "fresnel" in owner.__annotations__


def _parsed(models: tuple[Any, ...], text: str) -> tuple[str, dict[str, Any]]:
    name, _, rest = text.partition(":")
    for owner in models:
        named = hasattr(owner, "model")
        if named and owner.model != name:
            continue
        given = rest if named else f"{next(iter(_keys(owner)))}={text}"
        try:
            made = owner(**arguments_from_text(owner, given, _none_measured))
        except RsibrError:
            return (name if named else NONE), {}
        if not _has_fresnel(owner):
            return (name if named else NONE), {key: getattr(made, key) for key in _keys(owner)}
        fresnel = made.fresnel
        metal = next((metal for metal, index in METALS.items() if index == fresnel), NONE)
        eta = float(np.mean(fresnel.eta)) if isinstance(fresnel, Index) and metal == NONE else _STARTS["eta"]
        return name, {"eta": eta, "metal": metal}
    return NONE, {}


def _none_measured(kind: str, path: str) -> NoReturn:
    raise AssertionError(f"{kind} {path}")


def _written(owner: Any, values: dict[str, Any]) -> str:
    if _has_fresnel(owner) and values.get("metal", NONE) != NONE:
        return f"{owner.model}:metal={values['metal']}"
    if "brdf" in owner.__annotations__:
        return f"{owner.model}:brdf=({_START_BRDF})"
    texts = {key: _text_of(values.get(key, _STARTS.get(key, 1.0))) for key in _keys(owner)}
    if not hasattr(owner, "model"):
        return NONE if set(texts.values()) == {"0"} else next(iter(texts.values()))
    return f"{owner.model}:{','.join(f'{key}={text}' for key, text in texts.items())}"


def _text_of(value: Any) -> str:
    """A number, or a colour, to the digits of single precision."""
    if isinstance(value, float):
        return f"{value:.7g}"
    texts = [f"{member:.7g}" for member in value]
    return texts[0] if len(set(texts)) == 1 else "/".join(texts)


def _number(part: _Part, key: str, limits: Range, is_color: bool, common: dict[str, Any]) -> Any:
    low, high = _SOFT.get(key, (limits.low, limits.high))
    told = {
        "name": _LABELS.get(key, key),
        "min": limits.low,
        "max": limits.high,
        "soft_min": low,
        "soft_max": high,
        **common,
    }
    if is_color:
        grey = (_STARTS[key],) * 3
        return bpy.props.FloatVectorProperty(
            subtype="COLOR",
            size=3,
            get=lambda group: part.said(group)[1].get(key, grey),
            set=lambda group, value: part.change(group, key, tuple(map(_decimal, value))),
            **told,
        )
    return bpy.props.FloatProperty(
        get=lambda group: part.said(group)[1].get(key, _STARTS[key]),
        set=lambda group, value: part.change(group, key, _decimal(value)),
        **told,
    )


def _decimal(number: float) -> float:
    """The decimal that single precision is nearest to."""
    return float(f"{number:.7g}")
