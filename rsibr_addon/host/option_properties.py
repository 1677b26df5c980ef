"""Properties of Blender, made of options; and the options that properties say."""

import math
import re
from collections.abc import Callable, Collection
from dataclasses import MISSING
from enum import Enum
from functools import cache
from typing import Any, TypeVar

import bpy

from ..core.errors import RangeError
from ..core.options import Declared, Materials, Options, declared_options, value_from_text, value_text
from ..files.measured_files import MEASURED_FORMATS, measured_spec
from .bake_settings import existing
from .model_properties import model_properties

Given = TypeVar("Given", bound=Options)
Update = Callable[[bpy.types.PropertyGroup, bpy.types.Context | None], None] | None

OWN, PRESET, MODEL, FILE = "OWN", "PRESET", "MODEL", "FILE"
"""Where a material is taken from."""

NONE = "none"
"""The preset that is none."""

LARGEST = 2**31 - 1
"""Blender's whole numbers end there."""


def properties_of(options: type[Options], update: Update = None, by_text: bool = False) -> dict[str, Any]:
    """The properties of a dataclass of options.

    Parameters
    ----------
    options : type
        Derived from `Options`.
    update : callable, optional
        What Blender calls after a change.
    by_text : bool
        Whether a material is given by its text, as on the command line, and not by where it is from.

    Returns
    -------
    dict
        Name -> property. An option that may be None and has a switch has a property `use_NAME` besides; one
        that names a model, those of `model_properties`.
    """
    found: dict[str, Any] = {}
    for declared in declared_options(options):
        common = {"update": update} if update else {}
        materials = declared.option.materials
        if materials is not None and not (by_text and materials.own):
            found |= _of_materials(declared, materials, common)
            continue
        if declared.option.switch is not None:
            switch = declared.option.switch
            found[f"use_{property_name(declared)}"] = bpy.props.BoolProperty(
                name=switch.label, description=switch.help, **common
            )
        found[property_name(declared)] = _property(declared, common, by_text)
        if declared.option.models and not by_text:
            found |= model_properties(options, declared, common)
    return found


def group_of(name: str, text: str, properties: dict[str, Any]) -> type[bpy.types.PropertyGroup]:
    """A class of properties.

    Parameters
    ----------
    name : str
        Of the class.
    text : str
        Its docstring.
    properties : dict
        See `properties_of`.
    """
    return type(name, (bpy.types.PropertyGroup,), {"__doc__": text, "__module__": __name__, **properties})


def property_name(declared: Declared) -> str:
    """The name of an option's property."""
    return declared.option.stored or declared.name


def model_property(options: type[Options]) -> str:
    """The name of the property that has a material's model as a text.

    Parameters
    ----------
    options : type
        With an option whose `Materials` can be models.
    """
    (declared,) = (
        each for each in declared_options(options) if each.option.materials and each.option.materials.model
    )
    return property_name(declared)


def options_of(options: type[Given], group: Any, own: str = "", without: Collection[str] = ()) -> Given:
    """The options that properties say.

    Parameters
    ----------
    options : type
        What `properties_of` made the properties of.
    group : bpy.types.PropertyGroup or bpy.types.Operator
    own : str
        Name of the material to take where the properties say so.
    without : collection of str
        Names of options that keep their defaults, whatever the properties say.

    Raises
    ------
    RangeError
        Values do not go together.
    InputFileError
        A file is not there, or not of a known format.
    """
    values = {each.name: _value(each, group, own) for each in declared_options(options)}
    source = getattr(group, "source", None)
    for each in declared_options(options):
        materials = each.option.materials
        if materials is None or not materials.instead or source is None:
            continue
        unused = materials.spared if source == materials.instead.upper() else (materials.instead,)
        for name in unused:
            del values[name]
        if materials.instead in values:
            file = values[materials.instead] or ""
            values[materials.instead] = existing(file, materials.instead, "its file")
    for name in replaced_options(options, group).union(without):
        values.pop(name, None)
    return options(**values)


def replaced_options(options: type[Options], group: Any) -> set[str]:
    """Names of the options that count for nothing, because one is given that replaces them.

    Parameters
    ----------
    options : type
        What `properties_of` made the properties of.
    group : bpy.types.PropertyGroup or bpy.types.Operator
    """
    return {
        name
        for each in declared_options(options)
        if each.option.replaces and getattr(group, f"use_{property_name(each)}")
        for name in each.option.replaces
    }


