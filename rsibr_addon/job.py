"""What is to be captured: one description for panels, the command line and farms, and its JSON."""

import dataclasses
import json
from dataclasses import dataclass
from typing import Any

from .core.errors import InputFileError, RangeError
from .core.geodesic import VERTEX_COUNTS


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

    def __post_init__(self) -> None:
        if self.views not in VERTEX_COUNTS:
            counts = ", ".join(map(str, VERTEX_COUNTS))
            raise RangeError(f"A capture cannot have {self.views} views: choose one of {counts}.")

    def to_json(self) -> str:
        """The job as a JSON object, which `from_json` takes back."""
        return json.dumps(dataclasses.asdict(self))

    @classmethod
    def from_json(cls, text: str, name: str) -> "CaptureJob":
        """Read a job.

        Parameters
        ----------
        text : str
            A JSON object of the attributes; those that have defaults may be left out.
        name : str
            Where the text is from, for messages.

        Returns
        -------
        CaptureJob

        Raises
        ------
        InputFileError
            The text is no JSON object, or a field is unknown, missing or of another type.
        RangeError
            A number is out of range.
        """
        try:
            given = json.loads(text)
        except (ValueError, RecursionError) as error:
            raise InputFileError(f"{name} is not JSON ({error}): write it anew.") from error
        if not isinstance(given, dict):
            raise InputFileError(f"{name} is no JSON object: give one with the fields of a job.")
        fields = {field.name: field for field in dataclasses.fields(cls)}
        for key, value in given.items():
            if key not in fields:
                raise InputFileError(f"{name} has an unknown field {key}: choose from {', '.join(fields)}.")
            wanted = fields[key].type
            if not _is_of_type(value, wanted):
                words = getattr(wanted, "__name__", wanted)
                raise InputFileError(f"{name} has {json.dumps(value)} for {key}: give a value of {words}.")
        for key, field in fields.items():
            if field.default is dataclasses.MISSING and key not in given:
                raise InputFileError(f"{name} lacks the field {key}: add it.")
        return cls(**given)


def _is_of_type(value: Any, wanted: Any) -> bool:
    # To Python, but not to JSON, true is a number.
    return isinstance(value, wanted) and (not isinstance(value, bool) or wanted is bool)
