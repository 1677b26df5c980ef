"""A photograph's exposure as cameras note it: Exif, in any kind of file."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ..core.errors import InputFileError
from ..core.warned import warn
from .photographs import read_notes

LONGEST, LARGEST_F, LARGEST_ISO = 1e6, 1e3, 1e8
"""Greatest values; a number beyond says that nothing is known: infinity, or all bits set."""

SEE_ANOTHER = 65535
"""The PhotographicSensitivity of all values that its 16 bits cannot hold: other fields tell them."""

SENSITIVITIES = ("Exif:RecommendedExposureIndex", "Exif:StandardOutputSensitivity", "Exif:ISOSpeed")


@dataclass(frozen=True)
class Exposure:
    """The exposure of a photograph.

    Attributes
    ----------
    time : float
        [s], above 0.
    f_number : float or None
        Focal length over aperture; None where it is not stated, as by lenses without contacts.
    sensitivity : float or None
        ISO.
    """

    time: float
    f_number: float | None
    sensitivity: float | None


def read_exposure(path: str | Path) -> Exposure:
    """Read the exposure of a photograph.

    Parameters
    ----------
    path : str or Path
        See `read_notes`.

    Returns
    -------
    Exposure
        From the plain fields, or from the APEX values of shutter and aperture where those say nothing. These
        include the exposure bias and the brightness that cameras note as well.

    Raises
    ------
    InputFileError
        The file is missing or unreadable, or tells no exposure time.
    """
    notes = read_notes(path)
    time = _told(notes, "ExposureTime", LONGEST)
    if time is None and "Exif:ShutterSpeedValue" in notes:
        time = _usable(_exponential(-_number(notes["Exif:ShutterSpeedValue"])), LONGEST)
    if time is None:
        raise InputFileError(f"{path} does not tell its exposure time: give the times of all photographs.")
    f_number = _told(notes, "FNumber", LARGEST_F)
    if f_number is None and (aperture := _told(notes, "Exif:ApertureValue", LARGEST_F)):
        f_number = _usable(_exponential(aperture / 2.0), LARGEST_F)
    sensitivity = _told(notes, "Exif:PhotographicSensitivity", SEE_ANOTHER)
    for name in SENSITIVITIES:
        sensitivity = sensitivity or _told(notes, name, LARGEST_ISO)
    return Exposure(time, f_number, sensitivity)


def relative_exposures(paths: Sequence[Path], exposures: Sequence[Exposure]) -> list[float]:
    """Exposures that can be compared with each other.

    Parameters
    ----------
    paths : sequence of Path
        Named in messages.
    exposures : sequence of Exposure
        One for each.

    Returns
    -------
    list of float
        Times [s], corrected where aperture or sensitivity differ.

    Raises
    ------
    InputFileError
        Some photographs do not state their aperture or sensitivity, and it varies among the others.

    Warns
    -----
    RsibrWarning
        It is the same in all others, and is taken for these too.
    """
    f_numbers = _completed(paths, [each.f_number for each in exposures], "f-number")
    sensitivities = _completed(paths, [each.sensitivity for each in exposures], "sensitivity (ISO)")
    return [
        each.time * (f_numbers[0] / f_number) ** 2 * sensitivity / sensitivities[0]
        for each, f_number, sensitivity in zip(exposures, f_numbers, sensitivities, strict=True)
    ]


def _completed(paths: Sequence[Path], told: list[float | None], what: str) -> list[float]:
    """Numbers of which some may be missing, which is harmless where all others are equal."""
    known = [number for number in told if number is not None]
    if not known:
        return [1.0] * len(told)
    lacking = ", ".join(path.name for path, number in zip(paths, told, strict=True) if number is None)
    if lacking and max(known) > min(known) * (1.0 + 1e-6):
        raise InputFileError(
            f"The {what} varies from {min(known):g} to {max(known):g}, but {lacking} tells none: give the "
            f"exposure times of all photographs, corrected for it."
        )
    if lacking:
        warn(f"{lacking} tells no {what}: that of the other photographs, {known[0]:g}, is taken.")
    return [known[0] if number is None else number for number in told]


def _told(notes: dict[str, Any], name: str, most: float) -> float | None:
    return _usable(_number(notes[name]), most) if name in notes else None


def _usable(number: float, most: float) -> float | None:
    """A number, or None for one that says that nothing is known: 0, 0/0, infinity or all bits set."""
    return number if 0.0 < number < most else None


def _number(value: Any) -> float:
    """A field's number, which may be written as a fraction; NaN if it is not a number."""
    if isinstance(value, tuple):
        numerator, denominator = value if len(value) == 2 else (0, 0)
        return numerator / denominator if denominator else math.nan
    return float(value) if isinstance(value, int | float) else math.nan


def _exponential(stops: float) -> float:
    return 2.0**stops if abs(stops) < 100.0 else math.nan
