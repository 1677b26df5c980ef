"""The command line: `rsibr ...` beside the bpy module, `blender --command rsibr ...` within Blender.

Results go to standard output (with ``--json`` one JSON object, its last line); progress, warnings,
errors and whatever Blender says go to standard error. Exit codes: 0 done, 1 failed, 2 usage.
"""

import argparse
import json
import sys
from collections.abc import Sequence
from types import ModuleType
from typing import Any

from ..core.errors import RsibrError
from . import (
    bake,
    bank,
    capture,
    compare,
    convert,
    export,
    fit,
    illuminate,
    info,
    job,
    mips,
    page,
    preview,
    tables,
)
from .report import Report, result_stream

COMMANDS = {
    "capture": capture,
    "preview": preview,
    "compare": compare,
    "info": info,
    "convert": convert,
    "illuminate": illuminate,
    "mips": mips,
    "tables": tables,
    "fit": fit,
    "bake": bake,
    "bank": bank,
    "report": page,
    "export": export,
    "job": job,
}
"""Name -> the module with its arguments and its run; or with `KINDS`, such modules in turn."""


def console() -> int:
    """Run with the arguments of the process: the entry point of `rsibr`."""
    return run(sys.argv[1:])


def run(argv: Sequence[str]) -> int:
    """Run one command.

    Parameters
    ----------
    argv : sequence of str
        The arguments after `rsibr`.

    Returns
    -------
    int
        0 done, 1 failed, 2 wrong usage.
    """
    try:
        arguments = parsed(argv)
    except SystemExit as end:  # argparse has said why, or has printed the help
        return int(end.code or 0)
    report = Report(arguments.progress)
    with result_stream() as out, report.hearing_warnings():
        try:
            result = {"ok": True, **arguments.run(arguments, report)}
        except (RsibrError, OSError, KeyboardInterrupt) as error:
            result = {"ok": False, "error": _sentence(error)}
            print(f"rsibr: error: {result['error']}", file=sys.stderr)
        result["warnings"] = report.warnings
        for line in [json.dumps(result)] if arguments.json else report.lines:
            print(line, file=out)
    return 0 if result["ok"] else 1


def parsed(argv: Sequence[str]) -> argparse.Namespace:
    """What a command line asks for.

    Parameters
    ----------
    argv : sequence of str
        As `run` takes it.

    Returns
    -------
    argparse.Namespace
        The command's own arguments; its function, `run`; `json` and `progress`.

    Raises
    ------
    SystemExit
        The usage is wrong, or help was asked for; that is printed.
    """
    return _parser().parse_args(_with_joined_directions(_with_jobs_command(argv)))


def _with_jobs_command(argv: Sequence[str]) -> Sequence[str]:
    """`bake JOB.json` under the name of what does it: else `bake` takes options alone."""
    if argv[:1] and argv[0] == "bake" and argv[1:] and argv[1].endswith(".json"):
        return ["job", *argv[1:]]
    return argv


def _parser() -> argparse.ArgumentParser:
    common = argparse.ArgumentParser(add_help=False)
    common.add_argument("--json", action="store_true", help="print the result as one JSON object")
    common.add_argument(
        "--progress",
        choices=["auto", "bar", "json", "none"],
        default="auto",
        help="on standard error: a bar, a JSON object a line, or nothing (default: a bar on a terminal)",
    )
    parser = argparse.ArgumentParser(prog="rsibr", description="Prefiltered reflection maps with Blender.")
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


def _add_command(commands: Any, name: str, module: ModuleType, common: argparse.ArgumentParser) -> None:
    summary = _summary(module)
    command = commands.add_parser(
        name, help=summary, description=summary, parents=[common], allow_abbrev=False
    )
    module.add_arguments(command)
    command.set_defaults(run=module.run)


def _summary(module: ModuleType) -> str:
    return (module.__doc__ or "").splitlines()[0]


def _with_joined_directions(argv: Sequence[str]) -> list[str]:
    """Make `--view -1,0,0` one argument: argparse would take -1,0,0 for an option."""
    joined: list[str] = []
    for argument in argv:
        if joined and joined[-1] in ("--view", "--point"):
            joined[-1] = f"{joined[-1]}={argument}"
        else:
            joined.append(argument)
    return joined


def _sentence(error: RsibrError | OSError | KeyboardInterrupt) -> str:
    """What to tell of an error, naming the file where the system knows it."""
    if isinstance(error, KeyboardInterrupt):
        return "Interrupted: give the same command again; a capture keeps its finished views."
    if isinstance(error, OSError) and error.filename is not None:
        return f"{error.filename}: {error.strerror}."
    return str(error)
