"""The photographs of a bracket: reading them, and merging them into a picture of radiance."""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from ...core.conventions import Array
from ...core.counted import counted
from ...core.environment import usable_radiance
from ...core.errors import InputFileError, RangeError
from ...core.light.exposure.merge import Merged, merge_bracket
from ...core.light.exposure.response import Response, linear_response, srgb_response
from ...core.progress import Progress, Steps
from ...core.warned import warn
from ...files.encoding import Encoding, named_encoding
from ...files.exif import read_exposure, relative_exposures
from ...files.exposure_times import read_times
from ...files.photographs import Photograph, read_photograph
from ...files.radiance_pictures import (
    check_radiance_target,
    holds_radiance,
    read_radiance,
)
from ...settings.photographs import BracketKnowledge, BracketSettings
from .scaling import write_scaled


def known_times(photographs: Sequence[Path], settings: BracketKnowledge) -> tuple[float, ...] | None:
    """The exposure times that are given.

    Returns
    -------
    tuple of float or None
        [s], one for each photograph.

    Raises
    ------
    RangeError
        There are not as many times as photographs.
    InputFileError
        See `read_times`.
    """
    times = settings.times if settings.times_file is None else read_times(settings.times_file)
    if times is not None and len(times) != len(photographs):
        have = "has" if len(photographs) == 1 else "have"
        raise RangeError(
            f"{counted(len(photographs), 'photograph')} {have} {counted(len(times), 'exposure time')}: "
            "give one for each."
        )
    return times


def in_order(photographs: Sequence[Path], settings: BracketKnowledge) -> tuple[list[Path], list[float]]:
    """Photographs from the shortest exposure to the longest, and their exposures.

    Parameters
    ----------
    photographs : sequence of Path
        In any order.
    settings : BracketKnowledge

    Returns
    -------
    list of Path
    list of float

    Raises
    ------
    RangeError, InputFileError
        See `known_times`, `read_exposure` and `relative_exposures`.

    Warns
    -----
    RsibrWarning
        See `relative_exposures`.
    """
    times = known_times(photographs, settings)
    if times is None:
        exposures = [read_exposure(path) for path in photographs]
        times = tuple(relative_exposures(photographs, exposures))
    order = np.argsort(times, kind="stable")
    return [photographs[i] for i in order], [times[i] for i in order]


def illuminate_from_brackets(
    photographs: Sequence[Path], settings: BracketSettings, output: Path, force: bool = False
) -> Steps[Merged]:
    """Merge a bracket into a picture of radiance, laid out as the photographs are.

    Parameters
    ----------
    photographs : sequence of Path
        In any order. Of 8 or 16 bits; or linear and white at 1, as OpenEXR and Radiance HDR are.

    Raises
    ------
    InputFileError
        A photograph is missing, unreadable, of another size or kind than the others or without an
        exposure time; there is only one, or they are all white or all black.

    Warns
    -----
    RsibrWarning
        See `merged`.
    """
    check_radiance_target(output, force, photographs)
    paths, times = in_order(photographs, settings)
    pictures, encoding = yield from read_photographs(paths)
    for path, picture in zip(paths, pictures, strict=True):
        if picture.shape != pictures[0].shape:
            raise InputFileError(
                f"{path} is {picture.shape[1]}x{picture.shape[0]}, but {paths[0].name} is "
                f"{pictures[0].shape[1]}x{pictures[0].shape[0]}: the photographs of a bracket must be of one "
                f"size; crop them alike."
            )
    yield Progress(len(paths), len(paths) + 1, "merging")
    result = merged(paths[0], settings, pictures, times, encoding)
    write_scaled(output, result.radiance, settings, force)
    return result


def read_photographs(paths: list[Path]) -> Steps[tuple[list[Array], Encoding]]:
    """Read photographs as they are encoded.

    Returns
    -------
    list of ndarray, shape (height, width, 3), float32
        In [0, 1], row 0 at the bottom.
    Encoding
        Encoding of all of them.

    Raises
    ------
    InputFileError
        One is missing or unreadable; some are linear and some are not, or they are of several colour spaces.

    Warns
    -----
    RsibrWarning
        See `read_photograph` and `usable_radiance`.
    """
    pictures, encodings = [], []
    for i, path in enumerate(paths):
        yield Progress(i, len(paths) + 1, f"reading {path.name}")
        photograph = _read(path)
        pixels, encoding = photograph.encoded(), photograph.encoding
        if encoding.curves is None:
            pixels = np.clip(usable_radiance(pixels, path.name), 0.0, 1.0)
        pictures.append(pixels)
        encodings.append(encoding)
    linear = [encoding.curves is None for encoding in encodings]
    if any(linear) and not all(linear):
        raise InputFileError(
            f"{paths[linear.index(False)]} is encoded, but {paths[linear.index(True)].name} is linear: give "
            f"photographs of one kind."
        )
    for path, encoding in zip(paths, encodings, strict=True):
        if not np.allclose(encoding.to_rec709, encodings[0].to_rec709):
            raise InputFileError(
                f"{path} is of another colour space than {paths[0].name}: give photographs of one kind."
            )
    return pictures, encodings[0]


def _read(path: Path) -> Photograph:
    if holds_radiance(path):
        return Photograph(read_radiance(path), named_encoding("lin_rec709"))
    return read_photograph(path)


def _response(curve: str, encoding: Encoding) -> Response | None:
    """The camera's curve where it is known."""
    if curve == "linear" or encoding.curves is None:
        return linear_response()
    return srgb_response() if curve == "srgb" else None


def merged(
    name: Path, settings: BracketKnowledge, pictures: list[Array], times: list[float], encoding: Encoding
) -> Merged:
    """Merge photographs of one size.

    Parameters
    ----------
    name : Path
        Path of one of them, for messages.
    settings : BracketKnowledge
    pictures : list of ndarray, shape (height, width, 3)
        Encoded; the shortest exposure first.
    times : list of float
        Their exposures.
    encoding : Encoding
        Encoding of all of them.

    Returns
    -------
    Merged
        In linear Rec. 709.

    Raises
    ------
    InputFileError
        See `merge_bracket`.

    Warns
    -----
    RsibrWarning
        Some of it is white, or black, in all photographs.
    """
    try:
        result = merge_bracket(pictures, times, _response(settings.curve, encoding), settings.align)
    except RangeError as error:
        raise InputFileError(f"{name} and those with it: {error}") from error
    for share, colour, other in (
        (result.saturated, "white", "shorter"),
        (result.black, "black", "longer"),
    ):
        if share > 0.0:
            warn(
                f"{100.0 * share:.2g} % of the picture are {colour} in every photograph: take a {other} "
                f"exposure as well."
            )
    radiance = np.maximum(result.radiance @ encoding.to_rec709.T.astype(np.float32), np.float32(0.0))
    return replace(result, radiance=radiance)
