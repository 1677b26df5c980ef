"""Pictures of light in whatever format they come."""

from pathlib import Path

from ...core.conventions import Array
from ...core.environment import usable_radiance
from ...core.errors import InputFileError
from ...files.photographs import read_photograph
from ...files.picture_facts import GREY
from ...files.radiance_pictures import describe_radiance, holds_radiance, read_radiance
from ...files.read_once import read_once

NO_RADIANCE = (
    "This picture holds no radiance: its lamps end at white. Give OpenEXR or Radiance HDR, or make one of it."
)


@read_once
def light_remarks(path: Path) -> tuple[str, ...]:
    """Remarks on a picture of light before a bake, by its header alone.

    Parameters
    ----------
    path : Path
        FILE, or FILE.exr:LAYER.

    Returns
    -------
    tuple of str
        Sentences; none of a picture of radiance in colour all of whose header is used.
    """
    try:
        if not holds_radiance(path):
            return (NO_RADIANCE,)
        facts = describe_radiance(path)
    except InputFileError as error:
        return (str(error),)
    grey = ["is grey: its light has no colour."] if facts.colours == GREY else []
    return tuple(f"{path.name} {remark}" for remark in (*grey, *facts.remarks))


def read_light(path: Path, clamp: float | None = None) -> Array:
    """Read a picture as radiance.

    Parameters
    ----------
    path : Path
        OpenEXR or Radiance HDR, or a picture of 8 or 16 bits, whose curve is undone.
    clamp : float, optional
        See `usable_radiance`.

    Returns
    -------
    ndarray, shape (height, width, 3), float32
        Linear Rec. 709, at least 0, row 0 at the bottom.

    Raises
    ------
    InputFileError
        The file is missing or unreadable, or holds no finite value.

    Warns
    -----
    RsibrWarning
        See `usable_radiance` and `read_photograph`.
    """
    if holds_radiance(path):
        return usable_radiance(read_radiance(path), path.name, clamp)
    return usable_radiance(read_photograph(path).radiance(), path.name, clamp)
