"""Tell what a map set is, without Blender."""

import argparse
from typing import Any

from .report import Report


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare what `run` reads."""
    parser.add_argument("map_set", metavar="NAME.rsibr.exr", help="a map set")


def run(arguments: argparse.Namespace, report: Report) -> dict[str, Any]:
    """Read a map set, check all of it, and tell its description.

    Returns
    -------
    dict
        "map_set", the path; "header", the description as docs/map-set-format.md has it.

    Raises
    ------
    MapSetError
        See `read_map_set`: also when its maps are not whole.
    """
    from ..files.map_set import read_map_set, read_map_set_header

    read_map_set(arguments.map_set)
    header = read_map_set_header(arguments.map_set)
    roles: dict[str, int] = {}
    for part in header["parts"]:
        roles[part["role"]] = roles.get(part["role"], 0) + 1
    counts = ", ".join(f"{count} {role}" for role, count in roles.items())
    report.say(f"{arguments.map_set}: {header['kind']}, format {header['format']}")
    report.say(f"  maps         {counts}; {_size(header['size'])}, {header['layout']}")
    report.say(f"  environment  {header['environment']['name']}, {_size(header['environment']['size'])}")
    report.say(f"  material     {_fields(header['material'])}")
    report.say(f"  settings     {_fields(header['settings'])}")
    report.say(f"  error bound  {_fields(header['error_bound'] or {}) or 'none promised'}")
    report.say(f"  made by      {header['software']}")
    return {"map_set": arguments.map_set, "header": header}


def _size(size: list[int]) -> str:
    return "{}x{}".format(*size)


def _fields(fields: dict[str, Any]) -> str:
    """What people can read of an object: a fingerprint and whole tables are for programs."""
    shown = {
        name: value for name, value in fields.items() if name != "fingerprint" and not isinstance(value, dict)
    }
    return ", ".join(
        f"{name} {value:.3g}" if isinstance(value, float) else f"{name} {value}"
        for name, value in shown.items()
    )
