"""A parser that answers wrong usage with that of the command at fault, and with what may have been meant."""

import argparse
import re
from collections.abc import Callable, Sequence
from typing import Any, NoReturn

from ..core.errors import RsibrError
from ..core.near_names import did_you_mean

_A_FILE = re.compile(r"-[^-].*\.[a-zA-Z]\w*")
"""A word that argparse takes for an option, and is none: it ends as the name of a file does."""

Declare = Callable[["Parser", Sequence[str]], None]
"""Declares a parser's arguments; it may leave out what the words to be parsed do not ask for."""


class UsageError(RsibrError):
    """The words are no command; the message is a phrase.

    Attributes
    ----------
    usage : str
        What to tell before: the usage of the command at fault, and its name.
    """

    def __init__(self, usage: str, message: str) -> None:
        super().__init__(message)
        self.usage = usage


class Parser(argparse.ArgumentParser):
    """A parser of a command, or of commands.

    Parameters
    ----------
    declare : callable
        See `Declare`. It is called when the parser is used, so that only the command that is asked for is
        imported.
    """

    def __init__(self, declare: Declare, **more: Any) -> None:
        super().__init__(allow_abbrev=False, **more)
        self._declare = declare

    def declare(self, words: Sequence[str] = ()) -> None:
        """Declare the arguments, once; without words all of them."""
        self._declare(self, words)
        self._declare = lambda parser, words: None

    def parse_known_args(self, args: Any = None, namespace: Any = None) -> Any:
        """Parse; what is unknown is refused here, and not by the parser of all commands.

        Raises
        ------
        UsageError
        """
        self.declare(args or ())
        self._refuse_unknown_options(args or ())
        found, unknown = super().parse_known_args(args, namespace)
        if unknown:
            self.error(f"unknown arguments: {' '.join(unknown)}")
        return found, unknown

    def error(self, message: str) -> NoReturn:
        """Raise a `UsageError`."""
        raise UsageError(f"{self.format_usage()}{self.prog}", message)

    def _refuse_unknown_options(self, args: Sequence[str]) -> None:
        """Refuse a misspelt option before argparse says that another is missing."""
        for word in args:
            name = word.partition("=")[0]
            if name == "--" or (self._subparsers and not name.startswith("-")):
                return
            if name.startswith("--") and name not in self._option_string_actions:
                self.error(f"there is no option {name}{did_you_mean(name, self._option_string_actions)}")
            if _A_FILE.fullmatch(word) and word[:2] not in self._option_string_actions:
                self.error(f"there is no option {word}: write ./{word} for the file of this name")

    def _get_value(self, action: argparse.Action, arg_string: str) -> Any:
        """The value of a word; an empty one is mostly a variable of a script that is not set."""
        if not arg_string and action.nargs != argparse.PARSER:  # whose words are a command's own
            raise argparse.ArgumentError(action, "it is empty: give a value, or leave it out")
        return super()._get_value(action, arg_string)

    def _check_value(self, action: argparse.Action, value: Any) -> None:
        if action.choices is not None and value not in action.choices:
            known = ", ".join(map(str, action.choices))
            unknown = f"there is no {value}{did_you_mean(value, action.choices)}"
            reason = unknown if str(value).strip() else "it is empty"
            raise argparse.ArgumentError(action, f"{reason}: choose one of {known}")
