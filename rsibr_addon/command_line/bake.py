"""The command `rsibr bake`, of which each kind of map set has its own."""

import argparse
from dataclasses import dataclass
from typing import Any

from ..core.errors import SceneError
from ..core.warned import warn
from ..files.kinds.registry import STORED
from ..job import BakeJob
from ..settings.light import Light
from ..settings.method import MethodSettings
from .console import Console
from .file_arguments import add_output
from .options import add_options, given

NO_LIGHT = (
    "Neither an environment nor a file is given, so the world that Blender starts with is baked: give "
    "--environment, or use blender -b FILE.blend --command rsibr."
)


@dataclass(frozen=True)
class BakeCommand:
    """The command of one method: ``rsibr bake KIND``.

    Attributes
    ----------
    kind : str
        The kind that it makes.
    """

    kind: str

    @property
    def settings(self) -> type[MethodSettings]:
        """Settings of the method."""
        return STORED[self.kind].settings

    @property
    def summary(self) -> str:
        """What the method is for."""
        return f"{self.settings.SUMMARY}."

    def add_arguments(self, parser: argparse.ArgumentParser) -> None:
        """Declare what `run` reads."""
        add_options(parser, Light)
        add_options(parser, self.settings)
        existing = add_output(parser, "NAME.rsibr.exr", "the map set to write")
        existing.add_argument(
            "--if-missing",
            action="store_true",
            help="do nothing if the map set exists and was made with the same settings; if with others, say "
            "which",
        )

    def run(self, arguments: argparse.Namespace, console: Console) -> dict[str, Any]:
        """Bake.

        Returns
        -------
        dict
            See `run_job`.

        Raises
        ------
        RsibrError
            See `tasks.methods.bake.bake`.
        """
        settings, light = given(arguments, self.settings), given(arguments, Light)
        output, force, if_missing = str(arguments.output), arguments.force, arguments.if_missing
        return run_job(BakeJob(settings, output, light, force, if_missing), console)


def run_job(job: BakeJob[Any], console: Console) -> dict[str, Any]:
    """Bake what a job says.

    Returns
    -------
    dict
        "map_set" or "baked_inputs", the path of the file; and the figures of its method, see
        `tasks.methods.method.Baked`; or "found", true, where the file was there already.

    Raises
    ------
    RsibrError
        See `tasks.methods.bake.bake`.

    Warns
    -----
    RsibrWarning
        The world is baked, but no file is open that someone has made one in.
    """
    from ..tasks.methods.bake import bake

    is_map_set = job.settings.KIND in STORED
    if is_map_set and job.light.environment is None:
        _check_world()
    if is_map_set and job.settings.expected:
        console.tell(f"{job.settings.expected}.")
    baked = console.steps(bake(job))
    console.say(f"{baked.path}: {baked.told}")
    return {"map_set" if is_map_set else "baked_inputs": str(baked.path), **baked.figures}


def _check_world() -> None:
    from ..host.installation import has_blender

    if not has_blender():
        raise SceneError("Without Blender there is no world to be baked: give --environment FILE.")
    from ..host.blend_files import is_file_open

    if not is_file_open():
        warn(NO_LIGHT)


KINDS = {kind.replace("_", "-"): BakeCommand(kind) for kind in STORED}
"""Name of a method's command -> the command."""