def said_by(options: type, group: Any) -> tuple[Any, ...]:
    """All that properties say, to tell whether anything has changed; hashable, and never raises.

    Parameters
    ----------
    options : type
        What `properties_of` made the properties of.
    group : bpy.types.PropertyGroup
    """
    values = [getattr(group, name) for name in _names_of(options)]
    return tuple(
        each
        if isinstance(each, str | float | int)
        else frozenset(each)
        if isinstance(each, set)
        else tuple(each)
        for each in values
    )


@cache
def _names_of(options: type) -> tuple[str, ...]:
    """Names of the properties that say options; found once, as every redraw of every object reads these."""
    names = []
    for declared in declared_options(options):
        names.append(property_name(declared))
        if declared.option.switch is not None:
            names.append(f"use_{property_name(declared)}")
    return tuple(names)


def show_option(declared: Declared, group: Any, value: Any) -> None:
    """Have a property say the value of an option, which is no material."""
    name = property_name(declared)
    if value is None and declared.option.none_as is None:
        setattr(group, f"use_{name}", False)
    else:
        setattr(group, name, shown_value(declared, value))


def shown_value(declared: Declared, value: Any) -> Any:
    """A value of an option, which is no material, as its property has it."""
    if value is None:
        return declared.option.none_as
    if _is_list(declared):
        return value_text(value)
    return str(value) if _items(declared) else value


def _of_materials(declared: Declared, materials: Materials, common: dict[str, Any]) -> dict[str, Any]:
    items = []
    found: dict[str, Any] = {}
    if materials.own:
        items.append((OWN, "Own", "The active object's active material, whatever its nodes"))
    nothing = [(NONE, "None", _capital(declared.option.none))] if declared.optional else []
    if materials.presets:
        items.append((PRESET, "Preset", "One that comes with the extension"))
        found["preset"] = bpy.props.EnumProperty(
            name="Preset" if materials.own else declared.option.label,
            description="Material that comes with the extension",
            items=_enum(materials.presets) + nothing,
            default=materials.preset,
            **common,
        )
    if materials.model:
        items.append((MODEL, "Model", "A reflectance model and its parameters"))
        items.append((FILE, "Measured", "A file of measurements"))
        found[property_name(declared)] = bpy.props.StringProperty(
            name=declared.option.label,
            description=declared.option.help,
            default=materials.model,
            **common,
        )
        found["path"] = bpy.props.StringProperty(
            name="File",
            description=f"Measurement of the MERL, Cornell or RGL database: {', '.join(MEASURED_FORMATS)}",
            subtype="FILE_PATH",
            options={"PATH_SUPPORTS_BLEND_RELATIVE"},
            **common,
        )
    if materials.instead:
        instead = materials.instead
        items.append((instead.upper(), instead.capitalize(), "A file that was made before"))
    if len(items) == 1:
        return found
    source = bpy.props.EnumProperty(
        name="Material",
        description="Where the material is taken from",
        items=items,
        default=MODEL if materials.model and not materials.presets else OWN,
        **common,
    )
    return {"source": source, **found}


def _property(declared: Declared, common: dict[str, Any], by_text: bool) -> Any:
    told = declared.option
    common = {"name": told.label, "description": _description(declared), **common}
    flags = {"SKIP_SAVE": told.once, "PATH_SUPPORTS_BLEND_RELATIVE": told.subtype == "FILE_PATH"}
    if any(flags.values()):
        common["options"] = {flag for flag, is_set in flags.items() if is_set}
    items = _items(declared, by_text)
    if items and declared.wanted is tuple and isinstance(declared.default, tuple):
        chosen = {_identifier(value) for value in declared.default}
        return bpy.props.EnumProperty(items=items, options={"ENUM_FLAG"}, default=chosen, **common)
    default: Any = next(
        each for each in (declared.default, told.start, told.none_as, "") if each not in (None, MISSING, ())
    )
    if items:
        return bpy.props.EnumProperty(items=items, default=_identifier(default), **common)
    if declared.wanted is bool:
        return bpy.props.BoolProperty(default=default, **common)
    if declared.wanted is str or _is_list(declared):
        return bpy.props.StringProperty(default=default, subtype=told.subtype or "NONE", **common)
    least = min(told.least, 0.0) if told.none_as in (0.0, (0.0, 0.0, 0.0)) else told.least
    if int in (declared.wanted, declared.members):
        low, high = max(least, -LARGEST), min(told.most, LARGEST)
        soft = {} if told.soft_most is None else {"soft_max": int(told.soft_most)}
        return bpy.props.IntProperty(default=int(default or 0), min=int(low), max=int(high), **soft, **common)
    ends = {
        "min": least,
        "max": told.most,
        "soft_min": told.soft_least,
        "soft_max": told.soft_most,
    }
    of_blender = math.radians if told.subtype == "ANGLE" else float
    limits = {name: of_blender(end) for name, end in ends.items() if end is not None and math.isfinite(end)}
    if declared.count:
        return bpy.props.FloatVectorProperty(
            default=default, size=declared.count, subtype=told.subtype or "NONE", **limits, **common
        )
    return bpy.props.FloatProperty(
        default=of_blender(default or 0.0), subtype=told.subtype or "NONE", **limits, **common
    )


