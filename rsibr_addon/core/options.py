"""What an option is: a field of a dataclass that says its range, default, unit, choices, label and help.

A dataclass of options derives from `Options`, and is a value's one form in Python. Everything that asks for
such a value is made from the fields: arguments of the command line (`command_line/options.py`), properties of
Blender (`host/option_properties.py`), JSON (`to_plain`, `core.schema.decode`) and the check of ranges.
"""

import dataclasses
import math
import types
from collections.abc import Mapping
from enum import Enum
from functools import cache
from typing import Any, Union, get_args, get_origin, get_type_hints

from .errors import RangeError

OPTION = "option"
"""Key of a field's metadata."""


@dataclasses.dataclass(frozen=True)
class Choice:
    """One of the values that an option may have.

    Attributes
    ----------
    label : str
        What people call it.
    help : str
        What it does, as a phrase without a full stop.
    """

    label: str
    help: str = ""


@dataclasses.dataclass(frozen=True)
class Materials:
    """Where an interface lets one choose a material from, for an option whose value is a material's text.

    Attributes
    ----------
    own : str
        Format of the text for a material of the open file, as "blend::{}"; empty where none can be taken.
    presets : mapping of str to Choice
        Texts to choose from.
    preset : str
        The preset that is chosen first.
    parts : mapping of str to mapping
        Preset -> name of another option -> the text that it has where it is not given.
    model : str
        The reflectance model that is chosen first; empty where models cannot be taken.
    spared : tuple of str
        Names of the options that `instead` has no use for.
    instead : str
        Name of the option that can be given instead of a material, as a file; empty for none.
    """

    own: str = ""
    presets: Mapping[str, Choice] = dataclasses.field(default_factory=dict)
    preset: str = ""
    parts: Mapping[str, Mapping[str, str]] = dataclasses.field(default_factory=dict)
    model: str = ""
    instead: str = ""
    spared: tuple[str, ...] = ()


@dataclasses.dataclass(frozen=True)
class Option:
    """What a field says of itself.

    Attributes
    ----------
    label : str
        What people call it, in capitals as a button has it.
    help : str
        What it does, as a phrase without a full stop.
    unit : str
        Of a number, as "texels".
    least, most : float
        Smallest and largest number.
    soft_least, soft_most : float or None
        Where a slider begins and ends.
    choices : mapping to Choice
        Value -> what it is; empty where values are free. Of several values, each is one of them.
    offered : tuple
        Values that a menu of Blender's offers where others are possible too.
    none : str
        What None stands for, as "what the lobes need".
    none_as : float or tuple or str or None
        The value that stands for None where an interface has no None: 0, zeros, or the empty text. Where it
        is None, such an interface has a switch beside the value, with the label `switch`.
    start : object
        What an interface shows first where the default is None.
    switch : Choice or None
        See `none_as`.
    replaces : tuple of str
        Names of the options that count for nothing where this one is given; it may be None.
    draft, final : object
        The value for the quality of this name; None for the default.
    advanced : bool
        Whether most users never need it.
    flag, old_flag : str
        Name on the command line, empty for the field's; and its name in version 0.1, which goes with 0.3.
    metavar : str
        Stands for the value on the command line.
    subtype : str
        "COLOR", "FILE_PATH" or, of degrees, "ANGLE": how Blender shows it.
    once : bool
        Whether it tells of the files at hand alone, so that Blender forgets it.
    adds : str
        Operator of Blender's that adds to a text which lists several things; empty for none.
    stored : str
        Name of the property that files of Blender hold; empty for the field's.
    materials : Materials or None
        Where the value is a material's text.
    models : tuple of type
        Of a text MODEL:KEY=VALUE, dataclasses with the parameters of each model; see `core.brdf.parameters`.
    """

    label: str
    help: str
    unit: str = ""
    least: float = -math.inf
    most: float = math.inf
    soft_least: float | None = None
    soft_most: float | None = None
    choices: Mapping[Any, Choice] = dataclasses.field(default_factory=dict)
    offered: tuple[Any, ...] = ()
    none: str = ""
    none_as: float | tuple[float, ...] | str | None = None
    start: Any = None
    switch: Choice | None = None
    replaces: tuple[str, ...] = ()
    draft: Any = None
    final: Any = None
    advanced: bool = False
    flag: str = ""
    old_flag: str = ""
    metavar: str = ""
    subtype: str = ""
    once: bool = False
    adds: str = ""
    stored: str = ""
    materials: Materials | None = None
    models: tuple[type, ...] = ()


