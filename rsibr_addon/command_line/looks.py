"""How `rsibr preview` shades each kind of map set, as options."""

import argparse
from typing import Any

from ..core.errors import RangeError
from ..core.options import Declared, declared_options
from ..settings.registry import LOOKS
from .options import add_option, given, help_of


def _by_flag() -> dict[str, dict[str, Declared]]:
    """Flag -> the kinds that have it, and their option."""
    found: dict[str, dict[str, Declared]] = {}
    for kind, look in LOOKS.items():
        for declared in declared_options(look):
            found.setdefault(declared.flag, {})[kind] = declared
    return found


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare every kind's options; those that are not given are not in the namespace."""
    several = parser.add_argument_group("several kinds")
    groups = {kind: parser.add_argument_group(kind.replace("_", " ")) for kind in LOOKS}
    for owners in _by_flag().values():
        if len(owners) == 1:
            ((kind, declared),) = owners.items()
            add_option(groups[kind], declared, help_of(declared))
        else:
            declared = next(iter(owners.values()))
            texts = {kind.replace("_", " "): help_of(each) for kind, each in owners.items()}
            add_option(several, declared, "; ".join(f"of {kind}, {text}" for kind, text in texts.items()))


def look(arguments: argparse.Namespace, kind: str) -> Any:
    """The look that the options ask for.

    Parameters
    ----------
    arguments : Namespace
    kind : str
        Of the map set.

    Returns
    -------
    object
        Of the kind's own type, see `LOOKS`.

    Raises
    ------
    RangeError
        An option is of another kind of map sets, or its value out of range.
    """
    for flag, owners in _by_flag().items():
        name = next(iter(owners.values())).name
        if name in vars(arguments) and kind not in owners:
            kinds = " or ".join(owners)
            raise RangeError(f"The option {flag} is for {kinds}, but this map set holds {kind}: omit it.")
    return given(arguments, LOOKS[kind])