def _is_list(declared: Declared) -> bool:
    """Whether it is numbers, as many as one likes, which Blender has as a text."""
    told = declared.option
    return declared.wanted is tuple and declared.count is None and not (told.choices or told.switch)


def _description(declared: Declared) -> str:
    told = declared.option
    unit = f" ({told.unit})" if told.unit else ""
    if told.none and told.none_as is not None:
        stands = "empty" if told.none_as == "" else "0"
        return f"{told.help}{unit}; {stands}: {told.none}"
    return f"{told.help}{unit}"


def _items(declared: Declared, by_text: bool = False) -> list[tuple[str, str, str]]:
    told = declared.option
    if told.offered and not by_text:
        return [(str(value), str(value), "") for value in told.offered]
    return _enum(told.choices)


def _enum(choices: Any) -> list[tuple[str, str, str]]:
    return [(_identifier(value), choice.label, _capital(choice.help)) for value, choice in choices.items()]


def _capital(words: str) -> str:
    return words[:1].upper() + words[1:]


def _identifier(value: Any) -> str:
    return str(value.value if isinstance(value, Enum) else value)


def _value(declared: Declared, group: Any, own: str) -> Any:
    told, name = declared.option, property_name(declared)
    if told.materials is not None:
        return _material(declared, group, own)
    if told.switch is not None and not getattr(group, f"use_{name}"):
        return declared.default
    value = _plain(getattr(group, name), told.subtype)
    if value == told.none_as and declared.optional:
        return None
    if isinstance(value, str):
        value = _absolute(value)
    if _is_list(declared):
        try:
            return value_from_text(declared, ",".join(value.replace(",", " ").split()))
        except ValueError as error:
            raise RangeError(f"{told.label}: {error}: give numbers, as 0.5 or 1/125.") from error
    if declared.wanted is int:
        return int(value)
    if declared.wanted is tuple and not isinstance(value, str):
        # Flags in the order of the choices; a colour's numbers, which stay when the property's change
        chosen = value if not isinstance(value, set) else [each for each in told.choices if each in value]
        return (chosen,) if isinstance(chosen, int) else tuple(chosen)
    return value


def _absolute(text: str) -> str:
    """A path, or a text that names files, without the ``//`` of Blender's own window."""
    return re.sub(r"(^|=\s*)(//[^,;)]*)", lambda found: found[1] + bpy.path.abspath(found[2]), text)


def _plain(value: Any, subtype: str) -> Any:
    """A property's value: the decimal that its single precision is nearest to, degrees of radians."""
    if isinstance(value, float):
        return float(f"{math.degrees(value) if subtype == 'ANGLE' else value:.7g}")
    if isinstance(value, str | int | set):
        return value
    return tuple(_plain(member, subtype) for member in value)


def _material(declared: Declared, group: Any, own: str) -> str | None:
    materials = declared.option.materials
    assert materials is not None
    text = getattr(group, property_name(declared), "")
    match getattr(group, "source", None):
        case "FILE":
            return measured_spec(existing(group.path, "measured material", "its file"))
        case "MODEL":
            return _absolute(str(text))
        case other if other == materials.instead.upper():
            return None
        case "OWN":
            return materials.own.format(own)
        case None if materials.own:  # by its text
            return _absolute(str(text)) or (materials.own.format(own) if own else None)
    return None if group.preset == NONE else str(group.preset)
