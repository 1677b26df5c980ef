"""The commands, and what a command line asks for."""

import argparse
import os
from collections.abc import Mapping, Sequence
from functools import partial
from importlib import import_module
from itertools import pairwise
from typing import Any, NoReturn

from ..core.errors import RsibrError
from ..core.threads import MOST, VARIABLE, limited, thread_count
from .parser import Parser

COMMANDS = {
    "bake": "Make a map set: filter, capture or tabulate an environment.",
    "batch": "Bake many map sets on all cores: materials in environments, with one page of all.",
    "submit": "Have a farm bake a batch.",
    "preview": "Draw a mesh shaded from a map set, once or as a turntable.",
    "render": "Render frames of a Blender file as viewports show them, by the engine RSIBR.",
    "compare": "Measure how far previews are from what Cycles renders, or from a BRDF's exact reflection.",
    "info": "Tell what a map set is, or what would be used of a picture, without Blender.",
    "convert": "Lay a map of light out in another representation.",
    "illuminate": "Make an illumination map: the light of an environment, as a latitude-longitude map.",
    "inputs": "Bake what only Cycles can evaluate of an object's materials into textures for previews.",
    "assets": "Write the materials that come with RSIBR as assets for Blender, with pictures.",
    "fit": "Fit radially symmetric lobes to a reflectance model.",
    "report": "Show all that a map set holds in one HTML file.",
    "export": "Write a map set's maps for other programs.",
    "job": "Do what a job file says; `rsibr bake JOB.json` is the same.",
}
"""Name -> what it does. The module of this name has `add_arguments` and `run`; or `KINDS`, such commands in
turn."""

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


OPENBLAS_PATIENCE = "10"
"""Ticks of the processor, as a power of 2, that OpenBLAS's threads wait for work in a loop before they sleep.

By themselves they wait for 2**26, whatever a command does: a few hundredths of a second on every processor.
"""


def parsed(argv: Sequence[str]) -> argparse.Namespace:
    """What a command line asks for.

    Parameters
    ----------
    argv : sequence of str
        The arguments after `rsibr`.

    Returns
    -------
    argparse.Namespace
        The command's own arguments; its function, `run`, and what one types, `command`; `json`, `progress`,
        `verbose` and `log`.

    Raises
    ------
    UsageError
    SystemExit
        Help was asked for; that is printed.
    """
    _set_up_threads(argv)
    return parser().parse_args(_with_joined_values(_with_todays_names(argv)))


def _set_up_threads(argv: Sequence[str]) -> None:
    """Tell what counts threads of their limit: numpy's OpenBLAS asks once, when a command imports it."""
    os.environ.setdefault("OPENBLAS_THREAD_TIMEOUT", OPENBLAS_PATIENCE)
    for word, following in pairwise([*argv, ""]):
        name, _, said = word.partition("=")
        if name == "--threads":
            os.environ[VARIABLE] = said or following
    if limited():
        os.environ["OPENBLAS_NUM_THREADS"] = os.environ[VARIABLE]


def _threads(word: str) -> int:
    try:
        return thread_count()
    except RsibrError as error:
        raise argparse.ArgumentTypeError(f"{word} is no number of threads from 1 to {MOST}") from error


def _with_todays_names(argv: Sequence[str]) -> Sequence[str]:
    """`bake JOB.json` under the name of what does it, and what was called otherwise in version 0.1."""
    name, rest = (argv[0], argv[1:]) if argv else ("", argv)
    if name in OLD_NAMES:
        return _as_in_version_01(OLD_NAMES[name], rest)
    if name == "bake" and rest and rest[0].lower().endswith(".json"):
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
    return Parser(_declare_commands, prog="rsibr", description="Prefiltered reflection maps with Blender.")


def _declare_commands(parser: Parser, words: Sequence[str]) -> None:
    parser.add_argument("--version", action=_Version, nargs=0, help="print name and version")
    commands = parser.add_subparsers(metavar="COMMAND", required=True)
    for name, summary in COMMANDS.items():
        declare = partial(_declare_command, name)
        commands.add_parser(name, help=summary, description=summary, declare=declare)


class _Version(argparse.Action):
    """Prints the version and ends, as ``--help`` does."""

    def __call__(self, parser: argparse.ArgumentParser, *told: Any) -> NoReturn:
        from ..files.version import rsibr

        print(rsibr())
        parser.exit()


def _declare_command(name: str, parser: Parser, words: Sequence[str]) -> None:
    command = import_module(f".{name}", __package__)
    if hasattr(command, "KINDS"):
        _declare_kinds(command.KINDS, parser, words)
    else:
        _declare_arguments(command, parser, words)


def _declare_kinds(kinds: Mapping[str, Any], parser: Parser, words: Sequence[str]) -> None:
    """The kinds of a command; where the words name one it is that alone, as summaries import the others."""
    commands = parser.add_subparsers(metavar="KIND", required=True)
    for kind in words[:1] if words and words[0] in kinds else kinds:
        summary, declare = kinds[kind].summary, partial(_declare_arguments, kinds[kind])
        commands.add_parser(kind, help=summary, description=summary, declare=declare)


def _declare_arguments(command: Any, parser: Parser, words: Sequence[str]) -> None:
    parser.add_argument("--json", action="store_true", help="print the result as one JSON object")
    parser.add_argument(
        "--progress",
        choices=["auto", "bar", "json", "lines", "openjd", "none"],
        default="auto",
        help="progress on standard error: a bar, JSON lines, lines of text, lines for OpenJD or nothing "
        "(default: a bar on a terminal)",
    )
    heard = parser.add_mutually_exclusive_group()
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
    parser.add_argument(
        "--threads",
        metavar="N",
        type=_threads,
        help=f"use at most so many threads (default: what {VARIABLE} says, else all processors)",
    )
    command.add_arguments(parser)
    parser.set_defaults(run=command.run, command=parser.prog)


def _with_joined_values(argv: Sequence[str]) -> list[str]:
    """Make `--view -1,0,0` and the like one argument: argparse would take -1,0,0 for an option."""
    joined: list[str] = []
    for argument in argv:
        if joined and joined[-1] in ("--view", "--point", "--frames"):
            joined[-1] = f"{joined[-1]}={argument}"
        else:
            joined.append(argument)
    return joined
