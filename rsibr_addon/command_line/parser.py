"""A parser that answers wrong usage with that of the command at fault, and with what may have been meant."""

import argparse
from collections.abc import Sequence
from typing import Any

from ..core.near_names import did_you_mean


class Parser(argparse.ArgumentParser):
    """A parser of a command, or of commands."""

    def parse_known_args(self, args: Any = None, namespace: Any = None) -> Any:
        """Parse; what is unknown ends the process here, and not in the parser of all commands."""
        self._refuse_unknown_options(args or ())
        found, unknown = super().parse_known_args(args, namespace)
        if unknown:
            self.error(f"unknown arguments: {' '.join(unknown)}")
        return found, unknown

    def _refuse_unknown_options(self, args: Sequence[str]) -> None:
        """Refuse a misspelt option before argparse says that another is missing."""
        for word in args:
            name = word.partition("=")[0]
            if name == "--" or (self._subparsers and not name.startswith("-")):
                return
            if name.startswith("--") and name not in self._option_string_actions:
                self.error(f"there is no option {name}{did_you_mean(name, self._option_string_actions)}")

    def _check_value(self, action: argparse.Action, value: Any) -> None:
        if action.choices is not None and value not in action.choices:
            known = ", ".join(map(str, action.choices))
            raise argparse.ArgumentError(
                action, f"there is no {value}{did_you_mean(value, action.choices)}: choose one of {known}"
            )
