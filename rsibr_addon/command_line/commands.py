"""The commands, and what a command line asks for."""

import argparse
import os
from collections.abc import Sequence
from typing import Any

from . import (
    bake,
    compare,
    convert,
    export,
    fit,
    illuminate,
    info,
    job,
    preview,
    report,
)
from .parser import Parser

COMMANDS = {
    "bake": bake,
    "preview": preview,
    "compare": compare,
    "info": info,
    "convert": convert,
    "illuminate": illuminate,
    "fit": fit,
    "report": report,
    "export": export,
    "job": job,
}
"""Name -> what has its arguments and its run; or with `KINDS`, such commands in turn."""

OLD_NAMES = {
    "capture": "radiance-views",
    "tables": "reflection-tables",
    "mips": "mip-chain",
    "bank": "kernel-bank",
}
"""Commands of version 0.1 -> the kind that `bake` makes for them; they go with version 0.3."""

OLD_DEFAULTS = {
    "radiance-views": {"--samples": "--samples=64", "--denoise": "--no-denoise"},
    "lobe-stack": {"--half": "--no-half"},
}
"""Kind -> options that had another default in version 0.1, and what gives that to its command."""


def parsed(argv: Sequence[str]) -> argparse.Namespace:
    """What a command line asks for.

    Parameters
    ----------
    argv : sequence of str
        The arguments after `rsibr`.

    Returns
    -------
    argparse.Namespace
        The command's own arguments; its function, `run`; `json`, `progress`, `verbose` and `log`.

    Raises
    ------
    SystemExit
        The usage is wrong, or help was asked for; that is printed.
    """
    return parser().parse_args(_with_joined_directions(_with_todays_names(argv)))


def _with_todays_names(argv: Sequence[str]) -> Sequence[str]:
    """`bake JOB.json` under the name of what does it, and what was called otherwise in version 0.1."""
    name, rest = (argv[0], argv[1:]) if argv else ("", argv)
    if name in OLD_NAMES:
        return _as_in_version_01(OLD_NAMES[name], rest)
    if name == "bake" and rest and rest[0].endswith(".json"):
        return ["job", *rest]
    if name == "bake" and rest and rest[0].startswith("--") and rest[0] != "--help":
        return _as_in_version_01("lobe-stack", rest)
    return argv


def _as_in_version_01(kind: str, rest: Sequence[str]) -> Sequence[str]:
    """A command by its old name, with its old defaults: jobs of then leave options out."""
    said = {word.partition("=")[0].replace("--no-", "--") for word in rest}
    defaults = [given for option, given in OLD_DEFAULTS.get(kind, {}).items() if option not in said]
    return ["bake", kind, *rest, *defaults]


def parser() -> Parser:
    """What reads a command line: all commands, and their options with help."""
    common = argparse.ArgumentParser(add_help=False)
    common.add_argument("--json", action="store_true", help="print the result as one JSON object")
    common.add_argument(
        "--progress",
        choices=["auto", "bar", "json", "none"],
        default="auto",
        help="progress on standard error: a bar, JSON lines or nothing (default: a bar on a terminal)",
    )
    heard = common.add_mutually_exclusive_group()
    heard.add_argument(
        "--verbose",
        action="store_true",
        help="show the output of Blender and its libraries too, on standard error",
    )
    heard.add_argument(
        "--log",
        metavar="FILE",
        default=os.devnull,
        help="append the output of Blender and its libraries to a file",
    )
    parser = Parser(prog="rsibr", description="Prefiltered reflection maps with Blender.")
    commands = parser.add_subparsers(metavar="COMMAND", required=True)
    for name, module in COMMANDS.items():
        if hasattr(module, "KINDS"):
            summary = _summary(module)
            family = commands.add_parser(name, help=summary, description=summary, allow_abbrev=False)
            kinds = family.add_subparsers(metavar="KIND", required=True)
            for kind, member in module.KINDS.items():
                _add_command(kinds, kind, member, common)
        else:
            _add_command(commands, name, module, common)
    return parser


def _add_command(commands: Any, name: str, module: Any, common: argparse.ArgumentParser) -> None:
    summary = _summary(module)
    command = commands.add_parser(
        name, help=summary, description=summary, parents=[common], allow_abbrev=False
    )
    module.add_arguments(command)
    command.set_defaults(run=module.run)


def _summary(command: Any) -> str:
    return getattr(command, "summary", None) or (command.__doc__ or "").splitlines()[0]


def _with_joined_directions(argv: Sequence[str]) -> list[str]:
    """Make `--view -1,0,0` one argument: argparse would take -1,0,0 for an option."""
    joined: list[str] = []
    for argument in argv:
        if joined and joined[-1] in ("--view", "--point"):
            joined[-1] = f"{joined[-1]}={argument}"
        else:
            joined.append(argument)
    return joined