def option(default: Any = dataclasses.MISSING, *, label: str, help: str, **more: Any) -> Any:
    """A field of an `Options` dataclass.

    Parameters
    ----------
    default : object, optional
        None stands for a value that the program finds; without a default the value has to be given.
    label, help
        See `Option`.
    **more
        The other attributes of `Option`.
    """
    return dataclasses.field(default=default, metadata={OPTION: Option(label, help, **more)})


@dataclasses.dataclass(frozen=True)
class Declared:
    """An option as its dataclass declares it.

    Attributes
    ----------
    name : str
        Of the field.
    wanted : type
        bool, int, float, str, an enumeration, or tuple.
    members : type or None
        Of a tuple: the type of its members.
    count : int or None
        Of a tuple: how many members it has; None for any number.
    optional : bool
        Whether None is a value.
    default : object
        `dataclasses.MISSING` where there is none.
    option : Option
    """

    name: str
    wanted: type
    members: type | None
    count: int | None
    optional: bool
    default: Any
    option: Option

    @property
    def flag(self) -> str:
        """What precedes the value on the command line."""
        return self.option.flag or f"--{self.name.replace('_', '-')}"


class Options:
    """Base of dataclasses whose fields are made by `option`: checks every value.

    Raises
    ------
    RangeError
        A number is out of its range, a value none of the choices, or an option is given that another one
        replaces.
    """

    def __post_init__(self) -> None:
        """Check every value; whoever derives and checks more calls this first."""
        known = {each.name: each for each in declared_options(type(self))}
        for declared in known.values():
            value = getattr(self, declared.name)
            if value is not None or not declared.optional:
                object.__setattr__(self, declared.name, _checked(declared, value))
        for declared in known.values():
            if getattr(self, declared.name) is None:
                continue
            for other in map(known.__getitem__, declared.option.replaces):
                if getattr(self, other.name) != other.default:
                    raise RangeError(
                        f"{declared.option.label} and {other.option.label} say the same in two ways: "
                        "give one of them."
                    )


def declared_options(options: type) -> tuple[Declared, ...]:
    """The options of a dataclass, in the order of its fields.

    Parameters
    ----------
    options : type
        Derived from `Options`.
    """
    return _declared_options(options)


@cache
def _declared_options(options: Any) -> tuple[Declared, ...]:
    hints = get_type_hints(options)
    return tuple(
        _declared(field, hints[field.name])
        for field in dataclasses.fields(options)
        if OPTION in field.metadata
    )


def quality_values(options: type, quality: str) -> dict[str, Any]:
    """What a quality sets.

    Parameters
    ----------
    options : type
        Derived from `Options`.
    quality : {"draft", "good", "final"}
        "good" is every default.

    Returns
    -------
    dict
        Name -> value, of each option that depends on the quality.
    """
    values = {}
    for declared in declared_options(options):
        said = {"draft": declared.option.draft, "final": declared.option.final}
        if said != {"draft": None, "final": None}:
            value = said.get(quality)
            values[declared.name] = declared.default if value is None else value
    return values


def to_plain(options: Any) -> dict[str, Any]:
    """An `Options` dataclass as JSON values, which `core.schema.decode` takes back."""
    return {
        declared.name: _plain(getattr(options, declared.name)) for declared in declared_options(type(options))
    }


