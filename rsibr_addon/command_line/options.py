"""Arguments of the command line that are made of options."""

import argparse
import math
from collections.abc import Mapping
from dataclasses import MISSING
from functools import partial
from typing import Any, TypeVar

from ..core.errors import RangeError
from ..core.options import Declared, Options, declared_options, number_text, value_from_text

Given = TypeVar("Given", bound=Options)

SEVERAL = "several kinds"
"""Title of the options that more than one kind has, but not all."""


def add_options(parser: Any, options: type[Options]) -> None:
    """Declare the arguments of a dataclass of options.

    Parameters
    ----------
    parser : argparse.ArgumentParser or a group of one
    options : type
        Derived from `Options`. What is not given is not in the namespace.
    """
    for declared in declared_options(options):
        add_option(parser, declared, help_of(declared))


def add_option(parser: Any, declared: Declared, description: str) -> None:
    """Declare the argument of one option, with a text for the help."""
    told = declared.option
    common: dict[str, Any] = {
        "dest": declared.name,
        "help": description.replace("%", "%%"),
        "default": argparse.SUPPRESS,
    }
    if declared.wanted is bool:
        parser.add_argument(declared.flag, action=argparse.BooleanOptionalAction, **common)
        return
    if told.choices and declared.wanted is not tuple:
        common["choices"] = list(told.choices)
        common["metavar"] = told.metavar or None
    else:
        common["metavar"] = told.metavar or _METAVARS[declared.wanted]
    required = declared.default is MISSING
    flags = filter(None, (declared.flag, told.old_flag))
    # Several choices may be given one by one; numbers belong together, and a rule's name may stand for them
    several = declared.wanted is tuple and declared.count is None and declared.members is not float
    action = "extend" if several else "store"
    parser.add_argument(*flags, type=partial(_value, declared), required=required, action=action, **common)


def given(arguments: argparse.Namespace, options: type[Given]) -> Given:
    """The options that a command line gives, and the defaults of the others.

    Raises
    ------
    RangeError
        A value is out of its range.
    """
    names = {declared.name for declared in declared_options(options)}
    return options(**{name: value for name, value in vars(arguments).items() if name in names})


def add_options_of(parser: argparse.ArgumentParser, owners: Mapping[str, type[Options]]) -> None:
    """Declare the arguments of several dataclasses, of which one will be asked for.

    Parameters
    ----------
    parser : argparse.ArgumentParser
    owners : mapping of str to type
        What has the options, a kind of map sets for example, -> them. What several have is declared once.
    """
    groups: dict[str, Any] = {}

    def group(title: str) -> Any:
        if title not in groups:
            groups[title] = parser.add_argument_group(title)
        return groups[title]

    for declared in _by_flag(owners).values():
        texts = {owner.replace("_", " "): help_of(each) for owner, each in declared.items()}
        first = next(iter(declared.values()))
        if len(declared) == 1:
            add_option(group(next(iter(texts))), first, help_of(first))
        elif len(set(texts.values())) == 1:
            add_option(group(SEVERAL) if len(declared) < len(owners) else parser, first, help_of(first))
        else:
            told = "; ".join(f"of {owner}, {text}" for owner, text in texts.items())
            add_option(group(SEVERAL), first, told)


def given_of(
    arguments: argparse.Namespace, owners: Mapping[str, type[Options]], owner: str, beside: str = ""
) -> Any:
    """The options of one of several owners that a command line gives.

    Parameters
    ----------
    arguments : Namespace
    owners
        See `add_options_of`.
    owner : str
        The one that counts.
    beside : str, optional
        Another whose options may be given beside.

    Raises
    ------
    RangeError
        An option of others is given, or a value is out of its range.
    """
    for flag, declared in _by_flag(owners).items():
        name = next(iter(declared.values())).name
        if name in vars(arguments) and not {owner, beside} & declared.keys():
            raise RangeError(f"The option {flag} is for {' or '.join(declared)}, not for {owner}: omit it.")
    return given(arguments, owners[owner])


def _by_flag(owners: Mapping[str, type[Options]]) -> dict[str, dict[str, Declared]]:
    """Flag -> the owners that have it, and their option."""
    found: dict[str, dict[str, Declared]] = {}
    for owner, options in owners.items():
        for declared in declared_options(options):
            found.setdefault(declared.flag, {})[owner] = declared
    return found


def help_of(declared: Declared) -> str:
    """What an option does, its choices, unit, range and default."""
    told = declared.option
    text = told.help if told.help[1:2].isupper() else told.help[:1].lower() + told.help[1:]
    if any(choice.help for choice in told.choices.values()):
        text += ": " + "; ".join(f"{_shown(value)}, {choice.help}" for value, choice in told.choices.items())
    elif told.choices and told.metavar:
        text += f": {', '.join(map(_shown, told.choices))}"
    return f"{text} ({'; '.join(filter(None, (told.unit, _range(declared), _default(declared))))})"


def _range(declared: Declared) -> str:
    least, most = declared.option.least, declared.option.most
    if least == -math.inf:
        return ""
    return (
        f"from {number_text(least)}" if most == math.inf else f"{number_text(least)} to {number_text(most)}"
    )


def _default(declared: Declared) -> str:
    if declared.default is MISSING:
        return "required"
    if declared.default is None:
        return f"default: {declared.option.none}"
    return f"default: {_shown(declared.default)}"


def _shown(value: Any) -> str:
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, tuple):
        same = len(set(value)) == 1
        return ",".join(map(_shown, value[:1] if same else value)) or "all"
    return number_text(value) if isinstance(value, float) else str(value)


def _value(declared: Declared, text: str) -> Any:
    try:
        return value_from_text(declared, text)
    except ValueError as error:
        raise argparse.ArgumentTypeError(str(error)) from error


_METAVARS: dict[type, str] = {int: "N", float: "X", str: "TEXT", tuple: "X,X,..."}
