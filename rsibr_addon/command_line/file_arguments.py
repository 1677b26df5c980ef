"""Arguments that name files: the one to work on, and the one to write."""

import argparse
from pathlib import Path
from typing import Any


def add_map_set(parser: argparse.ArgumentParser) -> None:
    """Declare `map_set`, the file to work on."""
    parser.add_argument("map_set", metavar="NAME.rsibr.exr", type=Path, help="a map set")


def add_map_set_or_light(parser: argparse.ArgumentParser, remark: str) -> None:
    """Declare the file that `map_set_or_light` gives; remark: the end of the help."""
    parser.add_argument(
        "map_set",
        metavar="NAME.rsibr.exr|PICTURE",
        help="a map set; or an environment, a picture in OpenEXR or Radiance HDR or one of Blender's by its "
        f"name, {remark}",
    )


def map_set_or_light(arguments: argparse.Namespace) -> Path:
    """The file that a command works on.

    Raises
    ------
    InputFileError
        See `tasks.light.environments.environment_file`.
    """
    from ..tasks.light.environments import environment_file

    return Path(environment_file(arguments.map_set))


def add_output(parser: argparse.ArgumentParser, metavar: str, description: str) -> Any:
    """Declare where the result goes, `output`, and whether it replaces what is there, `force`.

    Returns
    -------
    argparse group
        Takes other options that say what happens to what is there.
    """
    parser.add_argument("-o", "--output", metavar=metavar, type=Path, required=True, help=description)
    existing = parser.add_mutually_exclusive_group()
    existing.add_argument("--force", action="store_true", help="replace what exists")
    return existing
