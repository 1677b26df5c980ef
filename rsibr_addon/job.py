"""Jobs: one description of the work for panels, the command line and farms."""

import json
from dataclasses import dataclass, field, replace
from typing import Any, Generic, Literal, TypeVar

from .core.errors import InputFileError, RangeError, SchemaError
from .core.options import to_plain
from .core.schema import decode, loads
from .files.kinds.registry import STORED
from .files.output_paths import portable_name
from .settings.baked_inputs import ObjectInputsSettings
from .settings.light import Light
from .settings.method import MethodSettings

Settings = TypeVar("Settings", bound=MethodSettings)

FORMAT, ARGUMENTS_FORMAT = 2, 1
"""Formats of a job's JSON: a bake's settings, and the arguments of any command."""

COMMANDS = ("capture", "bake", "tables", "mips", "bank", "illuminate", "inputs", "assets", "compare")
"""Commands that a job of arguments may give."""

OBJECT = "{object}"
"""What stands for an object's name in the output of a job of baked inputs."""


@dataclass(frozen=True)
class BakeJob(Generic[Settings]):
    """A bake: what a method makes of which light, and where it goes.

    Attributes
    ----------
    settings : MethodSettings
        Settings of one of the methods.
    output : str
        The map set to write, NAME.rsibr.exr or NAME.exr; or the file of baked inputs, NAME.exr.
    light : Light
        Of a map set.
    force : bool
        Whether `output` is replaced if it exists.
    if_missing : bool
        Whether an `output` that exists is kept, if it was made with the same settings.
    """

    settings: Settings
    output: str
    light: Light = field(default_factory=Light)
    force: bool = False
    if_missing: bool = False

    def to_json(self) -> str:
        """The job as a JSON object, which `read_job` takes back; without `if_missing`, as jobs have it."""
        plain = {
            "format": FORMAT,
            "kind": self.settings.KIND,
            "settings": to_plain(self.settings),
            "light": to_plain(self.light),
            "output": self.output,
            "force": self.force,
        }
        return json.dumps(plain, indent=1)


@dataclass(frozen=True)
class CommandJob:
    """The arguments of a command.

    Attributes
    ----------
    arguments : tuple of str
        Arguments of the command line, the command first: ("compare", "copper.rsibr.exr", ...).

    Raises
    ------
    RangeError
        There is no command, or it is one that makes no file.
    """

    arguments: tuple[str, ...]

    def __post_init__(self) -> None:
        if self.arguments[:1] and self.arguments[0] in COMMANDS:
            return
        raise RangeError(f"A job begins with what is to be made: one of {', '.join(COMMANDS)}.")

    def to_json(self) -> str:
        """The job as a JSON object, which `read_job` takes back."""
        return json.dumps({"format": ARGUMENTS_FORMAT, "arguments": self.arguments}, indent=1)


@dataclass(frozen=True)
class _ArgumentsFile:
    format: Literal[1]
    arguments: tuple[str, ...]


@dataclass(frozen=True)
class _BakeFile:
    format: Literal[2]
    kind: str
    settings: dict[str, Any]
    output: str
    light: dict[str, Any] = field(default_factory=dict)
    force: bool = False


def job_of_object(job: BakeJob[ObjectInputsSettings], name: str) -> BakeJob[ObjectInputsSettings]:
    """The job of one object, whose name replaces `OBJECT` in the output."""
    output = job.output.replace(OBJECT, portable_name(name))
    return replace(job, output=output, settings=replace(job.settings, object=name))


def read_job(text: str, name: str) -> BakeJob[Any] | CommandJob:
    """Read a job. A bake that does not replace its output is `if_missing`, so that it can be repeated.

    Parameters
    ----------
    text : str
        What `to_json` of a job wrote.
    name : str
        Where the text is from, for messages.

    Raises
    ------
    InputFileError
        The text is no such object, or of a newer format.
    """
    try:
        given = loads(text)
        stated = given.get("format", FORMAT) if isinstance(given, dict) else FORMAT
        if stated == ARGUMENTS_FORMAT:
            return CommandJob(decode(_ArgumentsFile, given).arguments)
        if stated != FORMAT:
            raise InputFileError(
                f"{name} is a job of format {stated!r:.40}, not {FORMAT}: update RSIBR, or write it anew."
            )
        return _bake_job(decode(_BakeFile, given))
    except SchemaError as error:
        raise InputFileError(
            f"{name} is no job ({error}): give an object with the fields format, kind, settings and output."
        ) from error
    except RangeError as error:
        raise InputFileError(f"{name} cannot be done. {error}") from error


def _bake_job(found: _BakeFile) -> BakeJob[Any]:
    settings = decode(_settings_type(found.kind), found.settings, "settings")
    light = decode(Light, found.light, "light")
    return BakeJob(settings, found.output, light, found.force, if_missing=not found.force)


def _settings_type(kind: str) -> type[MethodSettings]:
    known = kind.replace("-", "_")
    if known == ObjectInputsSettings.KIND:
        return ObjectInputsSettings
    if known not in STORED:
        raise SchemaError(f"kind is not one of {', '.join((*STORED, ObjectInputsSettings.KIND))}")
    return STORED[known].settings