def value_from_text(declared: Declared, text: str) -> Any:
    """The value that a text stands for.

    Parameters
    ----------
    declared : Declared
    text : str
        Members of a tuple are separated by commas, unless they are texts, which may hold some: then it is one
        member. One number stands for all of a colour's.

    Returns
    -------
    object
        Not checked against the option's range.

    Raises
    ------
    ValueError
        The text is no such value; the message says what it ought to be.
    """
    if declared.wanted is not tuple:
        return _member_from_text(declared, declared.wanted, text)
    if text in declared.option.choices and declared.members is float:  # a rule's name instead of numbers
        return text
    parts = [text] if declared.members is str else text.split(",")
    if declared.count and len(parts) == 1:
        parts *= declared.count
    if declared.count and len(parts) != declared.count:
        raise ValueError(f"'{text}' is neither a number nor {declared.count} numbers")
    return tuple(_member_from_text(declared, declared.members or str, part) for part in parts)


def value_text(value: Any) -> str:
    """The text of a number or a tuple of numbers, which `value_from_text` takes back."""
    return ",".join(map(str, value)) if isinstance(value, tuple) else str(value)


def number_from_text(text: str) -> float:
    """The number that a text states, which may be a fraction: 0.5, 1/125.

    Raises
    ------
    ValueError
        It states none.
    """
    numerator, slash, denominator = text.partition("/")
    divisor = float(denominator) if slash else 1.0
    return float(numerator) / divisor if divisor else math.nan


def number_text(number: float) -> str:
    """A number as people read it: whole ones with all digits."""
    return str(number) if isinstance(number, int) else f"{number:g}"


def _member_from_text(declared: Declared, wanted: type, text: str) -> Any:
    try:
        return number_from_text(text) if wanted is float else wanted(text)
    except ValueError:
        names = ", ".join(str(_plain(choice)) for choice in declared.option.choices)
        words = [names and f"one of {names}", _WORDS.get(wanted, "")]
        raise ValueError(f"'{text}' is not {' or '.join(filter(None, words))}") from None


_WORDS = {int: "a whole number", float: "a number"}


def _declared(field: dataclasses.Field[Any], hint: Any) -> Declared:
    optional = False
    if get_origin(hint) in (Union, types.UnionType):
        members = get_args(hint)
        optional = types.NoneType in members
        # Of text or numbers, the text is one of the choices
        hint = [each for each in members if each is not types.NoneType][-1]
    kind, inner, count = get_origin(hint) or hint, None, None
    if kind is tuple:
        inner, *rest = get_args(hint)
        count = None if rest == [Ellipsis] else 1 + len(rest)
    return Declared(field.name, kind, inner, count, optional, field.default, field.metadata[OPTION])


def _checked(declared: Declared, value: Any) -> Any:
    """The value, enumerations made of their texts."""
    if declared.wanted is tuple and not isinstance(value, str):
        return tuple(_checked_member(declared, declared.members or str, each) for each in value)
    return _checked_member(declared, declared.wanted, value)


def _checked_member(declared: Declared, wanted: type, value: Any) -> Any:
    choices, told = declared.option.choices, declared.option
    is_number = isinstance(value, int | float)
    # Where numbers may be given, a choice is a name
    if choices and not (is_number and declared.members is float) and value not in choices:
        names = ", ".join(str(_plain(choice)) for choice in choices)
        shown = f"'{value}'" if isinstance(value, str) else value
        raise RangeError(f"{told.label} cannot be {shown}: choose one of {names}.")
    if issubclass(wanted, Enum):
        return wanted(value)
    if is_number and (not told.least <= value <= told.most or abs(value) == math.inf):
        unit = f" {told.unit}" if told.unit else ""
        raise RangeError(f"{told.label} cannot be {number_text(value)}{unit}: choose {_range(told)}.")
    return value


def _range(told: Option) -> str:
    if told.least == -math.inf:
        return "a finite number"
    if told.most == math.inf:
        return f"a number from {number_text(told.least)}"
    return f"{number_text(told.least)} to {number_text(told.most)}"


def _plain(value: Any) -> Any:
    if isinstance(value, Enum):
        return value.value
    return [_plain(each) for each in value] if isinstance(value, tuple) else value
