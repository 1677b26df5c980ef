"""What is to be made: one description for panels, the command line and farms."""

import json
from dataclasses import dataclass
from typing import Literal

from .core.errors import InputFileError, RangeError, SchemaError
from .core.geometry.geodesic import VERTEX_COUNTS
from .core.schema import decode, loads

FORMAT = 1
"""Of a job's JSON."""

COMMANDS = ("capture", "bake", "tables", "mips", "bank", "illuminate", "compare")
"""What a job may be of."""


@dataclass(frozen=True)
class CaptureJob:
    """A capture of radiance views.

    Attributes
    ----------
    environment : str or None
        Latitude-longitude picture, or the bare name of one that comes with Blender, as "forest";
        None for the world of the open file.
    material : str
        A preset; or ``FILE.blend:NAME``; or ``:NAME``, a material of the open file.
    output : str
        The map set to write, by custom NAME.rsibr.exr.
    views : int
        12, 42 or 162 view directions.
    size : int
        Width and height of a view in texels.
    samples : int
        Cycles' samples a texel.
    denoise : bool
        Whether each view is denoised.
    seed : int
        Of Cycles' noise.
    force : bool
        Whether `output` is replaced if it exists.
    clamp : float or None
        See `core.environment.usable_radiance`.

    Raises
    ------
    RangeError
        `views` is another number. The other ranges are those of `host.cycles.RenderSettings`.
    """

    environment: str | None
    material: str
    output: str
    views: int = 12
    size: int = 256
    samples: int = 64
    denoise: bool = False
    seed: int = 0
    force: bool = False
    clamp: float | None = None

    def __post_init__(self) -> None:
        if self.views not in VERTEX_COUNTS:
            counts = ", ".join(map(str, VERTEX_COUNTS))
            raise RangeError(f"A capture cannot have {self.views} views: choose one of {counts}.")


@dataclass(frozen=True)
class _File:
    format: Literal[1]
    arguments: tuple[str, ...]


@dataclass(frozen=True)
class BakeJob:
    """One piece of work: what `rsibr` is to do, whoever has it done.

    A panel writes it for a background Blender, a farm for its nodes, a person by hand; and
    `rsibr bake JOB.json` does it.

    Attributes
    ----------
    arguments : tuple of str
        Of the command line, the command first: ("capture", "--material", "copper", ...).

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
        """The job as a JSON object, which `from_json` takes back."""
        return json.dumps({"format": FORMAT, "arguments": self.arguments}, indent=1)

    @classmethod
    def from_json(cls, text: str, name: str) -> "BakeJob":
        """Read a job.

        Parameters
        ----------
        text : str
            A JSON object with the fields "format", 1, and "arguments", a list of text.
        name : str
            Where the text is from, for messages.

        Returns
        -------
        BakeJob

        Raises
        ------
        InputFileError
            The text is no such object, or of a newer format.
        """
        try:
            given = loads(text)
            if isinstance(given, dict) and given.get("format", FORMAT) != FORMAT:
                raise InputFileError(
                    f"{name} is a job of format {given['format']!r:.40}, not {FORMAT}: update RSIBR, or "
                    f"write it anew."
                )
            return cls(decode(_File, given).arguments)
        except SchemaError as error:
            raise InputFileError(
                f"{name} is no job ({error}): give an object with the fields format and arguments."
            ) from error
        except RangeError as error:
            raise InputFileError(f"{name} cannot be done. {error}") from error
